#pragma once

#include <span>
#include <vector>

#include "reference/contact/projection.hpp"

namespace pliant::reference {

/// Straight piece of the slave's outline in the master's frame, with s in [0, 1] along it.
struct Stretch {
  Vec2 first, second;
  Vec2 at(double s) const { return (1 - s) * first + s * second; }
  Vec2 along() const { return second - first; }
};

/// Nearest part of the master: a segment, or its first node.
struct Nearby {
  int segment = 0;  ///< numbered as in PresentOutline
  bool at_node = false;
  bool operator==(const Nearby&) const = default;
};

/// Whether a point that is nearest to a node is outside. Of the node's two segments the one whose line is further away
/// decides.
bool is_outside(const PresentOutline& master, int node, const Vec2& point);

/// Part of a piece with one nearest part of the master.
struct Part {
  double start = 0, end = 0;  ///< in [0, 1]
  Nearby nearby;
  double middle() const { return (start + end) / 2; }
};

/// Divides a piece into parts, with the segments [first, first + count) of the master (docs/method.md 4, "Contact as an
/// integral"). Cuts are where the nearest of all segments and nodes changes, and where the signed distance to it passes
/// one of the levels, m. There are no parts if the whole piece is outside by more than `reach`.
std::vector<Part> nearest_parts(const PresentOutline& master, int first, int count, const Stretch& stretch,
                                std::span<const double> levels, double reach);

}  // namespace pliant::reference
