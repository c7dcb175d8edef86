#include "geometry/grain_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"
#include "geometry/mesh.hpp"
#include "geometry/overlap.hpp"
#include "geometry/polygon.hpp"

namespace pliant {
namespace {

// Distance that grains keep, over the mean radius of the circles around them. It hides the errors of distance tables
// and of an unfinished relaxation, and costs about 1 % of solid fraction.
constexpr double clearance = 0.01;
// A stage ends when no node is deeper in the clearance than this share of it.
constexpr double settled_clearance = 0.9;
constexpr double skin = 0.3;  // of the mean radius: neighbours further away are not in the list

}  // namespace

GrainRelaxation::Shape GrainRelaxation::make_shape(const Points& outline) {
  Shape shape{outline, {}, DistanceField(outline), perimeter(outline), 0, 0};
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double length = (outline[(i + 1) % n] - outline[(i + n - 1) % n]).norm() / 2;
    shape.weight.push_back(length / shape.length);
    shape.radius = std::max(shape.radius, outline[i].norm());
  }
  const PolygonProperties properties = polygon_properties(outline);
  shape.gyration = std::sqrt(properties.polar_moment / properties.area);
  return shape;
}

void GrainRelaxation::Push::add(const Push& other) {
  force += other.force;
  moment += other.moment;
  deepest = std::max(deepest, other.deepest);
}

GrainRelaxation::GrainRelaxation(std::vector<Placement>& grains, const std::vector<Points>& outlines,
                                 const Strip& region, const std::vector<WallProfile>& walls, bool turn)
    : grains_(grains),
      region_(region),
      walls_(walls),
      turn_(turn),
      index_(outlines.size(), -1),
      nodes_(grains.size()),
      velocity_(grains.size()),
      spin_(grains.size()) {
  for (const Placement& grain : grains) {
    if (index_[grain.shape] < 0) {
      index_[grain.shape] = static_cast<int>(shapes_.size());
      shapes_.push_back(make_shape(outlines[grain.shape]));
    }
    unit_ += radius(grain) / static_cast<double>(grains.size());
  }
}

bool GrainRelaxation::relax(int sweeps) {
  std::fill(velocity_.begin(), velocity_.end(), Vec2(0, 0));
  std::fill(spin_.begin(), spin_.end(), 0.0);
  Fire fire;
  find_pairs();
  double limit = settled_clearance * clearance;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const double deepest = push_all();
    if (deepest < limit) {
      if (!overlapping()) return true;
      limit /= 2;  // the tables did not detect it: increase the distance
    }
    step(fire);
  }
  return false;
}

/// Vector from one grain to the nearest image of another.
Vec2 GrainRelaxation::apart(const Placement& from, const Placement& to) const {
  Vec2 d = to.centre - from.centre;
  if (region_.periodic) d.x() -= std::round(d.x() / region_.width()) * region_.width();
  if (region_.periodic_y) d.y() -= std::round(d.y() / region_.height()) * region_.height();
  return d;
}

/// Finds all pairs that may come near before the next search, in the order of x.
void GrainRelaxation::find_pairs() {
  found_at_.clear();
  for (Placement& grain : grains_) {
    if (region_.periodic)
      grain.centre.x() -= std::floor((grain.centre.x() - region_.left) / region_.width()) * region_.width();
    if (region_.periodic_y)
      grain.centre.y() -= std::floor((grain.centre.y() - region_.bottom) / region_.height()) * region_.height();
    found_at_.push_back(grain.centre);
  }
  std::vector<int> order(grains_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(grains_[a].centre.x(), a) < std::pair(grains_[b].centre.x(), b); });
  double largest = 0;
  for (const Placement& grain : grains_) largest = std::max(largest, radius(grain));
  pairs_.clear();
  const std::size_t n = order.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 1; k < (region_.periodic ? 2 * n : n); ++k) {
      const std::size_t j = k % n;
      if (j == i) break;
      const Placement &a = grains_[order[i]], &b = grains_[order[j]];
      const double ahead = b.centre.x() - a.centre.x() + (k < n ? 0 : region_.width());
      if (ahead > radius(a) + largest + reach() || (region_.periodic && ahead > region_.width() / 2)) break;
      if (apart(a, b).norm() < radius(a) + radius(b) + reach()) pairs_.push_back({order[i], order[j]});
    }
}

double GrainRelaxation::reach() const { return (clearance + skin) * unit_; }

bool GrainRelaxation::pairs_are_stale() const {
  double largest = 0;
  for (std::size_t i = 0; i < grains_.size(); ++i)
    largest = std::max(largest, (grains_[i].centre - found_at_[i]).squaredNorm());
  return std::sqrt(largest) > skin * unit_ / 2;
}

/// Forces of the nodes of one grain on another. Nodes are relative to their grain's centre, m.
void GrainRelaxation::push(int slave, int master, const Vec2& to_slave, Push& on_slave, Push& on_master) const {
  const Placement& grain = grains_[master];
  const Shape& shape = shape_of(grain);
  const double outer = shape.radius * grain.scale + clearance * unit_;
  const double c = std::cos(grain.angle), s = std::sin(grain.angle);
  const Points& nodes = nodes_[slave];
  const std::vector<double>& weight = shape_of(grains_[slave]).weight;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const Vec2 r = to_slave + nodes[k];
    if (r.squaredNorm() > outer * outer) continue;
    const DistanceField::Sample sample =
        shape.distance.at(Vec2(c * r.x() + s * r.y(), c * r.y() - s * r.x()) / grain.scale);
    const double depth = clearance - sample.distance * grain.scale / unit_;
    if (depth <= 0) continue;
    const Vec2 normal(c * sample.gradient.x() - s * sample.gradient.y(),
                      s * sample.gradient.x() + c * sample.gradient.y());
    const Vec2 force = weight[k] * depth * normal;
    on_slave.add(force, nodes[k] / unit_);
    on_master.add(-force, r / unit_);
    on_slave.deepest = std::max(on_slave.deepest, depth);
  }
}

GrainRelaxation::Push GrainRelaxation::push_of_edges(int i) const {
  Push result;
  const Placement& grain = grains_[i];
  const std::vector<double>& weight = shape_of(grain).weight;
  const auto touch = [&](double gap, const Vec2& normal, std::size_t k) {
    const double depth = clearance - gap / unit_;
    if (depth <= 0) return;
    result.add(weight[k] * depth * normal, nodes_[i][k] / unit_);
    result.deepest = std::max(result.deepest, depth);
  };
  for (std::size_t k = 0; k < nodes_[i].size(); ++k) {
    const Vec2 x = grain.centre + nodes_[i][k];
    if (region_.periodic_y) continue;
    touch(x.y() - region_.bottom, Vec2(0, 1), k);
    touch(region_.top - x.y(), Vec2(0, -1), k);
    if (region_.periodic) continue;
    touch(x.x() - region_.left, Vec2(1, 0), k);
    touch(region_.right - x.x(), Vec2(-1, 0), k);
  }
  for (const WallProfile& wall : walls_) push_of_wall(i, wall, result);
  return result;
}

/// Forces between nodes of the grain and the wall's line, and between points of the line and the grain.
void GrainRelaxation::push_of_wall(int i, const WallProfile& wall, Push& result) const {
  const Placement& grain = grains_[i];
  const double outer = radius(grain) + clearance * unit_;
  if (wall.clear_of(grain.centre, outer)) return;
  const Shape& shape = shape_of(grain);
  const auto touch = [&](double depth, double weight, const Vec2& normal, const Vec2& arm) {
    if (depth <= 0) return;
    result.add(weight * depth * normal, arm / unit_);
    result.deepest = std::max(result.deepest, depth);
  };
  for (std::size_t k = 0; k < nodes_[i].size(); ++k) {
    const DistanceField::Sample sample = wall.at(grain.centre + nodes_[i][k]);
    touch(clearance - sample.distance / unit_, shape.weight[k], sample.gradient, nodes_[i][k]);
  }
  const double c = std::cos(grain.angle), s = std::sin(grain.angle);
  const Points line = wall.between(grain.centre.x() - outer, grain.centre.x() + outer);
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec2 r = line[k] - grain.centre;
    if (r.squaredNorm() > outer * outer) continue;
    const DistanceField::Sample sample =
        shape.distance.at(Vec2(c * r.x() + s * r.y(), c * r.y() - s * r.x()) / grain.scale);
    const Vec2 outward(c * sample.gradient.x() - s * sample.gradient.y(),
                       s * sample.gradient.x() + c * sample.gradient.y());
    const double share = (line[k] - line[k - 1]).norm() / (grain.scale * shape.length);
    touch(clearance - sample.distance * grain.scale / unit_, share, -outward, r);
  }
}

void GrainRelaxation::place_nodes() {
  parallel_for(static_cast<int>(grains_.size()), [&](int i) {
    Placement at_origin = grains_[i];
    at_origin.centre = Vec2(0, 0);
    nodes_[i] = placed_outline(shape_of(grains_[i]).outline, at_origin);
  });
}

/// Computes forces on all grains; returns the depth of the deepest node in the clearance of others or of the region's
/// edges.
double GrainRelaxation::push_all() {
  if (pairs_are_stale()) find_pairs();
  place_nodes();
  pair_pushes_.assign(pairs_.size(), {});
  parallel_for(static_cast<int>(pairs_.size()), [&](int p) {
    const auto [a, b] = pairs_[p];
    const Vec2 to_b = apart(grains_[a], grains_[b]);
    auto& [on_a, on_b] = pair_pushes_[p];
    push(b, a, to_b, on_b, on_a);
    push(a, b, -to_b, on_a, on_b);
  });
  pushes_.resize(grains_.size());
  parallel_for(static_cast<int>(grains_.size()), [&](int i) { pushes_[i] = push_of_edges(i); });
  // Serial, in the order of the pairs: the same sums on any number of threads.
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    pushes_[pairs_[p].first].add(pair_pushes_[p].first);
    pushes_[pairs_[p].second].add(pair_pushes_[p].second);
  }
  double deepest = 0;
  for (const Push& push : pushes_) deepest = std::max(deepest, push.deepest);
  return deepest;
}

/// Rotational inertia of a grain of mass 1.
double GrainRelaxation::inertia(const Placement& grain) const {
  return std::pow(grain.scale * shape_of(grain).gyration / unit_, 2);
}

void GrainRelaxation::step(Fire& fire) {
  double power = 0, speed = 0, force = 0;
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    const double lever = 1 / std::sqrt(inertia(grains_[i]));
    if (!turn_) pushes_[i].moment = 0;
    pushes_[i].moment *= lever;  // the angle is in units in which inertia is 1
    power += pushes_[i].force.dot(velocity_[i]) + pushes_[i].moment * spin_[i];
    speed += velocity_[i].squaredNorm() + spin_[i] * spin_[i];
    force += pushes_[i].force.squaredNorm() + pushes_[i].moment * pushes_[i].moment;
  }
  const double along = force > 0 ? fire.alpha * std::sqrt(speed / force) : 0;
  const bool down = power > 0;
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    velocity_[i] = down ? Vec2((1 - fire.alpha) * velocity_[i] + along * pushes_[i].force) : Vec2(0, 0);
    spin_[i] = down ? (1 - fire.alpha) * spin_[i] + along * pushes_[i].moment : 0;
  }
  fire.adapt(down);
  move(fire.dt);
}

void GrainRelaxation::move(double dt) {
  for (std::size_t i = 0; i < grains_.size(); ++i) {
    Placement& grain = grains_[i];
    velocity_[i] += dt * pushes_[i].force;
    spin_[i] += dt * pushes_[i].moment;
    grain.centre += dt * unit_ * velocity_[i];
    grain.angle += dt * spin_[i] / std::sqrt(inertia(grain));
    // Scattered grains may be pushed out of a box before they are pushed back.
    if (!region_.periodic_y) grain.centre.y() = std::clamp(grain.centre.y(), region_.bottom, region_.top);
    if (!region_.periodic) grain.centre.x() = std::clamp(grain.centre.x(), region_.left, region_.right);
  }
}

/// Whether the true outlines of some pair, or of a grain and a wall, overlap.
bool GrainRelaxation::overlapping() const {
  std::vector<char> overlap(pairs_.size(), 0);
  parallel_for(static_cast<int>(pairs_.size()), [&](int p) {
    const auto [a, b] = pairs_[p];
    Points other = nodes_[b];
    const Vec2 to_b = apart(grains_[a], grains_[b]);
    if (to_b.norm() > radius(grains_[a]) + radius(grains_[b])) return;
    for (Vec2& x : other) x += to_b;
    overlap[p] = polygons_overlap(nodes_[a], other);
  });
  if (std::any_of(overlap.begin(), overlap.end(), [](char one) { return one != 0; })) return true;
  for (const WallProfile& wall : walls_)
    for (std::size_t i = 0; i < grains_.size(); ++i) {
      if (wall.clear_of(grains_[i].centre, radius(grains_[i]))) continue;
      Points outline = nodes_[i];
      for (Vec2& x : outline) x += grains_[i].centre;
      if (wall.overlaps(outline)) return true;
    }
  return false;
}

}  // namespace pliant
