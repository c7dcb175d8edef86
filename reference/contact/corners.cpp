#include "reference/contact/corners.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant::reference {
namespace {

using Length = Jet<14>;
struct Arrow {
  Length x, y;
};
Arrow operator-(const Arrow& a, const Arrow& b) { return {a.x - b.x, a.y - b.y}; }
Length dot(const Arrow& a, const Arrow& b) { return a.x * b.x + a.y * b.y; }
Length norm(const Arrow& a) { return sqrt(dot(a, a)); }

constexpr double degree = std::numbers::pi / 180;
constexpr double corner_turn = 35 * degree;  ///< the least
constexpr double square = 0.9;               ///< cosine of the angle by which opposed normals may differ, squarely
constexpr double oblique = 0.8;              ///< likewise: from which on a segment does not lie flat on a face
constexpr double tie = 1e-9;                 ///< of a segment's length: nodes on the line of a face count as inside
constexpr double steepest = 0.25;            ///< least part along the face that a segment counts with, over its length
constexpr double lesser = 0.18;              ///< difference of such cosines from which a corner's other segment is idle

double turn(const Vec2& before, const Vec2& after) {
  return std::atan2(pliant::cross(before, after), before.dot(after));
}

/// The better of the cosines between the two normals of a node, turned round, and a segment's.
double opposition(const Face& master, int segment, const SlaveNode& node) {
  const Vec2 t = master.outline.tangent(segment);
  return std::max((node.before - node.at).normalized().dot(t), (node.at - node.after).normalized().dot(t));
}

double along(const Face& master, int segment, const SlaveNode& node) {
  return (node.at - master.outline.node(segment)).dot(master.outline.tangent(segment));
}

double height(const Face& master, int segment, const SlaveNode& node) {
  return pliant::cross(master.outline.tangent(segment), master.outline.node(segment) - node.at);
}

/// The corner that ends a segment's face on a way (-1 or 1), if it is no further than `limit` from beside the node.
std::optional<int> face_end(const Face& master, int segment, const SlaveNode& node, int way, double limit) {
  const double length = master.outline.length(segment), foot = std::clamp(along(master, segment, node), 0.0, length);
  double distance = way < 0 ? foot : length - foot;
  int end = way < 0 ? segment : segment + 1;
  for (; distance <= limit && !master.corners.at(end); end += way)
    distance += master.outline.length(way < 0 ? end - 1 : end);
  return distance <= limit ? std::optional(end) : std::nullopt;
}

/// Whether a point lies past a corner, seen from the face that ends there on that way.
bool is_past(const Face& master, int corner, int way, const Vec2& point) {
  return way * (point - master.outline.node(corner)).dot(master.outline.tangent(way < 0 ? corner : corner - 1)) > 0;
}

bool is_beyond(const Face& master, int segment, const SlaveNode& node) {
  return (master.corners.at(segment) && is_past(master, segment, -1, node.at)) ||
         (master.corners.at(segment + 1) && is_past(master, segment + 1, 1, node.at));
}

/// The segment of the face beyond a corner that the node stands beside.
std::optional<int> beside_face(const Face& master, int corner, int way, const SlaveNode& node, double outward) {
  int segment = way < 0 ? corner - 1 : corner;
  if (is_past(master, corner, -way, node.at)) return {};
  for (int next = segment + (way < 0 ? 0 : 1); !master.corners.at(next); next += way, segment += way) {
    const Vec2 halving = master.outline.tangent(next - 1) + master.outline.tangent(next);
    if (((node.at - master.outline.node(next)).dot(halving) < 0) != (way < 0)) break;
  }
  if (is_beyond(master, segment, node) || height(master, segment, node) > outward) return {};
  return segment;
}

/// From 0 at `low` to 1 at `high`, with slope 0 there.
Length ramp(const Length& x, double low, double high) {
  const Length u = (x - low) / (high - low);
  if (u.value <= 0) return 0;
  return u.value < 1 ? u * u * (3 - 2 * u) : Length(1);
}

}  // namespace

Corners::Corners(const ContactOutline& outline) {
  const int n = outline.count;
  const auto edge = [&](int i) {
    const int from = ((i % n) + n) % n, to = (from + 1) % n;
    return Vec2(outline.reference[to] + Vec2(to == 0 ? outline.turn_shift : 0, 0) - outline.reference[from]);
  };
  for (int i = 0; i < n; ++i) {
    corner_.push_back(turn(edge(i - 1), edge(i)) > corner_turn);
    length_.push_back(edge(i).norm());
  }
  any_ = std::count(corner_.begin(), corner_.end(), true) > 0;
  longest_ = *std::max_element(length_.begin(), length_.end());
}

std::optional<int> opposing_segment(const Face& master, int segment, const SlaveNode& node, double outward) {
  if (!master.corners.any()) return segment;
  std::optional<int> result = segment;
  if (opposition(master, segment, node) < square) {
    for (const int way : {-1, 1}) {
      const std::optional<int> end = face_end(master, segment, node, way, master.sight);
      if (!end) continue;
      if (!node.corner) result = {};
      if (opposition(master, way < 0 ? *end - 1 : *end, node) < square) continue;
      const bool inside = height(master, segment, node) < tie * master.outline.length(segment);
      result = beside_face(master, *end, way, node, outward);
      // Outside of the one face it is outside of the body, however deep below the line of the other.
      if (result && !inside && height(master, *result, node) < 0) result = {};
      if (!result && inside && node.corner) result = segment;
      break;
    }
  }
  return result && is_beyond(master, *result, node) ? std::nullopt : result;
}

NodeLength node_length(const Face& master, int segment, const SlaveNode& node) {
  const auto arrow = [](const Vec2& place, int number) {
    return Arrow{{place.x(), 2 * number}, {place.y(), 2 * number + 1}};
  };
  const Vec2 own[3] = {node.before, node.at, node.after};
  const Arrow point[3] = {arrow(own[0], 0), arrow(own[1], 1), arrow(own[2], 2)};
  const Arrow chord = arrow(master.outline.node(segment + 1), 4) - arrow(master.outline.node(segment), 3);
  const Length length = norm(chord);
  const auto cosine = [&](int neighbour) {
    const Arrow edge = neighbour == 0 ? point[0] - point[1] : point[1] - point[2];
    return dot(edge, chord) / (norm(edge) * length);
  };
  NodeLength result;
  for (const int neighbour : {0, 2}) {
    const double full = neighbour == 0 ? node.length_before : node.length_after;
    const Length onward = dot(point[neighbour] - point[1], chord) / length;
    const int way = onward.value < 0 ? -1 : 1;
    Length part = 0.5 * full;
    std::optional<int> end;
    if (master.corners.any() && !node.corner)
      end = face_end(master, segment, node, way, 3 * (own[neighbour] - node.at).norm());
    if (end) {
      const int number = way < 0 ? 0 : 1;
      const Arrow corner = arrow(master.outline.node(*end), 5 + number);
      const double least = steepest * (own[neighbour] - node.at).norm();
      const Length reach = way * onward.value < least ? Length(least) : way < 0 ? -onward : onward;
      const Length to_corner = dot(corner - point[1], chord) / length, r = (way < 0 ? -to_corner : to_corner) / reach;
      // The last node before the corner, and the one before that; beyond, a segment counts half as ever.
      const bool last = r.value < 1,
                 next_to_last = !last && r.value < 2 && !(neighbour == 0 ? node.corner_before : node.corner_after);
      const Length more = last ? 1.5 * r - 1 : next_to_last ? 1 - 0.5 * r : Length(0);
      if (last || next_to_last) result.corner[number] = *end;
      part += full * (more.value > 0 ? more * ramp(cosine(neighbour), oblique, square) : more);
    }
    if (node.corner) part *= 1 - ramp(cosine(2 - neighbour) - cosine(neighbour), 0, lesser);
    result.value += part;
  }
  if (result.value.value <= 0) result.value = 0;  // beside a face shorter than the node's own segments
  return result;
}

}  // namespace pliant::reference
