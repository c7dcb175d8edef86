// Save, load and hash of objects that enumerate themselves. All EXACT.
#include "core/archive.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/lanes.hpp"

namespace pliant {
namespace {

struct Inner {
  std::vector<Lanes> lanes;
  bool flag = false;
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("lanes", lanes);
    visitor("flag", flag);
  }
};

struct Outer {
  double number = 0;
  std::string text;
  std::vector<std::string> texts;
  Inner inner;
  std::vector<int> empty;
  int derived = 0;
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("number", number);
    visitor("text", text);
    visitor("texts", texts);
    visitor("inner", inner);
    visitor("empty", empty);
  }
  void loaded() { derived = static_cast<int>(texts.size()); }
};

Outer example() {
  Outer outer{-0.0, std::string("a\0b", 3), {"", "long enough not to be short"}, {{broadcast(2.5), Lanes{}}, true}, {},
              0};
  outer.inner.lanes[1][3] = std::nan("");
  return outer;
}

std::string saved_outer(Outer outer) {
  std::string bytes;
  SaveLeaf save(bytes);
  Walk{save}("outer", outer);
  return bytes;
}

void load_outer(const std::string& bytes, Outer& outer) {
  LoadLeaf leaf(bytes);
  Walk{leaf}("outer", outer);
  EXPECT_TRUE(leaf.empty());
}

std::string complaint(const std::string& bytes) {
  Outer outer;
  try {
    load_outer(bytes, outer);
  } catch (const ArchiveError& error) {
    return error.what();
  }
  return "none";
}

TEST(Archive, every_bit_comes_back) {
  Outer outer;
  outer.texts = {"not", "empty", "before"};
  load_outer(saved_outer(example()), outer);
  EXPECT_TRUE(std::signbit(outer.number));
  EXPECT_EQ(outer.text, example().text);
  EXPECT_EQ(outer.texts, example().texts);
  EXPECT_EQ(outer.inner.lanes[0][7], 2.5);
  EXPECT_TRUE(std::isnan(outer.inner.lanes[1][3]));
  EXPECT_TRUE(outer.inner.flag);
  EXPECT_EQ(outer.derived, 2) << "loaded() follows the members";
  EXPECT_EQ(saved_outer(outer), saved_outer(example()));
}

TEST(Archive, another_layout_is_refused_by_name) {
  const std::string bytes = saved_outer(example());
  std::string renamed = bytes, narrow = bytes;
  renamed.replace(renamed.find("outer.inner.flag"), 16, "outer.inner.flog");
  EXPECT_EQ(complaint(renamed), "'outer.inner.flog' stands where 'outer.inner.flag' is expected");
  narrow[narrow.find("outer.number") + 13] = 4;
  EXPECT_EQ(complaint(narrow), "'outer.number' has another size");
  EXPECT_EQ(complaint(bytes), "none");
}

/// Before there is an attempt to make room for them.
TEST(Archive, more_elements_than_there_are_bytes_are_refused) {
  std::string many = saved_outer(example());
  const std::string name = "outer.texts.size";
  many[many.find(name) + name.size() + 1 + 2 * sizeof(std::uint64_t) + 5] = 1;  // 2^40 and some
  EXPECT_EQ(complaint(many), "'outer.texts' has another size");
}

TEST(Archive, bytes_that_end_early_are_refused_wherever_they_end) {
  const std::string bytes = saved_outer(example());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(complaint(bytes.substr(0, size)), "none") << size << " of " << bytes.size();
}

TEST(Archive, hash_sees_the_last_bit) {
  Outer outer = example();
  const std::uint64_t hash = hash_of(outer);
  EXPECT_EQ(hash_of(example()), hash);
  outer.inner.lanes[1][5] = std::nextafter(0.0, 1.0);
  EXPECT_NE(hash_of(outer), hash);
}

}  // namespace
}  // namespace pliant
