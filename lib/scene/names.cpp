#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pliant {

bool is_scene_key(std::string_view word) {
  static constexpr std::string_view keys =
      " alpha angle beta between body caps cohesion columns contact contacts count density descriptors diameter "
      "discretisation domain end fields first force frames friction gauss_points gradient grains gravity "
      "half_angles height heights integrator kind law level mass material materials mix name nodes of origin "
      "outline_nodes "
      "packing period pitch points poisson positions pressure probes quantity range recipe rotation row_pitch "
      "rows safety seed shape shapes share shear_stiffness shear_strength sides skin solid spacing stiffness "
      "strength support target tension thickness time title tolerance uniform velocity walls width x y young ";
  return word.find(' ') == word.npos && keys.find(fmt::format(" {} ", word)) != keys.npos;
}

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

}  // namespace pliant
