// Probes of motion and of forces by their origin, against closed forms and each other.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/errors.hpp"
#include "geometry/mesh.hpp"
#include "setup/build_model.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double motion_rounding = 1e-12;

/// A rigid disc that flies and spins under gravity, and a compliant one that rests out of reach without it.
Scene thrown_disc(double end) {
  Scene scene = empty_scene(end);
  scene.gravity = {0, -2};
  scene.shapes = {polygonal_disc("disc", 2, 12)};
  scene.grains = {grains("stone", "disc", BodyKind::rigid, {{1, 3}}, moving({0.5, 1}, 0.3))};
  scene.grains[0].angle = 0.2;
  return scene;
}

TEST(MotionProbes, rigid_flight) {
  const Model model = build_model(thrown_disc(1));
  Simulation simulation(model);
  advance(simulation, 1);
  const Vec2 centre(1.5, 3), velocity(0.5, -1);  // 3 + 1 - 2/2
  const double angle = 0.5, spin = 0.3;
  const std::vector<double> x = measured(simulation, probe_of("position", "stone"));
  EXPECT_NEAR((Vec2(x[0], x[1]) - centre).norm(), 0, motion_rounding) << "EXACT: verlet is exact under constant force";
  EXPECT_NEAR(x[2], angle, motion_rounding) << "EXACT";
  EXPECT_NEAR((measured_vector(simulation, probe_of("displacement", "stone")) - Vec2(0.5, 0)).norm(), 0,
              motion_rounding);
  const Vec2 rotation = measured_vector(simulation, probe_of("rotation", "stone"));
  EXPECT_NEAR(rotation.x(), 0.3, motion_rounding) << "EXACT: from the start";
  EXPECT_NEAR(rotation.y(), spin, motion_rounding) << "EXACT";
  const Vec2 a = measured_vector(simulation, probe_of("acceleration", "stone"));
  EXPECT_NEAR((a - Vec2(0, -2)).norm(), 0, motion_rounding) << "EXACT";
  // EXACT at a node: r turned by the angle; v + w x r; a - w^2 r; displacement less r at the start.
  const Vec2 reference = model.outlines[model.bodies[0].outline].points[5];
  const Vec2 r = Eigen::Rotation2Dd(angle) * reference, start = Eigen::Rotation2Dd(0.2) * reference;
  const auto at_five = [&](const char* quantity) {
    return measured_vector(simulation, at_node(5, probe_of(quantity, "stone")));
  };
  EXPECT_NEAR((at_five("position") - centre - r).norm(), 0, motion_rounding);
  EXPECT_NEAR((at_five("velocity") - velocity - spin * Vec2(-r.y(), r.x())).norm(), 0, motion_rounding);
  EXPECT_NEAR((at_five("acceleration") - a + spin * spin * r).norm(), 0, motion_rounding);
  EXPECT_NEAR((at_five("displacement") - Vec2(0.5, 0) - r + start).norm(), 0, motion_rounding);
}

TEST(MotionProbes, compliant_flight) {
  Scene scene = free_disc(60, 0.5, moving({0.1, 0}, 1e-3));
  scene.gravity = {0, -0.2};
  scene.grains[0].angle = 0.4;
  const Model model = build_model(scene);
  Simulation simulation(model);
  EXPECT_NEAR(measured(simulation, probe_of("rotation", "disc"))[1], 1e-3, 1e-15) << "EXACT: as given";
  advance(simulation, 0.5);
  EXPECT_NEAR((measured_vector(simulation, probe_of("displacement", "disc")) - Vec2(0.05, -0.025)).norm(), 0,
              motion_rounding)
      << "EXACT";
  // EXACT but for the spin's own strain, of order (spin t)^2 = 2.5e-7, of the angle.
  EXPECT_NEAR(measured(simulation, probe_of("rotation", "disc"))[0], 5e-4, 5e-4 * 1e-6);
  // Nodes: mean of the field nodes' displacement over mass is the body's; each turns about it by spin x t.
  const Vec2 node = model.shape_of(model.bodies[0]).space.mesh.nodes[7], arm = Eigen::Rotation2Dd(0.4) * node;
  const Vec2 moved = measured_vector(simulation, at_node(7, probe_of("displacement", "disc"))),
             expected = Vec2(0.05, -0.025) + 5e-4 * Vec2(-arm.y(), arm.x());
  EXPECT_NEAR((moved - expected).norm(), 0, 1e-6) << "EXACT but for the spin's strain";
}

// EXACT: as given, whatever the mass, and rounding of what the state holds instead of velocities.
TEST(MotionProbes, rate_of_rotation_with_corrected_mass) {
  Scene scene = free_disc(60, 0.5, moving({0.1, 0}, 1e-3));
  scene.discretisation.mass = Mass::corrected;
  const Model model = build_model(scene);
  Simulation simulation(model);
  EXPECT_NEAR(measured(simulation, probe_of("rotation", "disc"))[1], 1e-3, 1e-13);
}

TEST(MotionProbes, reductions_go_over_bodies) {
  Scene scene = empty_scene(1);
  scene.shapes = {polygonal_disc("disc", 1, 12)};
  scene.grains = {grains("pair", "disc", BodyKind::rigid, {{0, 1}, {4, 3}})};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const Probe where = probe_of("position", "pair");
  EXPECT_EQ(measured_vector(simulation, where), Vec2(2, 2)) << "EXACT";
  EXPECT_EQ(measured_vector(simulation, reduced_by(Reduction::min, where)), Vec2(0, 1)) << "EXACT";
  EXPECT_EQ(measured_vector(simulation, reduced_by(Reduction::max, where)), Vec2(4, 3)) << "EXACT";
  EXPECT_EQ(measured_vector(simulation, probe_of("position", "pair 1")), Vec2(4, 3)) << "EXACT: one of them";
  EXPECT_EQ(measured_vector(simulation, probe_of("position", "all")), Vec2(2, 2)) << "EXACT";
  EXPECT_TRUE(std::isnan(measured(simulation, probe_of("position", "compliant"))[0])) << "EXACT: none there";
  EXPECT_EQ(measured(simulation, probe_of("force", "compliant"))[0], 0) << "EXACT: a sum of nothing";
  const double area = polygon_properties(model.outlines[0].points).area;
  EXPECT_NEAR(measured(simulation, probe_of("area", "pair"))[0], 2 * area, motion_rounding) << "EXACT";
}

TEST(MotionProbes, a_node_must_be_there) {
  const Model model = build_model(thrown_disc(1));
  EXPECT_NO_THROW(ProbeSampler(model, at_node(11, probe_of("position", "stone"))));
  try {
    ProbeSampler(model, at_node(12, probe_of("position", "stone")));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("found 12, allowed: 0 to 11"), std::string::npos) << error.what();
  }
}

/// Grains of both kinds between a wall that stands and one that is pressed, and shears faster and faster, under
/// gravity.
Scene loaded_layer() {
  Scene scene = small_third_body(1);
  scene.gravity = {0, -0.01};
  scene.walls[1].x = {AxisCondition::Mode::velocity, {{0, 2}, {0, 0.1}}};
  return scene;
}

TEST(ForceProbes, origins_add_up_to_mass_times_acceleration) {
  const Scene scene = loaded_layer();
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 1);
  for (const Body& body : model.bodies) {
    Vec2 sum(0, 0);
    for (const char* origin : {"force", "body_force", "applied_force", "reaction_force"})
      sum += measured_vector(simulation, probe_of(origin, body.name));
    if (body.kind == BodyKind::compliant)
      EXPECT_NEAR(measured_vector(simulation, probe_of("internal_force", body.name)).norm(), 0, motion_rounding)
          << "EXACT: rounding of nodal forces of order 0.1";
    const Vec2 total = measured_vector(simulation, probe_of("total_force", body.name)),
               acceleration = measured_vector(simulation, probe_of("acceleration", body.name));
    EXPECT_NEAR((sum - total).norm(), 0, motion_rounding) << "EXACT: " << body.name;
    EXPECT_NEAR((body.mass * acceleration - total).norm(), 0, motion_rounding) << "EXACT: " << body.name;
  }
}

TEST(ForceProbes, walls) {
  const Model model = build_model(loaded_layer());
  Simulation simulation(model);
  advance(simulation, 1);
  const int upper = static_cast<int>(model.bodies.size()) - 1, lower = upper - 1;
  const double pressure = 0.05, mass = 6;  // half of the ramp to 0.1 by t = 2; thickness 1, density 1, period 6
  const Vec2 applied = measured_vector(simulation, probe_of("applied_force", "upper"));
  EXPECT_NEAR((applied - Vec2(0, -pressure * 6 + 0.01 * mass)).norm(), 0, motion_rounding)
      << "EXACT: pressure times period, and what bears its weight";
  EXPECT_NEAR((measured_vector(simulation, probe_of("body_force", "upper")) - Vec2(0, -0.01 * mass)).norm(), 0,
              motion_rounding);
  // EXACT: the drive along x gives 0.1 in 2, so mass x 0.05, beside what contact takes.
  const Vec2 shear = measured_vector(simulation, probe_of("reaction_force", "upper"));
  EXPECT_NEAR(shear.x(), mass * 0.05 - contact_force(simulation, upper).x(), motion_rounding);
  EXPECT_EQ(shear.y(), 0) << "EXACT: loaded, not imposed";
  const Vec2 held = measured_vector(simulation, probe_of("reaction_force", "lower"));
  EXPECT_NEAR((held + contact_force(simulation, lower) + Vec2(0, -0.01 * mass)).norm(), 0, motion_rounding)
      << "EXACT: rest";
  EXPECT_GT(contact_force(simulation, upper).norm(), 1e-3) << "the wall is touched";
}

TEST(ForceProbes, nodes_carry_the_bodys_force) {
  const Model model = build_model(loaded_layer());
  Simulation simulation(model);
  advance(simulation, 1);
  for (const Body& body : model.bodies) {
    if (body.wall) continue;
    Vec2 sum(0, 0);
    for (int k = 0; k < model.outlines[body.outline].count; ++k)
      sum += measured_vector(simulation, at_node(k, probe_of("force", body.name)));
    EXPECT_NEAR((sum - measured_vector(simulation, probe_of("force", body.name))).norm(), 0, motion_rounding)
        << "EXACT";
  }
}

TEST(EnergyProbes, bodies_add_up_to_the_balance) {
  const Model model = build_model(loaded_layer());
  Simulation simulation(model);
  advance(simulation, 1);
  const Energies e = simulation.energy_balance().energy;
  double kinetic = measured(simulation, probe_of("kinetic_energy", "all"))[0];
  for (const char* wall : {"lower", "upper"}) kinetic += measured(simulation, probe_of("kinetic_energy", wall))[0];
  EXPECT_NEAR(kinetic, e.kinetic, motion_rounding * e.kinetic) << "EXACT";
  const double strain = measured(simulation, probe_of("strain_energy", "compliant"))[0];
  EXPECT_NEAR(strain, e.strain, 1e-10 * e.strain) << "EXACT: logarithms of J near 1 keep 1e-10 of the energy";
  EXPECT_GT(e.strain, 1e-6);
}

TEST(EnergyProbes, works_by_origin) {
  const Model model = build_model(loaded_layer());
  Simulation simulation(model);
  const double before = measured(simulation, probe_of("position", "all"))[1];
  const Vec2 upper_before = measured_vector(simulation, probe_of("position", "upper"));
  advance(simulation, 1);
  const std::vector<double> works = measured(simulation, probe_of("works"));
  const Energies e = simulation.energy_balance().energy;
  EXPECT_NEAR(works[0] + works[1], e.external_work, motion_rounding) << "EXACT";
  EXPECT_EQ(works[2], e.dissipated) << "EXACT: no damping";
  EXPECT_EQ(works[3], 0) << "EXACT: no damping";
  double mass = 0;
  for (const Body& body : model.bodies) mass += body.wall ? 0 : body.mass;
  const double fall = measured(simulation, probe_of("position", "all"))[1] - before,
               sink = measured_vector(simulation, probe_of("position", "upper")).y() - upper_before.y();
  // EXACT: all grains have one mass; the upper wall of mass 6 sinks too.
  EXPECT_NEAR(works[1], -0.01 * (mass * fall + 6 * sink), motion_rounding);
}

}  // namespace
}  // namespace pliant::dynamics_tests
