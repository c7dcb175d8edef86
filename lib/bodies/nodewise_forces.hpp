#pragma once

#include "bodies/point_law.hpp"

namespace pliant {

/// Internal forces of nodewise bodies in two passes, so that no two threads write to one node (docs/design.md 4):
/// stresses at all points, then each node gathers from its points. Forces: [slots x 2] of the batch.

/// Weighted first Piola stress by columns, w P, which multiply a gradient's x and y components.
struct StressColumns {
  double xx, yx, xy, yy;
};

/// Computes the stresses of one chunk of points into `stresses`, [points] of the body. The totals' lanes are eight
/// points each.
PointTotals nodewise_stresses(const Model& model, const Chunk& points, const BatchMotion& motion,
                              StressColumns* stresses);

/// Adds - sum_g w_g P_g b_gi at the nodes of one region.
void add_nodewise_forces(const Model& model, const Region& region, const StressColumns* stresses, Lanes* forces);

/// Adds the internal forces of a whole nodewise body: see add_internal_forces.
PointTotals add_nodewise_forces(const Model& model, const Batch& batch, const BatchMotion& motion, Lanes* forces);

/// Strain energy of the body in lane 0, J/m; 0 in the others.
Lanes nodewise_strain_energy(const Model& model, const Batch& batch, const BatchMotion& motion);

}  // namespace pliant
