#pragma once

#include <algorithm>
#include <vector>

namespace pliant {

/// Index of an entry in a list sorted by `before`; -1: there is none. The search goes outwards from the index `near`:
/// two lists of much the same entries have them at much the same places.
template <class T, class Before>
int find_near(const std::vector<T>& sorted, const T& wanted, int near, Before&& before) {
  const int size = static_cast<int>(sorted.size());
  int low = std::clamp(near, 0, size), high = low;  // the first that does not come before it lies in [low, high]
  for (int step = 1; low > 0 && !before(sorted[low - 1], wanted); step *= 2)
    high = low - 1, low = std::max(0, low - step);
  for (int step = 1; high < size && before(sorted[high], wanted); step *= 2)
    low = high + 1, high = std::min(size, high + step);
  const auto at = std::partition_point(sorted.begin() + low, sorted.begin() + high,
                                       [&](const T& entry) { return before(entry, wanted); });
  return at == sorted.end() || before(wanted, *at) ? -1 : static_cast<int>(at - sorted.begin());
}

}  // namespace pliant
