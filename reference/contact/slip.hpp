#pragma once

#include <utility>
#include <vector>

#include "reference/contact/projection.hpp"

namespace pliant::reference {

/// How far a node has moved along an outline, m.
struct Motion {
  Jet<6> by_element;  ///< with derivatives by the node and its present segment; first derivatives only are meant
  std::vector<std::pair<int, Vec2>>
      others;  ///< derivatives by nodes that it passed, numbered as the outline does; sums
};

/// From the remembered place to the present one on `segment`.
Motion motion_along(const PresentOutline& master, const ContactMemory& memory, int segment, const Projection& now);

}  // namespace pliant::reference
