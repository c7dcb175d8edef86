// What is kept of a scene file beside its results. All EXACT.
#include "input/portable_scene.hpp"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(PlaceOfKey, is_that_of_its_value_or_of_its_table) {
  const std::string text = "[start]\nfrom = 'x'\n[[grains]]\nseed = 1\n[[grains]]\nseed = 22\n";
  EXPECT_EQ(place_of_key(text, "start.from"), "2:8");
  EXPECT_EQ(place_of_key(text, "grains 2.seed"), "6:8");
  EXPECT_EQ(place_of_key(text, "grains 2.shape"), "5:1");
  EXPECT_EQ(place_of_key(text, "grains 3.shape"), "");
  EXPECT_EQ(place_of_key(text, "domain.period"), "");
}

TEST(PortableScene, names_the_copies_of_its_outlines_and_changes_nothing_else) {
  const std::string text =
      "title = \"\xc3\xa4\" # [shapes.a] file = \"x\"\n"
      "[shapes.a]\nkind = \"file\"\nunit = 'mm' \nfile = \"../some where/\\\"a\\\".csv\" # here\nspacing = 1\n"
      "[shapes]\nb = { kind = \"file\", title = \"\xc3\xa4\xe2\x82\xac\", file = '''C:\\b.msh''', spacing = 1 }\n"
      "c = { kind = \"disc\" }\n";
  const PortableScene scene = portable_scene(text);
  EXPECT_EQ(
      scene.text,
      "title = \"\xc3\xa4\" # [shapes.a] file = \"x\"\n"
      "[shapes.a]\nkind = \"file\"\nunit = 'mm' \nfile = \"outline_a.csv\" # here\nspacing = 1\n"
      "[shapes]\nb = { kind = \"file\", title = \"\xc3\xa4\xe2\x82\xac\", file = \"outline_b.msh\", spacing = 1 }\n"
      "c = { kind = \"disc\" }\n");
  ASSERT_EQ(scene.files.size(), 2U);
  EXPECT_EQ(scene.files[0].file, "../some where/\"a\".csv");
  EXPECT_EQ(scene.files[0].copy, "outline_a.csv");
  EXPECT_EQ(scene.files[1].file, "C:\\b.msh");
  EXPECT_EQ(portable_scene(scene.text).text, scene.text) << "once more changes nothing";
}

TEST(PortableScene, names_the_copies_of_tables_of_grains) {
  const std::string text =
      "[[grains]]\npacking = { kind = \"positions\" }\n[[grains]]\npacking = { kind = \"file\", file = \"a.csv\" }\n"
      "[[grains]]\nname = \"x\"\n[grains.packing]\nfile = 'b/c.dat' # there\n[shapes.s]\nfile = \"c.csv\"\n";
  const PortableScene scene = portable_scene(text);
  EXPECT_EQ(scene.text,
            "[[grains]]\npacking = { kind = \"positions\" }\n[[grains]]\npacking = { kind = \"file\", file = "
            "\"packing_grains2.csv\" }\n[[grains]]\nname = \"x\"\n[grains.packing]\nfile = \"packing_x.csv\" # there\n"
            "[shapes.s]\nfile = \"outline_s.csv\"\n");
  ASSERT_EQ(scene.files.size(), 3U);
  EXPECT_EQ(scene.files[1].what, "table of grains");
  EXPECT_EQ(scene.files[2].file, "b/c.dat");
}

TEST(PortableScene, names_the_copy_of_the_state_that_it_starts_from) {
  const std::string text = "[start]\nfrom = '../results/old' # there\n[time]\nend = 1\n";
  const PortableScene scene = portable_scene(text);
  EXPECT_EQ(scene.text, "[start]\nfrom = \"start.bin\" # there\n[time]\nend = 1\n");
  EXPECT_TRUE(scene.starts_from_a_state);
  EXPECT_EQ(portable_scene(scene.text).text, scene.text) << "once more changes nothing";
  EXPECT_FALSE(portable_scene("[time]\nend = 1\n").starts_from_a_state);
}

TEST(PortableScene, without_outlines_is_as_it_was) {
  const std::string text = "[shapes.disc]\nkind = \"disc\"\n";
  EXPECT_EQ(portable_scene(text).text, text);
  EXPECT_TRUE(portable_scene(text).files.empty());
}

}  // namespace
}  // namespace pliant
