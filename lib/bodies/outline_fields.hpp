#pragma once

#include <array>
#include <numbers>
#include <span>
#include <vector>

#include "core/vec2.hpp"
#include "geometry/cell.hpp"

namespace pliant {

/// Medial neighbours of each segment or node: segments of the outline, as offsets of their numbers from its own; see
/// medial_neighbours.hpp.
struct MedialNeighbours {
  std::vector<int> start, offset;  ///< [count + 1], in `offset`
  std::span<const int> of(int number) const {
    return {offset.data() + start[number], offset.data() + start[number + 1]};
  }
};

/// Reference outline of a shape: constant data for contact. Node arrays are extended cyclically by lane_count entries,
/// so that eight consecutive nodes can be loaded from any start.
struct OutlineShape {
  int count = 0;          ///< nodes
  double turn_shift = 0;  ///< x offset after one turn: 0 for closed outlines, +- period for walls
  double spacing = 0;     ///< mean segment length, m
  Points points;          ///< [count], reference coordinates about the centroid (walls: about the line's start)
  std::vector<double> tributary_length;  ///< [count + lane_count], half of the two adjacent segments, m
  std::vector<double> segment_length;    ///< [count + lane_count], from each node to the next, m
  double longest = 0;                    ///< longest segment, m

  MedialNeighbours medial, node_medial;  ///< of segments and of nodes, down to the detection depth of contact
  /// [count] for each segment, whether the one before it, and the one behind it, is shorter: see medial_neighbours.hpp.
  std::vector<std::array<bool, 2>> shorter_next;

  /// Corners: nodes at which the outline turns left by more than `corner_turn`, where two faces meet.
  std::vector<bool> corner;  ///< [count]; empty: no corners
  bool has_corners() const { return !corner.empty(); }
};

/// Rounded outlines turn by less from segment to segment. Faces with a smaller angle push and slide like one face.
constexpr double corner_turn = 35 * std::numbers::pi / 180;

OutlineShape make_outline_shape(const Points& points, double turn_shift);

/// Vector at every outline node of all bodies. The nodes of each body start at Model::outline_offset and are followed
/// by lane_count cyclic copies.
struct OutlineField {
  std::vector<double> x, y;  ///< [nodes and copies]
  Lattice lattice;           ///< how periodic images of the nodes differ from these

  OutlineField() = default;
  explicit OutlineField(int nodes) : x(static_cast<std::size_t>(nodes), 0.0), y(x) {}
  Vec2 at(int index) const { return {x[static_cast<std::size_t>(index)], y[static_cast<std::size_t>(index)]}; }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("x", x), visitor("y", y), visitor("lattice", lattice);
  }
};

/// Current outlines of all bodies, for contact between bodies of any kind (docs/method.md 1).
struct Outlines {
  OutlineField position;                 ///< m
  OutlineField velocity;                 ///< m/s; empty without Model::outline_rates
  std::vector<double> tributary_length;  ///< [nodes and copies], current, m; empty: those of the shapes apply

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("position", position), visitor("velocity", velocity), visitor("tributary_length", tributary_length);
  }
};

/// Floor division: the turn of a node index beyond [0, count).
inline int turn_of(int index, int count) {
  if (index >= 0 && index < count)
    return 0;  // the usual case: a division takes as long as some twenty other operations
  return index >= 0 ? index / count : -((count - 1 - index) / count);
}

}  // namespace pliant
