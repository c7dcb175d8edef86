#pragma once

#include <array>
#include <numbers>
#include <optional>

#include "reference/contact/projection.hpp"

namespace pliant::reference {

/// Where an outline turns sharply to the left, by its reference shape: nodes at which two faces meet.
class Corners {
 public:
  explicit Corners(const ContactOutline& outline);

  bool any() const { return any_; }
  bool at(int node) const { return corner_[within(node)]; }
  double length(int segment) const { return length_[within(segment)]; }  ///< in the reference shape, m
  double longest() const { return longest_; }                            ///< segment, m

 private:
  std::size_t within(int i) const {
    const int n = static_cast<int>(corner_.size());
    return static_cast<std::size_t>(((i % n) + n) % n);
  }

  std::vector<bool> corner_;
  std::vector<double> length_;
  double longest_ = 0;
  bool any_ = false;
};

/// The least turn of an outline that is a corner, to the left.
constexpr double corner_turn = 35 * std::numbers::pi / 180;

/// Of a segment's length: rounding, where corners lie on each other.
constexpr double tie = 1e-9;

/// A node of the slave between its two neighbours, as the master sees it.
struct SlaveNode {
  Vec2 before, at, after;
  double length_before = 0, length_after = 0;                        ///< of its segments, as they count, m
  bool corner = false, corner_before = false, corner_after = false;  ///< it is one, or its neighbour
};

struct Face {
  const PresentOutline& outline;
  const Corners& corners;
  double sight = 0;  ///< how far along a face its corner counts: the lesser of both outlines' longest segments, m
};

/// Length of contact that a node stands for, by the coordinates of nine nodes: its neighbour before, itself, its
/// neighbour after, the segment's two, the master's next before and after these, and the corners before and after it
/// that are less than two of the slave's segments away.
struct NodeLength {
  static constexpr int nodes = 9;
  Jet<2 * nodes> value;  ///< m
  int corner[2]{
      0, 0};  ///< nodes of the master, counted on as its segments are; any where the length does not depend on it
};

/// Which segment of the master a node touches, and over which length.
struct Footing {
  int segment = 0;
  NodeLength length;
};

/// Of a node that stands beside the given segment (docs/method.md 4): that one, or beyond a near corner one of the next
/// face, where the node would store more; none beyond a corner that ends the face.
std::optional<Footing> footing(const Face& master, int segment, const SlaveNode& node, double outward);

}  // namespace pliant::reference
