#pragma once

#include <span>
#include <vector>

#include "reference/contact/projection.hpp"

namespace pliant::reference {

/// A straight piece of the slave's outline where the master sees it; s in [0, 1] along it.
struct Stretch {
  Vec2 first, second;
  Vec2 at(double s) const { return (1 - s) * first + s * second; }
  Vec2 along() const { return second - first; }
};

/// What of the master is nearest: a segment, or its first node.
struct Nearby {
  int segment = 0;  ///< counted on as the outline does
  bool at_node = false;
  bool operator==(const Nearby&) const = default;
};

/// Whether a point that is nearest to a node is outside: as it is of that one of the node's segments whose line is
/// further.
bool is_outside(const PresentOutline& master, int node, const Vec2& point);

/// A part of a stretch beside one place of the master.
struct Part {
  double start = 0, end = 0;  ///< in [0, 1]
  Nearby nearby;
  double middle() const { return (start + end) / 2; }
};

/// The whole stretch in parts, by the segments [first, first + count) of the master (docs/method.md 4, "Contact as an
/// integral"): cut where the nearest of all segments and nodes changes, and where the signed distance to it passes one
/// of the levels, m. None where all of it is outside by more than
/// `reach`.
std::vector<Part> nearest_parts(const PresentOutline& master, int first, int count, const Stretch& stretch,
                                std::span<const double> levels, double reach);

}  // namespace pliant::reference
