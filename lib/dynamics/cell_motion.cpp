#include "dynamics/cell_motion.hpp"

#include <cmath>

#include <fmt/format.h>

#include "bodies/node_arrays.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "core/errors.hpp"
#include "dynamics/cell_stress.hpp"
#include "geometry/lattice.hpp"

namespace pliant {
namespace {

/// Adds the jump of a velocity gradient, 1/s, times the position to the velocities of one batch. Returns the growth of
/// the bodies' kinetic energies, J/m; for a nodewise body the lanes add up to it. With scaled mass, velocities v + u
/// have the reduced momenta y + C^-1 u, and the growth is C^-1 u . D (v + u/2).
Lanes push_batch(const Model& model, const Batch& batch, const Eigen::Matrix2d& jump, State& state) {
  thread_local std::vector<Lanes> scratch[3];  // memory is allocated once
  for (std::vector<Lanes>& one : scratch) one.resize(2 * static_cast<std::size_t>(batch.slots));
  const Lanes* q = &state.position.compliant[batch.offset];
  Lanes* y = &state.reduced_momentum.compliant[batch.offset];
  Lanes* u = scratch[0].data();
  const Lanes centre_x = batch.centre_x * batch.inverse_scale, centre_y = batch.centre_y * batch.inverse_scale;
  return with_nodes(model, batch, [&](const auto& nodes) {
    for (int i = 0; i < batch.slots; ++i) {
      const Lanes at_x = q[2 * i] + centre_x, at_y = q[2 * i + 1] + centre_y;
      // padding would move without end
      const LaneBits there = (batch.weight > 0.0) & (Lanes{} + nodes.mass_at_unit_density[i] > 0.0);
      u[2 * i] = select(there, jump(0, 0) * at_x + jump(0, 1) * at_y, Lanes{});
      u[2 * i + 1] = select(there, jump(1, 0) * at_x + jump(1, 1) * at_y, Lanes{});
    }
    const Lanes *change = u, *v = y;
    if (model.has_reciprocal_mass) {
      apply_relative_mass(model, batch, u, scratch[1].data()), change = scratch[1].data();
      apply_reciprocal_mass(model, batch, y, scratch[2].data()), v = scratch[2].data();
    }
    Lanes gain{};
    for (int i = 0; i < 2 * batch.slots; ++i) {
      gain += nodes.mass_at_unit_density[i / 2] * (change[i] * (v[i] + 0.5 * u[i]));
      y[i] += change[i];
    }
    return gain * batch.density * batch.weight;
  });
}

double push_rigid(const RigidBody& rigid, const Eigen::Matrix2d& jump, const double* position, double* velocity) {
  const Vec2 moved = jump * Vec2(position[0], position[1]);
  const double change[3] = {moved.x(), moved.y(), 0.5 * (jump(1, 0) - jump(0, 1))};
  double gain = 0;
  for (int c = 0; c < 3; ++c) {
    gain += rigid.dof[c].mass * change[c] * (velocity[c] + 0.5 * change[c]);
    velocity[c] += change[c];
  }
  return gain;
}

/// Lets all matter follow a jump of the cell's velocity gradient. Returns the growth of the kinetic energy, J/m.
double push_matter(const Model& model, const Eigen::Matrix2d& jump, State& state) {
  std::vector<Lanes> gains(model.batches.size());
  for_each_batch(model, [&](int b) {
    const Batch& batch = model.batches[b];
    gains[b] = push_batch(model, batch, jump, state);
    if (state.body_balance.work.empty()) return;
    const Lanes of_bodies = sum_over_body(batch, gains[b]);
    const int* bodies = &model.groups[batch.group].bodies[batch.first];
    for (int lane = 0; lane < batch.count; ++lane) state.body_balance.work[bodies[lane]] += of_bodies[lane];
  });
  double gain = 0;
  for (const Lanes& of_batch : gains) gain += sum(of_batch);
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    gain += push_rigid(model.rigid_bodies[r], jump, &state.position.rigid[3 * r], &state.reduced_momentum.rigid[3 * r]);
  return gain;
}

/// Rates of the gradient from the state's time on, 1/s. Components that stress moves keep theirs.
Eigen::Matrix2d gradient_rate(const CellSettings& cell, const State& state) {
  Eigen::Matrix2d rate = matrix_of(state.reduced_momentum.lattice) * matrix_of(state.cell_start).inverse();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (!cell.stress[i][j]) rate(i, j) = cell.gradient[i][j].slope(state.time);
  return rate;
}

/// Mass of the cell for each component of its gradient, kg m: that of matter spread evenly over the periods, whose
/// kinetic energy is mass rate^2/2 if one component alone changes.
Eigen::Matrix2d cell_mass(const Model& model, const State& state) {
  double matter = 0;
  for (const Body& body : model.bodies) matter += body.mass;
  const double x = state.cell_start.a().squaredNorm(), y = state.cell_start.b().squaredNorm(),
               factor = model.scene.cell->mass * matter / 12;
  Eigen::Matrix2d mass;
  mass << x, y, x, y;
  return factor * mass;
}

/// Area of a cell over that at the start of the run from which on its grains no longer bear any stress.
constexpr double burst = 4;

/// Changes the rates of the cell's vectors, m/s.
double set_rates(const Model& model, const Eigen::Matrix2d& rates, State& state) {
  const Eigen::Matrix2d before = matrix_of(state.reduced_momentum.lattice);
  if (rates == before) return 0;
  const Eigen::Matrix2d jump = (rates - before) * matrix_of(state.position.lattice).inverse();
  state.reduced_momentum.lattice = lattice_of(rates);
  return push_matter(model, jump, state);
}

}  // namespace

void start_cell(const Model& model, State& state) {
  if (!model.scene.cell) return;
  state.cell_start = state.position.lattice;
  set_rates(model, gradient_rate(*model.scene.cell, state) * matrix_of(state.cell_start), state);
}

void turn_cell(const Model& model, State& state) {
  if (!model.scene.cell) return;
  state.external_work += set_rates(model, gradient_rate(*model.scene.cell, state) * matrix_of(state.cell_start), state);
}

void push_cell(const Model& model, State& state, double dt) {
  const CellSettings& cell = *model.scene.cell;
  if (!cell.is_stress_controlled()) return;
  const Eigen::Matrix2d start = matrix_of(state.cell_start),
                        gradient = matrix_of(state.position.lattice) * start.inverse(), mass = cell_mass(model, state),
                        present = cell_stress(model, state).total();
  Eigen::Matrix2d wanted = present, rate = gradient_rate(cell, state);
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      if (cell.stress[i][j]) wanted(i, j) = cell.stress[i][j]->at(state.time);
  if (cell.stress[0][1]) wanted(1, 0) = present(1, 0) + wanted(0, 1) - present(0, 1);
  const Eigen::Matrix2d force =
      area_of(state.position.lattice) * (wanted - present) * gradient.inverse().transpose();  // on the gradient, J/m
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      if (!cell.stress[i][j]) continue;
      const double against = rate(i, j) == 0 ? 0 : std::copysign(cell.damping * std::abs(force(i, j)), rate(i, j));
      rate(i, j) += dt * (force(i, j) - against) / mass(i, j);
    }
  state.external_work += set_rates(model, rate * start, state);
}

void check_cell_holds(const State& state) {
  const double growth = area_of(state.position.lattice) / area_of(state.cell_start);
  if (growth > 0 && growth < burst) return;
  throw PhysicsError(fmt::format(
      "the cell gives way: its area is {:.3g} times that at the start at t = {:.6g} s, as its grains do not bear the "
      "stress of [domain.cell]; {}; last good state: step {}",
      growth, state.time, growth > 0 ? "pull less, or let contacts hold" : "press less, or raise its inertia",
      state.steps));
}

double work_on_images(const State& before, const Trial& after) {
  const Lattice moved = after.position.lattice - before.position.lattice,
                force = before.force.lattice + after.force.lattice;
  return -0.5 * (force.ax * moved.ax + force.ay * moved.ay + force.bx * moved.bx + force.by * moved.by);
}

Eigen::Matrix2d velocity_gradient(const State& state) {
  return matrix_of(state.reduced_momentum.lattice) * matrix_of(state.position.lattice).inverse();
}

Eigen::Matrix2d deformation_gradient(const Scene& scene, const State& state) {
  return matrix_of(state.position.lattice) * matrix_of(initial_lattice(scene)).inverse();
}

}  // namespace pliant
