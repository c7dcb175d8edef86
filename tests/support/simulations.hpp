#pragma once

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/simulation.hpp"
#include "support/scenes.hpp"

/// Scenes in motion, and what tests read from a simulation.
namespace pliant::dynamics_tests {

using namespace testing;

inline Eigen::Matrix2d matrix(double xx, double xy, double yx, double yy) {
  return (Eigen::Matrix2d() << xx, xy, yx, yy).finished();
}

inline void advance(Simulation& simulation, double until) {
  while (simulation.state().time < until) simulation.step(until);
}

/// Hash of the state at a time, of a run on this many threads. It covers all bits.
inline std::uint64_t hash_after(const Model& model, int threads, double time) {
  const int before = omp_get_max_threads();
  omp_set_num_threads(threads);
  Simulation simulation(model);
  advance(simulation, time);
  simulation.energy_balance();
  const std::uint64_t hash = state_hash(simulation.state());
  omp_set_num_threads(before);
  return hash;
}

/// Position, or velocity, of a rigid body: x, y, angle.
inline Eigen::Vector3d rigid(const Dofs& dofs, int index) {
  return {dofs.rigid[3 * static_cast<std::size_t>(index)], dofs.rigid[3 * static_cast<std::size_t>(index) + 1],
          dofs.rigid[3 * static_cast<std::size_t>(index) + 2]};
}

/// Over all degrees of freedom.
inline double largest_difference(const Dofs& a, const Dofs& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.rigid.size(); ++i) largest = std::max(largest, std::abs(a.rigid[i] - b.rigid[i]));
  for (std::size_t i = 0; i < a.compliant.size(); ++i)
    for (int lane = 0; lane < lane_count; ++lane)
      largest = std::max(largest, std::abs(a.compliant[i][lane] - b.compliant[i][lane]));
  return largest;
}

/// A node's degrees of freedom in a compliant body; positions are relative to the body's centre.
inline Vec2 node_value(const Model& model, const Body& body, const Dofs& dofs, int node) {
  const std::size_t at = model.batches[body.batch].offset + 2 * static_cast<std::size_t>(node);
  return {dofs.compliant[at][body.lane], dofs.compliant[at + 1][body.lane]};
}

/// Lumped masses of a compliant body, kg/m a node.
inline std::vector<double> node_masses(const Model& model, const Body& body) {
  std::vector<double> masses = model.shape_of(model.batches[body.batch]).space.mass_at_unit_density;
  for (double& m : masses) m *= model.scene.materials[body.material].density;
  return masses;
}

/// Mean over a compliant body's nodes, weighted by mass: of positions the centre (relative to body.centre), of
/// velocities its velocity.
inline Vec2 mass_mean(const Model& model, const Body& body, const Dofs& dofs) {
  const std::vector<double> masses = node_masses(model, body);
  Vec2 total(0, 0);
  double mass = 0;
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
    total += masses[i] * node_value(model, body, dofs, i);
    mass += masses[i];
  }
  return total / mass;
}

/// Contact force on a body.
inline Vec2 contact_force(const Simulation& simulation, int body) {
  const Model& model = simulation.model();
  Vec2 total(0, 0);
  for (int i = model.outline_offset[body]; i < model.outline_end(body); ++i)
    total += simulation.state().contact_force.at(i);
  return total;
}

/// Order of convergence seen from the errors at steps h and h/ratio.
inline double observed_order(double coarse, double fine, double ratio = 2) {
  return std::log(std::abs(coarse) / std::abs(fine)) / std::log(ratio);
}

}  // namespace pliant::dynamics_tests
