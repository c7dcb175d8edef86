#include "scene/instant.hpp"

#include <algorithm>

namespace pliant {

double slope(const History& history, const Instant& at) {
  if (!at.ends_step) return history.slope(at.time);
  const auto after = std::lower_bound(history.time.begin(), history.time.end(), at.time);
  if (after == history.time.begin() || after == history.time.end()) return 0;
  const auto i = static_cast<std::size_t>(after - history.time.begin());
  return (history.value[i] - history.value[i - 1]) / (history.time[i] - history.time[i - 1]);
}

}  // namespace pliant
