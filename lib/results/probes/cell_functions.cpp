#include <limits>

#include "dynamics/cell_motion.hpp"
#include "dynamics/cell_stress.hpp"
#include "geometry/lattice.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

constexpr double no_cell = std::numeric_limits<double>::quiet_NaN();  ///< of a scene without a cell

Samples stress_of_cell(const Snapshot& snapshot, const Selection&) {
  Samples samples(9);
  if (!snapshot.model().scene.cell)
    return samples.add(1, {no_cell, no_cell, no_cell, no_cell, no_cell, no_cell, no_cell, no_cell, no_cell}), samples;
  const CellStress stress = cell_stress(snapshot.model(), snapshot.state());
  const Eigen::Matrix2d s = stress.total(), &k = stress.kinetic;
  samples.add(1, {s(0, 0), s(0, 1), s(1, 0), s(1, 1), k(0, 0), k(0, 1), k(1, 0), k(1, 1), -0.5 * s.trace()});
  return samples;
}

Samples gradient_of_cell(const Snapshot& snapshot, const Selection&) {
  Samples samples(5);
  if (!snapshot.model().scene.cell) return samples.add(1, {no_cell, no_cell, no_cell, no_cell, no_cell}), samples;
  const Eigen::Matrix2d f = deformation_gradient(snapshot.model().scene, snapshot.state());
  samples.add(1, {f(0, 0), f(0, 1), f(1, 0), f(1, 1), area_of(snapshot.state().position.lattice)});
  return samples;
}

}  // namespace

std::vector<ProbeFunction> cell_functions() {
  return {{"cell_stress", stress_of_cell}, {"cell_gradient", gradient_of_cell}};
}

}  // namespace pliant
