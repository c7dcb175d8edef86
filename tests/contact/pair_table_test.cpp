#include "contact/pair_table.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace pliant {
namespace {

/// EXACT: a pair is found from wherever the search begins, and one that is missing is not.
TEST(FindPair, finds_a_pair_from_any_index) {
  std::vector<ContactPair> pairs;
  for (int first = 0; first < 4; ++first)
    for (int second = first; second < 4; ++second)
      for (int part : {0, 3}) {
        ContactPair pair;
        pair.first = first, pair.second = second, pair.part = part;
        pairs.push_back(pair);
      }
  const int size = static_cast<int>(pairs.size());
  for (int near = -1; near <= size + 5; ++near) {
    for (int p = 0; p < size; ++p) EXPECT_EQ(find_pair(pairs, pairs[p], near), p) << "from " << near;
    for (ContactPair missing : pairs) {
      missing.part = 1;
      EXPECT_EQ(find_pair(pairs, missing, near), -1) << "from " << near;
    }
    ContactPair last;
    last.first = last.second = 4;
    EXPECT_EQ(find_pair(pairs, last, near), -1) << "from " << near;
  }
  EXPECT_EQ(find_pair({}, pairs[0], 0), -1);
}

}  // namespace
}  // namespace pliant
