#pragma once

#include <utility>
#include <vector>

#include "reference/contact/projection.hpp"

namespace pliant::reference {

/// Displacement of a node along an outline, m.
struct MotionAlong {
  Jet<6> by_element;  ///< with derivatives by the node and its present segment; only first derivatives are valid
  std::vector<std::pair<int, Vec2>>
      others;  ///< derivatives by nodes that it passed, numbered as in the outline; entries add up
};

/// Slip increment from the stored surface coordinate, on the outline as it was at the last accepted state, to the
/// present one on `segment`.
MotionAlong motion_along(const PresentOutline& master, const PresentOutline& past, const ContactMemory& memory,
                         int segment, const Projection& now);

}  // namespace pliant::reference
