#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/lanes.hpp"
#include "geometry/cell.hpp"

namespace pliant {

/// Segment of one outline whose two ends are bonded to points of another outline (docs/method.md 11). Common edges of
/// two cells have common nodes: there the points are nodes.
struct Bond {
  std::int32_t slave = 0, master = 0;             ///< bodies
  std::int32_t segment = 0;                       ///< of the slave
  std::array<std::int32_t, 2> master_segment{};   ///< of the master, with the point of either end
  std::array<double, 2> xi{};                     ///< where on it, [0, 1)
  Images images;                                  ///< of the master as seen from the slave
  std::int32_t rule = 0;                          ///< index in Scene::bonds
  double length = 0;                              ///< of the slave's segment in the reference configuration, m
  std::array<double, 2> rest_gap{}, rest_slip{};  ///< of either end where the bond was made, m
  double strength_factor = 1;                     ///< from Weibull's distribution

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("slave", slave), visitor("master", master), visitor("segment", segment);
    visitor("master_segment", master_segment), visitor("xi", xi), visitor("images", images), visitor("rule", rule);
    visitor("length", length), visitor("rest_gap", rest_gap), visitor("rest_slip", rest_slip);
    visitor("strength_factor", strength_factor);
  }
};

/// History variables of one end of eight bonds, at the last accepted step.
struct BondEnd {
  Lanes damage{};           ///< 0: whole, 1: torn
  Lanes opening{}, slip{};  ///< elastic displacements, m
};

/// Of all bonds, [eights][ends]. Committed on accepted steps only.
struct BondHistory {
  std::vector<std::array<BondEnd, 2>> ends;
  double damage(std::size_t bond, int end) const { return ends[bond / lane_count][end].damage[bond % lane_count]; }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("ends", ends);
  }
};

}  // namespace pliant
