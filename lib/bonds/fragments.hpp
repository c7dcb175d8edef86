#pragma once

#include <vector>

#include "bodies/model.hpp"
#include "bonds/bond_system.hpp"

namespace pliant {

/// Grains, or cells of grains, that bonds hold together: a connected part of the graph of bonds that are not torn. A
/// single grain is a fragment too.
struct Fragment {
  std::vector<int> bodies;     ///< ascending; the first is the fragment's number, which it keeps as long as it is whole
  std::vector<Images> images;  ///< [bodies] as seen from the first
  double mass = 0, area = 0;   ///< kg/m, m2
  double diameter() const;     ///< of the circle of its area, m
};

/// All fragments, by their numbers. Walls belong to none.
std::vector<Fragment> find_fragments(const Model& model, const BondSystem& bonds, const BondHistory& history);

/// [bodies] number of the fragment; -1 for walls.
std::vector<int> fragment_numbers(const Model& model, const std::vector<Fragment>& fragments);

/// Ratio of the principal radii of gyration of a fragment's area, at least 1.
double aspect_ratio(const Model& model, const OutlineField& position, const Fragment& fragment);

/// Diameter below which the share `passing` of the mass lies, m.
double grading_diameter(const std::vector<Fragment>& fragments, double passing);

/// [outline nodes and copies] mean damage of the ends of bonds at each node, or nearest to it; NaN at nodes without.
std::vector<double> damage_at_nodes(const Model& model, const BondSystem& bonds, const BondHistory& history);

/// Numbers of bonds by their state. A bond softens until both of its ends are torn.
struct BondCounts {
  int whole = 0, softening = 0, torn = 0;
};
BondCounts count_bonds(const BondSystem& bonds, const BondHistory& history);

}  // namespace pliant
