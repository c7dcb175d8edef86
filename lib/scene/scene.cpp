#include "scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "scene/names.hpp"

namespace pliant {

namespace {

template <class Named>
const Named& find_named(const std::vector<Named>& all, const std::string& name, const char* what) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  throw InputError(fmt::format("unknown {} '{}'; {}", what, name, allowed_names(name, names)));
}

}  // namespace

double History::at(double t) const {
  if (time.empty()) return 0;
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  if (after == time.begin()) return value.front();
  if (after == time.end()) return value.back();
  const auto i = static_cast<std::size_t>(after - time.begin());
  const double share = (t - time[i - 1]) / (time[i] - time[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

double History::integral(double t0, double t1) const {
  if (t1 < t0) return -integral(t1, t0);
  // Piece by piece from t0 on: the difference of two long integrals would lose a short step to rounding.
  double sum = 0;
  double from = t0;
  for (auto knot = std::upper_bound(time.begin(), time.end(), t0); knot != time.end() && *knot < t1; ++knot) {
    sum += 0.5 * (at(from) + at(*knot)) * (*knot - from);
    from = *knot;
  }
  return sum + 0.5 * (at(from) + at(t1)) * (t1 - from);
}

const Material& Scene::material(const std::string& name) const { return find_named(materials, name, "material"); }

const ShapeSpec& Scene::shape(const std::string& name) const { return find_named(shapes, name, "shape"); }

const ContactRule* Scene::rule(const std::string& first_material, const std::string& second_material) const {
  const ContactRule* general = nullptr;
  for (const ContactRule& one : contacts) {
    const bool same = one.first == first_material && one.second == second_material;
    if (same || (one.first == second_material && one.second == first_material)) return &one;
    if (one.first == "all") general = &one;
  }
  return general;
}

}  // namespace pliant
