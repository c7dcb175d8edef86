#pragma once

#include "bodies/model.hpp"

namespace pliant {

/// Internal forces of spread bodies in two passes, so that no two threads write to one node (DESIGN 4): stresses at all points, then each node
/// gathers from its points. Positions and forces: [slots x 2] of the batch.

/// A weighted first Piola stress by columns, w P: what a gradient's x and y components go with.
struct StressColumns {
  double xx, yx, xy, yy;
};

/// Stresses of one chunk of points into stresses, [points] of the body. Returns the least Jacobian met.
double spread_stresses(const Model& model, const Chunk& points, const Lanes* positions, StressColumns* stresses);

/// Adds the Kelvin-Voigt stresses of one chunk of points. Returns the power that they dissipate, W/m.
double add_viscous_stresses(const Model& model, const Chunk& points, const Lanes* positions, const Lanes* velocities,
                            StressColumns* stresses);

/// Adds - sum_g w_g P_g b_gi at the nodes of one region.
void add_spread_forces(const Model& model, const Region& region, const StressColumns* stresses, Lanes* forces);

/// Adds the internal forces of a whole spread body. Returns the least Jacobian in all lanes.
Lanes add_spread_forces(const Model& model, const Batch& batch, const Lanes* positions, Lanes* forces);

/// Adds the Kelvin-Voigt forces of a whole spread body. Returns the power in lane 0, of s = 1.
Lanes add_spread_viscous_forces(const Model& model, const Batch& batch, const Lanes* positions, const Lanes* velocities,
                                Lanes* forces);

/// Strain energy of the body in lane 0, J/m; 0 in the others.
Lanes spread_strain_energy(const Model& model, const Batch& batch, const Lanes* positions);

}  // namespace pliant
