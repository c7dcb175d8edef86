#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace pliant {

namespace {

constexpr std::string_view keys[] = {
    "alpha",
    "angle",
    "angles",
    "beta",
    "between",
    "body",
    "bond_gap",
    "bottom",
    "boundary",
    "box",
    "branch_modulus",
    "caps",
    "checkpoint",
    "cohesion",
    "columns",
    "contact",
    "contacts",
    "count",
    "damping",
    "density",
    "descriptors",
    "deviation",
    "diameter",
    "direction",
    "discretisation",
    "displacement",
    "distribution",
    "domain",
    "end",
    "energy_consistent",
    "factors",
    "fatigue_rate",
    "fatigue_threshold",
    "fields",
    "file",
    "first",
    "force",
    "frames",
    "friction",
    "from",
    "gauss_points",
    "gradient",
    "grains",
    "gravity",
    "half_angles",
    "height",
    "heights",
    "high",
    "integrator",
    "kind",
    "law",
    "left",
    "length",
    "level",
    "low",
    "mass",
    "mass_damping",
    "material",
    "materials",
    "mean",
    "median",
    "mix",
    "mix_order",
    "mode",
    "moment",
    "name",
    "node",
    "nodes",
    "of",
    "origin",
    "outline",
    "outline_nodes",
    "packing",
    "part",
    "parts",
    "period",
    "pitch",
    "points",
    "poisson",
    "positions",
    "pressure",
    "probes",
    "pull",
    "quadrature",
    "quantity",
    "range",
    "recipe",
    "reduce",
    "refresh",
    "relaxation_time",
    "residual_strength",
    "restitution",
    "right",
    "rim_mass",
    "rotation",
    "rounding",
    "row_pitch",
    "rows",
    "safety",
    "seed",
    "self_contact",
    "shape",
    "shapes",
    "share",
    "shares",
    "shear_fatigue_rate",
    "shear_ratio",
    "shear_stiffness",
    "shear_strength",
    "side",
    "sides",
    "size",
    "skin",
    "smoothing",
    "solid",
    "solid_fraction",
    "spacing",
    "start",
    "stiffness",
    "stop_at_outputs",
    "strength",
    "support",
    "target",
    "tension",
    "thickness",
    "time",
    "title",
    "tolerance",
    "top",
    "uniform",
    "unit",
    "until",
    "variants",
    "velocity",
    "viscosity",
    "walls",
    "width",
    "with",
    "x",
    "y",
    "young",
};
static_assert(std::is_sorted(std::begin(keys), std::end(keys)));

}  // namespace

std::span<const std::string_view> scene_keys() { return keys; }

bool is_scene_key(std::string_view word) { return std::binary_search(scene_keys().begin(), scene_keys().end(), word); }

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
