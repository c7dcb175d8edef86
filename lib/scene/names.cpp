#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pliant {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substituted = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, substituted});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) next[j] = std::min(next[j], before[j - 2] + 1);
    }
    std::swap(before, row);
    std::swap(row, next);
  }
  return row.back();
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& names) {
  constexpr std::size_t longest_compared = 200;
  std::string nearest;
  int least = static_cast<int>(std::min(word.size(), longest_compared) + 1) / 2;
  for (const std::string& name : names) {
    const int distance = edit_distance(word.substr(0, longest_compared), name);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest;
}

std::string allowed_names(std::string_view word, const std::vector<std::string>& names) {
  if (names.empty()) return "none is defined";
  const std::string nearest = nearest_name(word, names);
  const std::string all = fmt::format("allowed: {}", fmt::join(names, ", "));
  return nearest.empty() ? all : fmt::format("{}; nearest: {}", all, nearest);
}

std::string default_grains_name(std::size_t number) { return number == 1 ? "grains" : fmt::format("grains{}", number); }

}  // namespace pliant
