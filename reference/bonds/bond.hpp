#pragma once

#include <array>

#include "reference/contact/contacts.hpp"
#include "reference/contact/projection.hpp"
#include "reference/jet.hpp"

namespace pliant::reference {

/// Point on the outline of a bond's master, which moves with the two nodes beside it.
struct MasterPoint {
  int segment = 0;  ///< numbered on over all turns of a wall
  double xi = 0;    ///< in [0, 1] along it
};

/// Segment of one outline, the slave, that is joined to another outline (docs/method.md 11).
struct Bond {
  int slave = 0, master = 0;                  ///< numbers of outlines
  int segment = 0;                            ///< of the slave
  std::array<MasterPoint, 2> points;          ///< of the master, nearest to either end when the bond was made
  Image image;                                ///< of the master; 0 for a wall
  int rule = 0;                               ///< index in Scene::bonds
  double length = 0;                          ///< of the segment in its reference shape, m
  std::array<double, 2> rest_gap, rest_slip;  ///< of either end when the bond was made, m
};

/// The two ends of a bond's segment, and the master's points beside them.
using BondPoints = std::array<Vec2, 4>;

BondPoints points_of(const Bond& bond, const PresentOutline& slave, const PresentOutline& master, const Vec2& shift);

/// Number that depends on the eight coordinates of a bond's points.
using BondJet = Jet<8>;

/// Distances of the master's points from the ends of the segment, in the frame of the middle line (65).
struct BondDistances {
  std::array<BondJet, 2> gap, slip;  ///< across and along, m
};

BondDistances distances_of(const BondPoints& points);

}  // namespace pliant::reference
