#include "dynamics/cell_stress.hpp"

#include "bodies/node_arrays.hpp"
#include "dynamics/cell_motion.hpp"
#include "geometry/lattice.hpp"

namespace pliant {
namespace {

/// A body's centre of mass: mass, kg/m, place, m, and velocity, m/s.
struct CentreMotion {
  double mass = 0;
  Vec2 place{0, 0}, velocity{0, 0};
};

void find_centres(const Model& model, const Batch& batch, const State& state, std::vector<CentreMotion>& centres) {
  const Lanes *q = &state.position.compliant[batch.offset], *v = &state.reduced_momentum.compliant[batch.offset];
  const int* bodies = &model.groups[batch.group].bodies[batch.first];
  with_nodes(model, batch, [&](const auto& nodes) {
    Lanes mass{}, x{}, y{}, u{}, w{};
    for (int i = 0; i < batch.slots; ++i) {
      const auto m = nodes.mass_at_unit_density[i];
      mass += m;
      x += m * q[2 * i], y += m * q[2 * i + 1], u += m * v[2 * i], w += m * v[2 * i + 1];
    }
    for (Lanes* sums : {&mass, &x, &y, &u, &w}) *sums = sum_over_body(batch, *sums);
    for (int lane = 0; lane < batch.count; ++lane) {
      const double s = batch.scale[lane];
      centres[bodies[lane]] = {
          mass[lane] * batch.density[lane],
          {batch.centre_x[lane] + s * x[lane] / mass[lane], batch.centre_y[lane] + s * y[lane] / mass[lane]},
          {s * u[lane] / mass[lane], s * w[lane] / mass[lane]}};
    }
  });
}

std::vector<CentreMotion> centres_of_bodies(const Model& model, const State& state) {
  std::vector<CentreMotion> centres(model.bodies.size());
  for_each_batch(model, [&](int b) { find_centres(model, model.batches[b], state, centres); });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const double *q = &state.position.rigid[3 * r], *v = &state.reduced_momentum.rigid[3 * r];
    centres[model.rigid_bodies[r].body] = {model.rigid_bodies[r].dof[0].mass, {q[0], q[1]}, {v[0], v[1]}};
  }
  return centres;
}

Vec2 force_on(const Model& model, const OutlineField& contact_force, int body) {
  Lanes x{}, y{};
  for (int i = model.outline_offset[body], end = model.outline_end(body); i < end; i += lane_count) {
    const LaneBits own = first_lanes(end - i);
    x += select(own, load(&contact_force.x[i]), Lanes{}), y += select(own, load(&contact_force.y[i]), Lanes{});
  }
  return {sum(x), sum(y)};
}

}  // namespace

CellStress cell_stress(const Model& model, const State& state) {
  const std::vector<CentreMotion> centres = centres_of_bodies(model, state);
  const Eigen::Matrix2d gradient = velocity_gradient(state);
  const Lattice &periods = state.position.lattice, &forces = state.force.lattice;
  CellStress stress;
  stress.work = -matrix_of(forces) * matrix_of(periods).transpose();
  stress.contact = stress.work;
  for (std::size_t b = 0; b < centres.size(); ++b) {
    const CentreMotion& centre = centres[b];
    const Vec2 relative = centre.velocity - gradient * centre.place;
    stress.contact -= force_on(model, state.contact_force, static_cast<int>(b)) * centre.place.transpose();
    stress.kinetic -= centre.mass * relative * relative.transpose();
  }
  const double area = area_of(periods);
  stress.work /= area, stress.contact /= area, stress.kinetic /= area;
  return stress;
}

}  // namespace pliant
