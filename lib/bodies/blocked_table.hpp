#pragma once

#include <cstdint>
#include <vector>

#include "discretisation/table.hpp"

namespace pliant {

/// An integration table rearranged for the force loop: blocks of two points share one neighbour list, padded with zero
/// gradients, so that a node's position is loaded once for both (DESIGN 4).
struct BlockedTable {
  static constexpr int points_per_block = 2;

  struct Entry {
    double gradient[points_per_block][2];
    std::int64_t node;
  };

  std::vector<int> start;  ///< [blocks + 1], rows of `entries`
  std::vector<Entry> entries;
  std::vector<double> weight;  ///< [blocks x points_per_block], m2; 0 for a padded point
  std::vector<int> point;      ///< [blocks x points_per_block], index in the integration table; -1 for a padded point

  int blocks() const { return static_cast<int>(start.size()) - 1; }
};

/// Groups points greedily by the neighbours they share.
BlockedTable make_blocked_table(const IntegrationTable& table);

}  // namespace pliant
