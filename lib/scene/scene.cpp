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

double History::slope(double t) const {
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  if (after == time.begin() || after == time.end()) return 0;
  const auto i = static_cast<std::size_t>(after - time.begin());
  return (value[i] - value[i - 1]) / (time[i] - time[i - 1]);
}

double History::largest() const {
  double found = 0;
  for (const double v : value) found = std::max(found, std::abs(v));
  return found;
}

Eigen::Matrix2d CellSettings::gradient_at(double time) const {
  Eigen::Matrix2d f = Eigen::Matrix2d::Identity();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (!gradient[i][j].time.empty()) f(i, j) = gradient[i][j].at(time);
  return f;
}

Vec2 Scene::gravity_at(double time) const {
  return gravity_history.empty() ? gravity : Vec2(gravity_history[0].at(time), gravity_history[1].at(time));
}

const Material& Scene::material(const std::string& name) const { return find_named(materials, name, "material"); }

const ShapeSpec& Scene::shape(const std::string& name) const { return find_named(shapes, name, "shape"); }

std::vector<std::pair<int, double>> Scene::shape_shares(const Grains& grains) const {
  std::vector<std::pair<int, double>> all;
  const auto add = [&](const ShapeShare& part) {
    std::vector<int> members;
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (shapes[i].family == part.shape || shapes[i].name == part.shape) members.push_back(static_cast<int>(i));
    if (members.empty()) shape(part.shape);  // throws
    for (const int member : members) all.emplace_back(member, part.share / static_cast<double>(members.size()));
  };
  if (grains.shapes.empty()) add({grains.shape, 1});
  for (const ShapeShare& part : grains.shapes) add(part);
  return all;
}

std::int64_t Packing::grain_count() const {
  switch (kind) {
    case PackingKind::positions:
      return static_cast<std::int64_t>(positions.size());
    case PackingKind::hexagonal:
    case PackingKind::grid:
      return std::int64_t{columns} * rows;
    default:
      return count;
  }
}

}  // namespace pliant
