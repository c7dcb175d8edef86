#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "bonds/bond.hpp"

namespace pliant {

/// Bonds that a rule makes at these outlines, in a fixed order, without strength factors: for each segment of a slave
/// both ends of which are within the rule's gap of the master's outline. The slave of a pair is the body with the
/// finer outline, and a grain before a wall.
std::vector<Bond> find_bonds(const Model& model, const OutlineField& position, int rule);

/// Ends of a bond's segment and their master points, and the frame of the middle line between both.
struct BondGeometry {
  Vec2 apart[2];         ///< from each end to its master, m
  Vec2 normal, tangent;  ///< of the slave, outward, and along its outline
  double length = 0;     ///< of the middle line, m
};
BondGeometry geometry_of(const Model& model, const OutlineField& position, const Bond& bond);

}  // namespace pliant
