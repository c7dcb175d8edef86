#pragma once

#include <array>
#include <numbers>
#include <span>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Of each segment or node segments of the outline, as offsets of their numbers from its own: see
/// medial_neighbours.hpp.
struct MedialNeighbours {
  std::vector<int> start, offset;  ///< [count + 1], in `offset`
  std::span<const int> of(int number) const {
    return {offset.data() + start[number], offset.data() + start[number + 1]};
  }
};

/// Reference outline of a shape: what contact needs and never changes. Node arrays are extended cyclically by
/// lane_count entries, so that eight consecutive nodes can be loaded from any start.
struct OutlineShape {
  int count = 0;          ///< nodes
  double turn_shift = 0;  ///< x offset after one turn: 0 for closed outlines, +- period for walls
  double spacing = 0;     ///< mean segment length, m
  Points points;          ///< [count], reference coordinates about the centroid (walls: about the line's start)
  std::vector<double> tributary_length;  ///< [count + lane_count], half of the two adjacent segments, m
  std::vector<double> segment_length;    ///< [count + lane_count], from each node to the next, m
  double longest = 0;                    ///< of them, m

  MedialNeighbours medial, node_medial;  ///< of segments and of nodes, as deep as contact sees
  /// [count] of each segment, whether that before it, and that behind it, is shorter: see medial_neighbours.hpp.
  std::vector<std::array<bool, 2>> shorter_next;

  /// Nodes at which the outline turns to the left by more than `corner_turn`: where two faces meet.
  std::vector<bool> corner;  ///< [count]; empty: there is none
  bool has_corners() const { return !corner.empty(); }
};

/// Rounded outlines turn by less from segment to segment; less turned faces push and slide as one.
constexpr double corner_turn = 35 * std::numbers::pi / 180;

OutlineShape make_outline_shape(const Points& points, double turn_shift);

/// A vector at every outline node of all bodies: those of one body after another, from Model::outline_offset on, each
/// followed by lane_count cyclic copies.
struct OutlineField {
  std::vector<double> x, y;  ///< [nodes and copies]

  OutlineField() = default;
  explicit OutlineField(int nodes) : x(static_cast<std::size_t>(nodes), 0.0), y(x) {}
  Vec2 at(int index) const { return {x[static_cast<std::size_t>(index)], y[static_cast<std::size_t>(index)]}; }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("x", x), visitor("y", y);
  }
};

/// All outlines in motion: what bodies of either kind see of each other (docs/method.md 1).
struct Outlines {
  OutlineField position;                 ///< m
  OutlineField velocity;                 ///< m/s; empty without Model::outline_rates
  std::vector<double> tributary_length;  ///< [nodes and copies], present, m; empty: that of the shapes holds

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("position", position), visitor("velocity", velocity), visitor("tributary_length", tributary_length);
  }
};

/// Floor division: the turn that a node index beyond [0, count) lies in.
inline int turn_of(int index, int count) {
  if (index >= 0 && index < count) return 0;  // most often: a division takes as long as some twenty other operations
  return index >= 0 ? index / count : -((count - 1 - index) / count);
}

}  // namespace pliant
