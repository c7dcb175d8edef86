#pragma once

#include <numbers>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Reference outline of a shape: what contact needs and never changes. Node arrays are extended cyclically by lane_count entries, so that
/// eight consecutive nodes can be loaded from any start.
struct OutlineShape {
  int count = 0;          ///< nodes
  double turn_shift = 0;  ///< x offset after one turn: 0 for closed outlines, +- period for walls
  double spacing = 0;     ///< mean segment length, m
  Points points;          ///< [count], reference coordinates about the centroid (walls: about the line's start)
  std::vector<double> tributary_length;  ///< [count + lane_count], half of the two adjacent segments, m
  std::vector<double> segment_length;    ///< [count], from each node to the next, m
  double longest = 0;                    ///< of them, m

  /// Nodes at which the outline turns to the left by more than `corner_turn`: where two faces meet.
  std::vector<bool> corner;  ///< [count]; empty: there is none
  bool has_corners() const { return !corner.empty(); }
};

/// Rounded outlines turn by less from segment to segment; less turned faces push and slide as one.
constexpr double corner_turn = 35 * std::numbers::pi / 180;

OutlineShape make_outline_shape(const Points& points, double turn_shift);

/// Current outlines of all bodies, one after another; each body's nodes are followed by lane_count cyclic copies.
/// Both kinds of body show this one face to contact (METHOD 1).
struct Outlines {
  std::vector<int> shape;                      ///< [bodies], index of the outline shape
  std::vector<int> offset;                     ///< [bodies + 1], first node of a body
  std::vector<double> x, y;                    ///< [nodes and copies], m
  std::vector<double> force_x, force_y;        ///< [nodes and copies], contact force, N/m; 0 in the copies
  std::vector<double> x_refresh, y_refresh;    ///< positions at the last contact refresh
  std::vector<double> velocity_x, velocity_y;  ///< [nodes and copies], m/s; empty without Model::outline_rates
  std::vector<double> tributary_length;        ///< [nodes and copies], present, m; empty: that of the shapes holds

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("x", x), visitor("y", y);
    visitor("force_x", force_x), visitor("force_y", force_y);
    visitor("x_refresh", x_refresh), visitor("y_refresh", y_refresh);
    visitor("tributary_length", tributary_length);
    visitor("velocity_x", velocity_x), visitor("velocity_y", velocity_y);
  }
};

/// Floor division: the turn that a node index beyond [0, count) lies in.
inline int turn_of(int index, int count) { return index >= 0 ? index / count : -((count - 1 - index) / count); }

}  // namespace pliant
