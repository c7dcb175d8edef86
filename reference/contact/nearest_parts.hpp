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

/// What of the master is nearest: a segment, or one of its end nodes. A node's points belong to the segment on their
/// side of the bisector.
struct Nearby {
  int segment = 0;  ///< counted on as the outline does
  int end = 0;      ///< -1: its first node, 0: the segment itself, 1: its second node
  bool operator==(const Nearby&) const = default;
  int node() const { return segment + (end > 0); }  ///< that is nearest where `end` is not 0
  bool shares_node(const Nearby& other) const { return end != 0 && other.end != 0 && node() == other.node(); }
};

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
