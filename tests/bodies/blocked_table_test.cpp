#include "bodies/blocked_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "geometry/mesh.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;
constexpr int K = BlockedTable::points_per_block;

using Entries = std::map<std::pair<int, int>, Vec2>;  // (point, node)

Entries entries_of(const IntegrationTable& table) {
  Entries entries;
  for (std::size_t p = 0; p < table.weight.size(); ++p)
    for (int e = table.start[p]; e < table.start[p + 1]; ++e)
      entries.try_emplace({static_cast<int>(p), table.node[e]}, 0, 0).first->second += table.gradient[e];
  return entries;
}

// Non-zero gradients, by the original point.
Entries entries_of(const BlockedTable& table) {
  Entries entries;
  for (int b = 0; b < table.blocks(); ++b)
    for (int e = table.start[b]; e < table.start[b + 1]; ++e)
      for (int k = 0; k < K; ++k) {
        const Vec2 gradient(table.entries[e].gradient[k][0], table.entries[e].gradient[k][1]);
        if (gradient == Vec2(0, 0)) continue;
        EXPECT_TRUE(
            entries.try_emplace({table.point[K * b + k], static_cast<int>(table.entries[e].node)}, gradient).second);
      }
  return entries;
}

Discretisation discretised(const ShapeSpec& shape, Recipe recipe) {
  DiscretisationSettings settings;
  settings.recipe = recipe;
  return discretise(make_field_mesh(shape), settings);
}

std::vector<Discretisation> tables() {
  std::vector<Discretisation> result;
  for (const Recipe recipe : {Recipe::mls, Recipe::mls_gauss}) {
    result.push_back(discretised(disc_shape("disc", 1, 24, 50), recipe));
    result.push_back(discretised(outline_shape("bar", rectangle(2, 0.5, 0.1), 140), recipe));
  }
  return result;
}

// EXACT: the same entries, bit by bit, and no other.
TEST(BlockedTable, HoldsTheEntriesOfTheTable) {
  for (const Discretisation& space : tables()) {
    Entries expected = entries_of(space.table);
    std::erase_if(expected, [](const auto& entry) { return entry.second == Vec2(0, 0); });
    EXPECT_EQ(entries_of(make_blocked_table(space.table)), expected);
  }
}

// EXACT: every point once, with its weight; padded points have weight 0 and no gradient.
TEST(BlockedTable, HoldsEveryPointOnce) {
  for (const Discretisation& space : tables()) {
    const BlockedTable blocked = make_blocked_table(space.table);
    std::set<int> seen;
    ASSERT_EQ(blocked.point.size(), static_cast<std::size_t>(K * blocked.blocks()));
    for (std::size_t slot = 0; slot < blocked.point.size(); ++slot) {
      const int p = blocked.point[slot];
      EXPECT_EQ(blocked.weight[slot], p < 0 ? 0 : space.table.weight[p]);
      EXPECT_TRUE(p < 0 || seen.insert(p).second);
    }
    EXPECT_EQ(seen.size(), space.table.weight.size());
    EXPECT_LE(blocked.blocks(), static_cast<int>(space.table.weight.size()) / K + K);
  }
}

// The purpose: a block of neighbouring points loads far fewer nodes than its points apart would.
TEST(BlockedTable, SharesNeighbours) {
  const Discretisation space = discretised(disc_shape("disc", 1, 48, 168), Recipe::mls);
  const BlockedTable blocked = make_blocked_table(space.table);
  EXPECT_LT(blocked.entries.size(), 0.7 * static_cast<double>(space.table.node.size()));
}

}  // namespace
}  // namespace pliant
