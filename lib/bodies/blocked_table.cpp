#include "bodies/blocked_table.hpp"

#include <algorithm>
#include <map>

namespace pliant {
namespace {

int shared_neighbours(const IntegrationTable& table, const std::vector<char>& in_block, int point) {
  int count = 0;
  for (int e = table.start[point]; e < table.start[point + 1]; ++e) count += in_block[table.node[e]];
  return count;
}

void mark(const IntegrationTable& table, int point, std::vector<char>& in_block, char value) {
  for (int e = table.start[point]; e < table.start[point + 1]; ++e) in_block[table.node[e]] = value;
}

/// Among the next free points, the one that shares most neighbours with the block; -1 when none is left.
int best_partner(const IntegrationTable& table, const std::vector<char>& in_block, const std::vector<char>& taken,
                 int from) {
  constexpr int horizon = 600;
  int best = -1, best_count = -1, seen = 0;
  for (int p = from; p < static_cast<int>(taken.size()) && seen < horizon; ++p) {
    if (taken[p]) continue;
    ++seen;
    const int count = shared_neighbours(table, in_block, p);
    if (count > best_count) best = p, best_count = count;
  }
  return best;
}

void append_block(const IntegrationTable& table, const std::vector<int>& members, BlockedTable& out) {
  std::map<int, BlockedTable::Entry> rows;
  for (int k = 0; k < BlockedTable::points_per_block; ++k) {
    const int p = k < static_cast<int>(members.size()) ? members[k] : -1;
    out.point.push_back(p);
    out.weight.push_back(p < 0 ? 0.0 : table.weight[p]);
    if (p < 0) continue;
    for (int e = table.start[p]; e < table.start[p + 1]; ++e) {
      BlockedTable::Entry& row = rows[table.node[e]];
      row.node = table.node[e];
      row.gradient[k][0] += table.gradient[e].x();
      row.gradient[k][1] += table.gradient[e].y();
    }
  }
  for (const auto& [node, row] : rows) out.entries.push_back(row);
  out.start.push_back(static_cast<int>(out.entries.size()));
}

}  // namespace

BlockedTable make_blocked_table(const IntegrationTable& table) {
  const int points = static_cast<int>(table.weight.size());
  const int nodes = table.node.empty() ? 0 : 1 + *std::max_element(table.node.begin(), table.node.end());
  std::vector<char> taken(points, 0), in_block(nodes, 0);
  BlockedTable out;
  out.start.push_back(0);
  for (int first = 0; first < points; ++first) {
    if (taken[first]) continue;
    std::vector<int> members;
    for (int p = first; p >= 0; p = best_partner(table, in_block, taken, first)) {
      members.push_back(p);
      taken[p] = 1;
      mark(table, p, in_block, 1);
      if (members.size() == BlockedTable::points_per_block) break;
    }
    append_block(table, members, out);
    for (int p : members) mark(table, p, in_block, 0);
  }
  return out;
}

}  // namespace pliant
