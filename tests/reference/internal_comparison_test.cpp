// As verify/frozen_states: internal and viscous forces, energies and stresses of the reference solver against the
// engine's, on random deformed states. INDEPENDENT: they share the mesh and the scene.
#include <gtest/gtest.h>

#include "bodies/body_view.hpp"
#include "bodies/initial_state.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/nodal.hpp"
#include "reference/materials/internal.hpp"
#include "reference/shapes.hpp"
#include "results/point_states.hpp"
#include "setup/build_model.hpp"
#include "support/figures.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

constexpr double force_tolerance = 1e-11;  ///< of the largest force, energy or stress

/// Grains of three shapes, of different sizes, angles and stiffnesses, each in a state of its own. Grains of small
/// strains start unturned: the scene allows no other.
Scene some_grains(MaterialLaw law, const DiscretisationSettings& settings, int count = 20) {
  Scene scene = bare_scene();
  scene.discretisation = settings;
  scene.contacts = {frictionless(1)};
  scene.materials[0].law = law;
  scene.materials[0].viscosity = 0.2;
  scene.materials.push_back({"stiff", law, 3, 5, 0.3});
  if (law == MaterialLaw::neo_hookean_maxwell)
    for (Material& material : scene.materials) material.branch_modulus = 2, material.relaxation_time = 0.7;
  scene.shapes = {disc(60, 1), curve("rounded", rounded_polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 0.2), 168),
                  curve("fourier", fourier_grain(1, {0.15, 0.1, 0.05}, 3), 120)};
  for (int i = 0; i < count; ++i) {
    add_grain(scene, scene.shapes[static_cast<std::size_t>(i % 3)].name, BodyKind::compliant, {2.0 * i, 0.3 * i},
              law == MaterialLaw::linear_elastic ? 0 : 0.4 * i, i % 4 == 1 ? "stiff" : "soft");
    scene.grains.back().size.factors = {0.7 + 0.05 * i};
  }
  return scene;
}

/// Smooth large strains and a little noise, in units of the body's size.
void deform_body(const Model& model, const Body& body, Random& random, Dofs& q) {
  const BodyOffsets offsets(model, body);
  const BodyView view(model, body, q);
  const double a = random.uniform(-0.15, 0.15), b = random.uniform(-0.15, 0.15), c = random.uniform(-0.15, 0.15);
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.shape_of(body).nodes()); ++i) {
    const Vec2 x = view[i], noise{random.uniform(-1, 1), random.uniform(-1, 1)};
    set_node(offsets, i, x + Vec2(a * x.x() + b * x.y() * x.y(), c * x.x() - a * x.x() * x.y()) + 0.003 * noise, q);
  }
}

Eigen::VectorXd of_body(const Model& model, const Body& body, const Dofs& dofs) {
  const Points points = dof_values(model, body, dofs);
  Eigen::VectorXd result(2 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) result.segment<2>(2 * static_cast<Eigen::Index>(i)) = points[i];
  return result;
}

struct Both {
  Model model;
  Dofs q, rate;

  explicit Both(const Scene& scene, const BuildOptions& options = {})
      : model(build_model(scene, options)), q(initial_positions(model)), rate(zero_dofs(model)) {
    Random random(5);
    for (const Body& body : model.bodies) deform_body(model, body, random, q);
    Dofs moved = q;
    for (const Body& body : model.bodies) deform_body(model, body, random, moved);
    for (std::size_t i = 0; i < q.compliant.size(); ++i) rate.compliant[i] = moved.compliant[i] - q.compliant[i];
  }
  reference::InternalForces reference_of(const Body& body) const {
    const Scene& scene = model.scene;
    const auto shape = static_cast<std::size_t>(body.shape);
    const reference::Space space = reference::make_space(make_field_mesh(scene.shapes[shape]), scene.discretisation);
    return {space, scene.materials[static_cast<std::size_t>(body.material)], body.scale, body.angle};
  }
};

/// Returns the largest relative difference of internal forces.
double compare_forces(const Both& both) {
  Dofs f = zero_dofs(both.model), viscous = f;
  std::vector<Lanes> energy;
  for (const Batch& batch : both.model.batches) {
    const std::size_t at = batch.offset;
    BatchMotion motion{.position = &both.q.compliant[at]};
    add_internal_forces(both.model, batch, motion, &f.compliant[at]);
    energy.push_back(strain_energy(both.model, batch, motion));
    motion.velocity = &both.rate.compliant[at], motion.elastic = false;
    add_internal_forces(both.model, batch, motion, &viscous.compliant[at]);
  }
  double worst = 0;
  for (const Body& body : both.model.bodies) {
    const reference::InternalForces own = both.reference_of(body);
    const Eigen::VectorXd q = of_body(both.model, body, both.q), v = of_body(both.model, body, both.rate);
    const reference::InternalState state = own.evaluate(q, false);
    const Eigen::VectorXd engine = of_body(both.model, body, f);
    const double scale = engine.cwiseAbs().maxCoeff(), error = (state.residual + engine).cwiseAbs().maxCoeff() / scale;
    EXPECT_GT(scale, 1e-3);
    EXPECT_LT(error, force_tolerance) << body.name;
    EXPECT_NEAR(state.energy, energy[static_cast<std::size_t>(body.batch)][body.lane], force_tolerance * state.energy);
    worst = std::max(worst, error);
    const Eigen::VectorXd damping = of_body(both.model, body, viscous);
    EXPECT_LE((own.damping(q, v, false).residual + damping).cwiseAbs().maxCoeff(),
              force_tolerance * damping.cwiseAbs().maxCoeff())
        << body.name;
  }
  return worst;
}

/// Returns the largest relative difference, of points in their order. In the plane the stress of small strains is P
/// itself; the engine turns it to P F^T/J, the share of a strain away.
double compare_stresses(const std::vector<reference::PointStress>& own, const std::vector<PointState>& engine,
                        bool small) {
  EXPECT_EQ(own.size(), engine.size());
  if (own.size() != engine.size()) return INFINITY;
  double scale = 0, error = 0;
  for (std::size_t g = 0; g < own.size(); ++g) {
    const reference::PointStress& a = own[g];
    const PointState& b = engine[g];
    scale = std::max({scale, std::abs(b.stress.xx), std::abs(b.stress.yy)});
    error = std::max({error, std::abs(a.zz - b.stress.zz), std::abs(a.energy - b.energy)});
    EXPECT_NEAR(a.jacobian, b.jacobian, force_tolerance);
    if (small) continue;
    error = std::max({error, std::abs(a.xx - b.stress.xx), std::abs(a.yy - b.stress.yy), std::abs(a.xy - b.stress.xy)});
  }
  EXPECT_LT(error, force_tolerance * scale);
  return error / scale;
}

double compare_stresses(const Both& both, const Body& body) {
  const MaterialLaw law = both.model.scene.materials[static_cast<std::size_t>(body.material)].law;
  return compare_stresses(both.reference_of(body).stresses(of_body(both.model, body, both.q)),
                          point_states(both.model, body, both.q, initial_memory(both.model)),
                          law == MaterialLaw::linear_elastic);
}

const MaterialLaw engine_laws[] = {
    MaterialLaw::neo_hookean,    MaterialLaw::neo_hookean_quadratic, MaterialLaw::melody,
    MaterialLaw::linear_elastic, MaterialLaw::neo_hookean_maxwell,   MaterialLaw::von_mises};

TEST(ReferenceAgainstEngine, internal_and_viscous_forces_agree) {
  LargestFigures figures;
  for (const DiscretisationSettings& settings : reference_methods())
    for (const MaterialLaw law : engine_laws) {
      SCOPED_TRACE(name_of(settings) + ", law " + std::to_string(static_cast<int>(law)));
      figures.note("internal forces: " + name_of(settings), compare_forces(Both(some_grains(law, settings))));
    }
}

TEST(ReferenceAgainstEngine, nodewise_bodies_agree) {
  const Both both(some_grains(MaterialLaw::neo_hookean, settings_of(DiscretisationMethod::mls), 3),
                  BuildOptions{0, false, {}});
  ASSERT_TRUE(std::any_of(both.model.batches.begin(), both.model.batches.end(),
                          [](const Batch& batch) { return batch.layout == Layout::nodewise; }));
  compare_forces(both);
}

/// Bodies with a Maxwell branch, which have come from their start to q and remember it.
struct Remembering : Both {
  Memory memory = initial_memory(model);

  explicit Remembering(const BuildOptions& options = {})
      : Both(some_grains(MaterialLaw::neo_hookean_maxwell, settings_of(DiscretisationMethod::mls), 6), options) {
    forces(q, 0.5, memory);
  }
  struct Found {
    Dofs force;
    std::vector<PointTotals> totals;
    std::vector<Lanes> energy;
  };
  /// Of the engine at positions so long after `from`, which goes on to them.
  Found forces(const Dofs& at, double elapsed, Memory& from) const {
    Found found{zero_dofs(model), {}, {}};
    Memory next = from;
    for (const Batch& batch : model.batches) {
      BatchMotion motion = motion_of(batch, at, from);
      motion.elapsed = elapsed, motion.new_memory = next.material.data() + batch.memory;
      found.totals.push_back(add_internal_forces(model, batch, motion, &found.force.compliant[batch.offset]));
      motion.memory = motion.new_memory;
      found.energy.push_back(strain_energy(model, batch, motion));
    }
    from = std::move(next);
    return found;
  }
  /// A body of the reference that remembers the same.
  reference::InternalForces remembering(const Body& body) const {
    reference::InternalForces own = reference_of(body);
    const Batch& batch = model.batches[body.batch];
    std::vector<reference::PointHistory> points(static_cast<std::size_t>(own.weights().size()));
    for (std::size_t g = 0; g < points.size(); ++g) {
      const bool nodewise = batch.layout == Layout::nodewise;
      const auto number = nodewise ? static_cast<std::size_t>(model.nodewise_shape_of(batch).point_number[g]) : g;
      const auto value = [&](std::size_t k) {
        const Lanes& lanes = memory.material[batch.memory + k * static_cast<std::size_t>(batch.points) +
                                             (nodewise ? number / lane_count : number)];
        return lanes[nodewise ? static_cast<int>(number % lane_count) : body.lane];
      };
      points[g] = {{value(0) + value(3), value(1) + value(4), value(2) + value(5)}, {value(3), value(4), value(5)}};
    }
    own.accept(points);
    return own;
  }
};

/// Largest difference of forces, over the largest force, after `dt` on the way on; energies and powers besides.
double difference_after(const Remembering& both, double dt) {
  Dofs at = both.q;
  for (std::size_t i = 0; i < at.compliant.size(); ++i) at.compliant[i] += dt * both.rate.compliant[i];
  Memory memory = both.memory;
  const Remembering::Found found = both.forces(at, dt, memory);
  double worst = 0;
  for (const Body& body : both.model.bodies) {
    const reference::InternalState own = both.remembering(body).evaluate(of_body(both.model, body, at), false, dt);
    const Eigen::VectorXd engine = of_body(both.model, body, found.force);
    worst = std::max(worst, (own.residual + engine).cwiseAbs().maxCoeff() / engine.cwiseAbs().maxCoeff());
    const Batch& batch = both.model.batches[body.batch];
    const PointTotals& totals = found.totals[static_cast<std::size_t>(body.batch)];
    const int lane = batch.layout == Layout::nodewise ? 0 : body.lane;
    const double power = totals.power[lane] * body.scale * body.scale;
    const double energy = found.energy[static_cast<std::size_t>(body.batch)][lane];
    worst = std::max({worst, std::abs(own.power / power - 1), std::abs(own.energy / energy - 1)});
  }
  return worst;
}

/// INDEPENDENT at a state; RATE in time: the engine's exponential and the reference's trapezoidal rule differ by the
/// third order of a step.
TEST(ReferenceAgainstEngine, maxwell_branches_agree) {
  for (const bool nodewise : {false, true}) {
    const Remembering both(nodewise ? BuildOptions{0, false, {}} : BuildOptions{1 << 30, false, {}});
    EXPECT_EQ(both.model.batches[0].layout == Layout::nodewise, nodewise);
    EXPECT_LT(difference_after(both, 0), force_tolerance);
    const double coarse = difference_after(both, 0.04), fine = difference_after(both, 0.02);
    EXPECT_NEAR(coarse / fine, 8, 1.2) << coarse << " " << fine;
    EXPECT_LT(fine, 1e-4);
  }
}

/// EXACT: the tangent is the derivative of the residual (central differences: 1e-10 by rounding, as much by the third
/// derivative).
TEST(ReferenceAgainstEngine, maxwell_tangent_is_the_derivative) {
  const Remembering both;
  const Body& body = both.model.bodies[0];
  const reference::InternalForces own = both.remembering(body);
  const Eigen::VectorXd q = of_body(both.model, body, both.q);
  for (const double elapsed : {0.0, 0.3}) {
    const Eigen::MatrixXd tangent(own.evaluate(q, true, elapsed).tangent);
    for (Eigen::Index i = 0; i < q.size(); i += 11) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(q.size());
      step[i] = 1e-5;
      const Eigen::VectorXd slope =
          (own.evaluate(q + step, false, elapsed).residual - own.evaluate(q - step, false, elapsed).residual) / 2e-5;
      EXPECT_LT((slope - tangent.col(i)).cwiseAbs().maxCoeff(), 1e-8 * tangent.cwiseAbs().maxCoeff());
    }
  }
}

/// Points in the order of the background triangles on both sides.
TEST(ReferenceAgainstEngine, stresses_agree) {
  LargestFigures figures;
  for (const MaterialLaw law : engine_laws) {
    const Both both(some_grains(law, settings_of(DiscretisationMethod::mls)));
    for (std::size_t b = 0; b < both.model.bodies.size(); b += 7)
      figures.note("stresses: mls, support 8", compare_stresses(both, both.model.bodies[b]));
  }
}

/// Yielding grains, with saturation and a rate or with internal friction.
Scene plastic_grains(MaterialLaw law) {
  Scene scene = some_grains(law, settings_of(DiscretisationMethod::mls), 6);
  for (Material& material : scene.materials) {
    material.cohesion = 0.01 * material.young, material.friction_angle = 0.5, material.dilatancy_angle = 0.2;
    material.yield = 0.02 * material.young, material.hardening = 0.05 * material.young;
    material.saturation = 0.03 * material.young, material.saturation_rate = 8;
    material.viscoplastic_time = 0.1;
  }
  return scene;
}

// INDEPENDENT: forces, stresses, elastic energies, plastic losses and plastic strains of four increments, each program
// with its own history: one from an energy in principal strains, the other by formulas without them. Losses are
// integrals of the yield stress there, and by the trapezoidal rule here: they differ by x^2/12 of its curvature,
// 64 x 0.01 / 0.02 of it.
void compare_plastic_increments(MaterialLaw law) {
  for (const bool nodewise : {false, true}) {
    const Both both(plastic_grains(law), nodewise ? BuildOptions{0, false, {}} : BuildOptions{1 << 30, false, {}});
    Random random(9);
    Dofs q = initial_positions(both.model);
    Memory memory = initial_memory(both.model);
    std::vector<reference::InternalForces> own;
    for (const Body& body : both.model.bodies) own.push_back(both.reference_of(body));
    double flowed = 0;
    for (int increment = 0; increment < 4; ++increment) {
      for (const Body& body : both.model.bodies) deform_body(both.model, body, random, q);
      Dofs force = zero_dofs(both.model);
      Memory next = memory;
      std::vector<PointTotals> totals;
      for (const Batch& batch : both.model.batches) {
        BatchMotion motion = motion_of(batch, q, memory);
        motion.elapsed = 0.5, motion.new_memory = next.material.data() + batch.memory;
        totals.push_back(add_internal_forces(both.model, batch, motion, &force.compliant[batch.offset]));
      }
      memory = std::move(next);
      for (std::size_t b = 0; b < own.size(); ++b) {
        const Body& body = both.model.bodies[b];
        const reference::InternalState state = own[b].evaluate(of_body(both.model, body, q), false, 0.5);
        own[b].accept(state.history);
        const Eigen::VectorXd engine = of_body(both.model, body, force);
        EXPECT_LT((state.residual + engine).cwiseAbs().maxCoeff(), force_tolerance * engine.cwiseAbs().maxCoeff());
        const PointTotals& total = totals[static_cast<std::size_t>(body.batch)];
        const double loss = total.loss[nodewise ? 0 : body.lane] * body.scale * body.scale;
        double energy = 0, largest = 0;
        const std::vector<PointState> states = point_states(both.model, body, q, memory);
        for (std::size_t g = 0; g < states.size(); ++g) {
          energy += states[g].weight * states[g].energy;
          EXPECT_NEAR(states[g].plastic_strain, state.history[g].plastic_strain, force_tolerance);
          largest = std::max(largest, states[g].plastic_strain);
        }
        // With the plastic metrics of the end, in and out of the plane.
        compare_stresses(own[b].stresses(of_body(both.model, body, q)), states, false);
        EXPECT_NEAR(state.energy, energy, force_tolerance * energy);
        if (law == MaterialLaw::von_mises)
          EXPECT_NEAR(state.loss, loss, 3 * std::pow(largest, 2) * loss + force_tolerance * energy);
        flowed = std::max(flowed, largest);
      }
    }
    EXPECT_GT(flowed, 0.05);
  }
}
TEST(ReferenceAgainstEngine, plastic_increments_agree) {
  compare_plastic_increments(MaterialLaw::von_mises);
  compare_plastic_increments(MaterialLaw::drucker_prager);  // losses: PlasticPaths
}

// EXACT: the tangent of a plastic body is the difference quotient of its forces. Central differences by h = 1e-6 are
// off by h^2/6 of third derivatives, 1e-9 with strains of 0.02, and by rounding over h, 1e-8. No point begins to flow
// within h.
TEST(ReferenceAgainstEngine, plastic_tangent_is_the_derivative) {
  const Both both(plastic_grains(MaterialLaw::von_mises));
  const Body& body = both.model.bodies[0];
  reference::InternalForces own = both.reference_of(body);
  const Eigen::VectorXd q = of_body(both.model, body, both.q);
  own.accept(own.evaluate(q, false, 0.5).history);
  const Eigen::VectorXd further = q + 0.05 * of_body(both.model, body, both.rate);
  const reference::InternalState state = own.evaluate(further, true, 0.5);
  EXPECT_GT(state.loss, 0);
  Random random(10);
  for (int sample = 0; sample < 5; ++sample) {
    Eigen::VectorXd step(q.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) step[i] = random.uniform(-1, 1);
    const double h = 1e-6;
    const Eigen::VectorXd change = (own.evaluate(further + h * step, false, 0.5).residual -
                                    own.evaluate(further - h * step, false, 0.5).residual) /
                                   (2 * h);
    const Eigen::VectorXd predicted = state.tangent * step;
    EXPECT_LT((change - predicted).cwiseAbs().maxCoeff(), 1e-6 * predicted.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace pliant
