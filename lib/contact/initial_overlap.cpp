#include "contact/initial_overlap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "contact/broad_phase.hpp"
#include "core/errors.hpp"

namespace pliant {
namespace {

/// Outline of one body, and of a wall the copies a period to either side.
struct Line {
  Points points;
  bool closed;

  std::size_t segments() const { return closed ? points.size() : points.size() - 1; }
  Vec2 edge(std::size_t i) const { return points[(i + 1) % points.size()] - points[i]; }
};

Line line_of(const Model& model, const Outlines& outlines, int body) {
  const OutlineShape& shape = model.outlines[outlines.shape[body]];
  Line line{{}, shape.turn_shift == 0};
  for (int turn = line.closed ? 0 : -1; turn <= (line.closed ? 0 : 1); ++turn)
    for (int i = 0; i < shape.count; ++i)
      line.points.emplace_back(outlines.x[outlines.offset[body] + i] + turn * shape.turn_shift,
                               outlines.y[outlines.offset[body] + i]);
  return line;
}

/// Depth of a point below the nearest segment, over the longest segment; negative outside. Near a corner both its segments are nearest: a point is
/// inside a re-entrant one when below either, inside a convex one when below both; the line that halves the corner decides alike.
double depth_below(const Line& line, const Vec2& x) {
  double nearest = 1e300, longest = 0, sign = 1;
  for (std::size_t i = 0; i < line.segments(); ++i) {
    const Vec2 edge = line.edge(i), r = x - line.points[i];
    const double length = edge.norm(), s = std::clamp(r.dot(edge) / (length * length), 0.0, 1.0);
    longest = std::max(longest, length);
    const double distance = (r - s * edge).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    const std::size_t n = line.segments();
    Vec2 along = edge / length;
    if (s == 0 && (line.closed || i > 0)) along += line.edge((i + n - 1) % n).normalized();
    if (s == 1 && (line.closed || i + 1 < n)) along += line.edge((i + 1) % n).normalized();
    const Vec2 foot = line.points[i] + s * edge;
    sign = along.x() * (x - foot).y() - along.y() * (x - foot).x() > 0 ? 1 : -1;
  }
  return sign * nearest / longest;
}

/// Whether a point is on the open side of everything in a box around an outline: off the box, or beyond a wall's surface.
bool is_clear(const Box& box, double turn_shift, const Vec2& x) {
  if (turn_shift != 0) return turn_shift < 0 ? x.y() > box.y_max : x.y() < box.y_min;
  return x.x() < box.x_min || x.x() > box.x_max || x.y() < box.y_min || x.y() > box.y_max;
}

/// Deepest node of the slave below the master's outline, over the master's segments; `shift`: added to x of the slave. Its middle counts as a node
/// where it lies inside the slave: of two bodies on the same spot no node is deep.
double deepest_node(const Model& model, const Outlines& outlines, const std::vector<Box>& boxes, int slave, int master,
                    double shift) {
  const Line line = line_of(model, outlines, master), own = line_of(model, outlines, slave);
  const Box& box = boxes[master];
  const double turn_shift = model.outlines[outlines.shape[master]].turn_shift, period = std::abs(turn_shift);
  Points nodes = own.points;
  const Vec2 middle = std::accumulate(nodes.begin(), nodes.end(), Vec2(0, 0)) / nodes.size();
  if (own.closed && depth_below(own, middle) > 0) nodes.push_back(middle);
  double deepest = 0;
  for (Vec2 x : nodes) {
    x.x() += shift;
    if (period > 0) x.x() -= period * std::floor((x.x() - box.x_min) / period);
    if (!is_clear(box, turn_shift, x)) deepest = std::max(deepest, depth_below(line, x));
  }
  return deepest;
}

/// Pairs whose boxes meet, and every body with every wall: what is behind a wall's surface lies in the wall.
std::vector<BodyPair> pairs_to_check(const Model& model, const std::vector<Box>& boxes) {
  std::vector<BodyPair> pairs = broad_phase(model, boxes, 0);
  std::erase_if(pairs, [&](const BodyPair& p) { return model.bodies[p.first].wall || model.bodies[p.second].wall; });
  const int count = static_cast<int>(model.bodies.size());
  for (int wall = 0; wall < count; ++wall)
    for (int body = 0; model.bodies[wall].wall && body < count; ++body)
      if (!model.bodies[body].wall || body > wall) pairs.push_back({std::min(wall, body), std::max(wall, body), 0});
  return pairs;
}

}  // namespace

void refuse_deep_overlap(const Model& model, const Outlines& outlines) {
  std::vector<Box> boxes;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    boxes.push_back(bounding_box(model.outlines[outlines.shape[b]], outlines, static_cast<int>(b)));
  for (const BodyPair& pair : pairs_to_check(model, boxes)) {
    const double shift = pair.images * model.scene.period.value_or(0);
    const double deepest = std::max(deepest_node(model, outlines, boxes, pair.first, pair.second, -shift),
                                    deepest_node(model, outlines, boxes, pair.second, pair.first, shift));
    if (deepest > 1)
      throw InputError(
          fmt::format("'{}' and '{}' overlap at the start by {:.2f} segment lengths of their outlines; at most 1 is "
                      "allowed: deeper contacts cannot be seen. Move them apart or make them smaller",
                      model.bodies[pair.first].name, model.bodies[pair.second].name, deepest));
  }
}

}  // namespace pliant
