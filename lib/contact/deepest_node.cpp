#include "contact/deepest_node.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant {
namespace {

Vec2 node_at(const Model& model, const OutlineField& outlines, int body, int node) {
  const OutlineShape& shape = model.outline_of(body);
  const int turn = turn_of(node, shape.count), at = model.outline_offset[body] + node - turn * shape.count;
  return {outlines.x[at] + turn * shape.turn_shift, outlines.y[at]};
}

/// Where a point stands above the nearest segment of an outline.
struct Nearest {
  double distance = 1e300, depth = 0, length = 1;
  int number = 0;
};

/// The slave looks at the master: moved by `shift` in x or, where one is a wall, at whichever image in a period is
/// nearest.
struct Sight {
  int slave, master;
  double shift = 0, period = 0;
  Sight back() const { return {master, slave, -shift, period}; }
};

Sight sight_of(const Model& model, const BodyPair& pair) {
  const double period = model.scene.period.value_or(0);
  if (model.bodies[pair.first].wall || model.bodies[pair.second].wall) return {pair.first, pair.second, 0, period};
  return {pair.first, pair.second, pair.images * period};
}

/// From a segment's first node, by the nearest image in a period.
Vec2 lever(const Vec2& point, const Vec2& node, double period) {
  Vec2 r = point - node;
  if (period > 0) r.x() -= period * std::round(r.x() / period);
  return r;
}

Nearest nearest_segment(const Model& model, const OutlineField& outlines, int master, const Vec2& point,
                        double period = 0) {
  Nearest nearest;
  const int count = model.outline_of(master).count;
  for (int s = 0; s < count; ++s) {
    const Vec2 a = node_at(model, outlines, master, s), b = node_at(model, outlines, master, s + 1);
    const double length = (b - a).norm();
    const Vec2 r = lever(point, a, period), tangent = (b - a) / length;
    const double along = std::clamp(r.dot(tangent), 0.0, length), distance = (r - along * tangent).norm();
    const double depth = r.y() * tangent.x() - r.x() * tangent.y();
    // At a corner two segments are equally near; the one seen more steeply tells in from out.
    const bool same = std::abs(distance - nearest.distance) <= 1e-9 * length;
    if (same ? std::abs(depth) > std::abs(nearest.depth) : distance < nearest.distance)
      nearest = {distance, depth, length, s};
  }
  return nearest;
}

/// Whether a point is on the open side of everything in a box around an outline: off the box, or beyond a wall's
/// surface.
bool is_clear(const Box& box, const OutlineShape& shape, const Vec2& x, double period) {
  if (shape.turn_shift != 0) return shape.turn_shift < 0 ? x.y() > box.y_max : x.y() < box.y_min;
  const Vec2 from_middle = lever(x, Vec2(0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)), period);
  return std::abs(from_middle.x()) > 0.5 * (box.x_max - box.x_min) ||
         std::abs(from_middle.y()) > 0.5 * (box.y_max - box.y_min);
}

void look_at(const Model& model, const OutlineField& outlines, const Sight& sight, DeepestNode& deepest) {
  const auto [slave, master, shift, period] = sight;
  const OutlineShape& shape = model.outline_of(master);
  const Box box = bounding_box(model, outlines, master);
  const int nodes = model.outline_of(slave).count;
  for (int node = 0; node < nodes; ++node) {
    const Vec2 position = node_at(model, outlines, slave, node), seen = position - Vec2(shift, 0);
    if (is_clear(box, shape, seen, period)) continue;
    const Nearest nearest = nearest_segment(model, outlines, master, seen, period);
    if (nearest.depth * deepest.segment_length > deepest.depth * nearest.length)
      deepest = {slave,
                 master,
                 node,
                 position,
                 nearest.depth,
                 nearest.length,
                 nearest.length / shape.segment_length[nearest.number]};
  }
}

/// Mean of a body's outline nodes.
Vec2 middle_of(const Model& model, const OutlineField& outlines, int body) {
  const int count = model.outline_of(body).count;
  Vec2 sum(0, 0);
  for (int node = 0; node < count; ++node) sum += node_at(model, outlines, body, node);
  return sum / count;
}

/// Of two bodies on the same spot no node is deep, but their middles are.
bool share_a_middle(const Model& model, const OutlineField& outlines, const BodyPair& pair) {
  if (model.bodies[pair.first].wall || model.bodies[pair.second].wall) return false;
  const Vec2 middle = middle_of(model, outlines, pair.first), seen = middle - Vec2(sight_of(model, pair).shift, 0);
  const Nearest own = nearest_segment(model, outlines, pair.first, middle),
                other = nearest_segment(model, outlines, pair.second, seen);
  return own.depth > own.length && other.depth > other.length;
}

/// Pairs whose boxes meet, and every body with every wall: what is behind a wall's surface lies in the wall.
std::vector<BodyPair> pairs_that_may_overlap(const Model& model, const OutlineField& outlines) {
  std::vector<Box> boxes;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    boxes.push_back(bounding_box(model, outlines, static_cast<int>(b)));
  std::vector<BodyPair> pairs;
  for (const BodyPair& p : broad_phase(model, boxes, 0))
    if (!model.bodies[p.first].wall && !model.bodies[p.second].wall) pairs.push_back(p);
  const int bodies = static_cast<int>(model.bodies.size());
  for (int wall = 0; wall < bodies; ++wall)
    for (int body = 0; model.bodies[wall].wall && body < bodies; ++body)
      if (!model.bodies[body].wall || body < wall) pairs.push_back({body, wall, 0});
  return pairs;
}

}  // namespace

DeepestNode deepest_node(const Model& model, const OutlineField& outlines, const std::vector<BodyPair>& pairs) {
  DeepestNode deepest;
  for (const BodyPair& pair : pairs) {
    const Sight sight = sight_of(model, pair);
    look_at(model, outlines, sight, deepest);
    look_at(model, outlines, sight.back(), deepest);
  }
  return deepest;
}

void refuse_deep_overlap(const Model& model, const OutlineField& outlines) {
  const auto refuse = [&](int a, int b, const std::string& how) {
    const std::string other = a == b ? "its own periodic image" : fmt::format("'{}'", model.bodies[b].name);
    throw InputError(fmt::format("'{}' and {} overlap at the start {}; move them apart or make them smaller",
                                 model.bodies[a].name, other, how));
  };
  const std::vector<BodyPair> pairs = pairs_that_may_overlap(model, outlines);
  for (const BodyPair& pair : pairs)
    if (share_a_middle(model, outlines, pair)) refuse(pair.first, pair.second, "nearly wholly");
  const DeepestNode deepest = deepest_node(model, outlines, pairs);
  if (deepest.depth > deepest.segment_length)
    refuse(deepest.slave, deepest.master,
           fmt::format("by {:.3g} m, {:.2f} segment lengths of the outline; at most 1 is allowed, deeper contacts "
                       "cannot be seen",
                       deepest.depth, deepest.depth / deepest.segment_length));
}

}  // namespace pliant
