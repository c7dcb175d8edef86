// Cells with two periods that are deformed.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bodies/reciprocal_mass.hpp"
#include "core/errors.hpp"
#include "dynamics/cell_motion.hpp"
#include "dynamics/cell_stress.hpp"
#include "geometry/lattice.hpp"
#include "results/body_motion.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

/// Compressed along y, then sheared too.
void deform(Scene& scene, const Vec2& periods, double rate, double until) {
  CellSettings cell;
  cell.periods = periods;
  cell.gradient[1][1] = {{0, until}, {1, 1 - rate * until}};
  cell.gradient[0][1] = {{0.25 * until, until}, {0, rate * until}};
  cell.gradient[0][0] = {{0, until}, {1, 1 - 0.5 * rate * until}};
  scene.cell = cell;
}

constexpr int cell_columns = 3, cell_rows = 3;

/// Discs of both kinds that nearly touch, out of order in their cell. `shift`: of all; `images`: each disc by up to
/// three times this number of periods.
Scene packed_cell(double end, double rate, const Vec2& shift = {0, 0}, int images = 0) {
  Scene scene = empty_scene(end);
  scene.shapes = {disc_shape("disc", 1, 60), disc_shape("small", 0.9, 40)};
  testing::Random random(2);
  const Vec2 periods(cell_columns * 1.02, cell_rows * 1.03);
  for (int i = 0; i < cell_columns; ++i)
    for (int j = 0; j < cell_rows; ++j) {
      Vec2 centre{1.02 * i + random.uniform(0, 0.04), 1.03 * j + 0.3 * (i % 2) + random.uniform(0, 0.04)};
      const int across = random.below(7) - 3;
      const int up = random.below(5) - 2;
      centre += shift;
      centre += images * Vec2(across * periods.x(), up * periods.y());
      scene.grains.push_back(grains("g" + std::to_string(scene.grains.size()), (i + j) % 2 == 0 ? "disc" : "small",
                                    (i + 2 * j) % 3 == 0 ? BodyKind::rigid : BodyKind::compliant, {centre}));
    }
  scene.contacts = {mohr_coulomb(100, 0.3)};
  deform(scene, periods, rate, end);
  return scene;
}

// EXACT: matter that touches nothing stays at rest relative to the cell, at x = F X, also inside of compliant bodies.
// The velocity jumps at the points of the histories; each step rounds.
TEST(Cell, carries_free_matter_along) {
  Scene scene = packed_cell(2, 0.04);
  scene.shapes = {disc_shape("disc", 0.3, 60), disc_shape("small", 0.2, 40)};
  const Model model = build_model(scene);
  Simulation simulation(model);
  const Dofs start = simulation.state().position;
  advance(simulation, scene.time.end);
  const Eigen::Matrix2d f = deformation_gradient(scene, simulation.state());
  EXPECT_NEAR(f(0, 1), 0.08, 1e-14);
  EXPECT_NEAR(f(1, 1), 0.92, 1e-14);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Vec2 now = centre_of(model, body, simulation.state().position), then = centre_of(model, body, start);
    // A compliant body deforms with the cell at first, and then swings about its own shape: only its centre follows.
    EXPECT_LT((now - f * then).norm(), 1e-11) << body.name;
  }
}

/// Outlines back in the cell of the first telling.
double largest_distance(const Scene& first, const Simulation& a, const Simulation& b) {
  const Eigen::Matrix2d f = deformation_gradient(first, a.state());
  double largest = 0;
  for (std::size_t body = 0; body < a.model().bodies.size(); ++body) {
    const Vec2 apart = b.model().bodies[body].centre - a.model().bodies[body].centre;
    for (int i = a.model().outline_offset[body]; i < a.model().outline_end(static_cast<int>(body)); ++i)
      largest =
          std::max(largest, (b.state().outlines.position.at(i) - a.state().outlines.position.at(i) - f * apart).norm());
  }
  return largest;
}

// EXACT: all moved by any vector, or each body to an image of its own, moves alike. Steps round positions of up to 12,
// and of up to 3 * 4 times this number with distant images. These move with the cell by several skins in a step.
TEST(Cell, does_not_know_its_origin_or_which_images_bodies_are) {
  constexpr double end = 2;
  const Scene scene = packed_cell(end, 0.05);
  const Model plain = build_model(scene);
  Simulation simulation(plain);
  advance(simulation, end);
  EXPECT_GT(simulation.state().contacts, 20);
  for (const int images : {0, 1, 20}) {
    const Scene other = packed_cell(end, 0.05, {3.3, -1.7}, images);
    const Model moved = build_model(other);
    Simulation elsewhere(moved);
    advance(elsewhere, end);
    EXPECT_EQ(elsewhere.state().steps, simulation.state().steps);
    const double rounding = 12 * std::max(images, 1) * std::numeric_limits<double>::epsilon() *
                            static_cast<double>(elsewhere.state().steps);
    EXPECT_LT(largest_distance(scene, simulation, elsewhere), 100 * rounding + 1e-12) << images;
  }
}

/// Energy that steps make of nothing, with the step times `safety`.
double error_of_balance(Scene scene, double safety) {
  without_error_control(scene, safety);
  scene.contact.energy_consistent = false;
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, scene.time.end);
  const Energies energy = simulation.energy_balance().energy;
  EXPECT_GT(energy.external_work, 1e-3);
  return simulation.energy_gained(energy) / energy.external_work;
}

// RATE: the work on images and on matter that the cell takes along balances to second order. A frictionless contact
// has an energy; compression and shear press all discs together.
TEST(Cell, balances_energy_to_second_order) {
  Scene scene = packed_cell(3, 0.05);
  scene.contacts = {smoothed(frictionless(30), 0.2)};
  scene.contact.quadrature = ContactQuadrature::segments;
  const double coarse = error_of_balance(scene, 0.4), fine = error_of_balance(scene, 0.1);
  EXPECT_LT(std::abs(coarse), 1e-2);
  EXPECT_GT(observed_order(coarse, fine, 4), 1.5) << coarse << " " << fine;
}

// EXACT: the cell's stress from the work on images is the Love-Weber stress of the contacts and the inertia of the
// grains: -Q is the sum of branch vectors times forces, less mass times acceleration times centre.
TEST(Cell, work_is_that_of_contacts_and_inertia) {
  const Scene scene = packed_cell(2, 0.05);
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 1.9);
  const State& state = simulation.state();
  const std::vector<Vec2> centres = [&] {
    Points all;
    for (const Body& body : model.bodies) all.push_back(centre_of(model, body, state.position));
    return all;
  }();
  Eigen::Matrix2d forces = Eigen::Matrix2d::Zero(), inertia = forces;
  const Lattice q = state.force.lattice;
  const Eigen::Matrix2d work = -(matrix_of(q) * matrix_of(state.position.lattice).transpose());
  const StepForces& last = state.memory.contact.last;
  for (const ContactPair& pair : simulation.forces().contact().contact_pairs()) {
    Vec2 on_second(0, 0);
    for (int i = 0; i < pair.forces(1).count; ++i)
      on_second += Vec2(last.forces.x[pair.entry[1] + i], last.forces.y[pair.entry[1] + i]);
    const Vec2 branch = centres[pair.second] + state.position.lattice.shift(pair.images) - centres[pair.first];
    forces -= on_second * branch.transpose();
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    inertia += contact_force(simulation, static_cast<int>(b)) * centres[b].transpose();
  EXPECT_GT(work.norm(), 0.1);
  EXPECT_LT((work - forces - inertia).norm(), 1e-11);
}

// EXACT: the same bits with one and two threads.
TEST(Cell, does_not_depend_on_threads) {
  const Model model = build_model(packed_cell(2, 0.05));
  EXPECT_EQ(hash_after(model, 1, 1.5), hash_after(model, 2, 1.5));
}

TEST(Cell, is_part_of_the_hash_of_a_state) {
  const Model model = build_model(packed_cell(2, 0.05));
  Simulation simulation(model);
  advance(simulation, 0.5);
  State state = simulation.state();
  const std::uint64_t hash = state_hash(state);
  state.position.lattice.bx = std::nextafter(state.position.lattice.bx, 1e300);
  EXPECT_NE(state_hash(state), hash);
}

/// A square of 1, its sides joined to those of its own images, in a cell of its size.
Scene filled_cell(double end, double viscosity) {
  Scene scene = empty_scene(end);
  scene.shapes = {box_shape("square", 1, 1, 0.1)};
  scene.materials[0].viscosity = viscosity;
  scene.grains = {grains("square", "square", BodyKind::compliant, {{0.5, 0.5}})};
  scene.contacts = {cohesive(2000, 4, 0.01, 4)};
  scene.cell.emplace();
  scene.cell->periods = {1, 1};
  return scene;
}

/// Cauchy stress of neo-Hookean matter with mu = 1 and lambda = 4.
Eigen::Matrix2d neo_hookean(const Eigen::Matrix2d& f) {
  const double j = f.determinant();
  return (f * f.transpose() - Eigen::Matrix2d::Identity() + 4 * std::log(j) * Eigen::Matrix2d::Identity()) / j;
}

/// The stress at the end of a slow deformation of the filled cell, and that of its mean gradient.
std::pair<Eigen::Matrix2d, Eigen::Matrix2d> stress_of_filled_cell(const Eigen::Matrix2d& f) {
  constexpr double end = 16, loaded = 8;
  Scene scene = filled_cell(end, 0.2);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k) scene.cell->gradient[i][k] = {{0, loaded}, {i == k ? 1.0 : 0.0, f(i, k)}};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, end);
  return {cell_stress(model, simulation.state()).total(), neo_hookean(f)};
}

// INDEPENDENT: a grain that fills the cell and holds to its own images deforms as the matter does: the stress of the
// cell is that of the law at the cell's gradient. The sides give way by stress over stiffness, 1/2000 of the stress on
// a length of 1; the bonds at nodes leave out half a spacing of 0.1 at corners, where four images meet.
TEST(Cell, filled_by_one_grain_has_the_stress_of_its_material) {
  Eigen::Matrix2d compressed, sheared;
  compressed << 0.93, 0, 0, 0.96;
  sheared << 0.96, 0.06, 0.06, 0.96;
  for (const Eigen::Matrix2d& f : {compressed, sheared}) {
    const auto [found, expected] = stress_of_filled_cell(f);
    EXPECT_GT(expected.norm(), 0.2);
    EXPECT_LT((found - expected).norm(), 0.03 * expected.norm()) << found << "\n" << expected;
  }
}

// The wanted stress sets in where it moves the cell, and components that are given keep their gradient.
TEST(Cell, comes_to_rest_at_the_wanted_stress) {
  Scene scene = filled_cell(30, 0.2);
  scene.cell->stress[0][0] = History{{0, 10}, {0, -0.3}};
  scene.cell->stress[0][1] = History{{0, 10}, {0, 0.05}};
  scene.cell->gradient[1][1] = {{0, 10}, {1, 0.97}};
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, scene.time.end);
  const Eigen::Matrix2d stress = cell_stress(model, simulation.state()).total(),
                        f = deformation_gradient(scene, simulation.state());
  EXPECT_NEAR(stress(0, 0), -0.3, 0.003);
  EXPECT_NEAR(stress(0, 1), 0.05, 0.003);
  EXPECT_NEAR(f(1, 1), 0.97, 1e-12);
  EXPECT_EQ(f(1, 0), 0);
  EXPECT_GT(f(0, 1), 0.01);
  EXPECT_LT(f(0, 0), 0.99);
}

// EXACT: a run that starts from another's end has its cell and its motion; the gradient of its histories counts from
// there.
TEST(Cell, goes_on_from_another_run) {
  Scene first = packed_cell(1, 0);
  first.cell->gradient = {};
  first.cell->gradient[0][0] = {{0, 2}, {1, 0.8}};
  const Model model = build_model(first);
  Simulation before(model);
  advance(before, 1);
  Scene second = first;
  second.cell->gradient = {};
  second.cell->gradient[0][1] = {{0, 1}, {0, 0.5}};
  const Model next = build_model(second);
  const StartPoint start = before.start_point();
  Simulation after(next, &start);
  EXPECT_EQ(after.state().position.lattice, before.state().position.lattice);
  Eigen::Matrix2d shear;
  shear << 0, 0.5, 0, 0;
  EXPECT_LT((velocity_gradient(after.state()) - shear).norm(), 1e-14);
  // Where the first run took matter along x, the second one takes it along x by its height.
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const Vec2 place = centre_of(model, body, before.state().position),
               change = mean_rate(model, body, after.state().reduced_momentum) -
                        mean_rate(model, body, before.state().reduced_momentum);
    EXPECT_LT((change - (shear - velocity_gradient(before.state())) * place).norm(), 1e-12);
  }
  advance(after, 1);
  Eigen::Matrix2d expected;
  expected << 0.9, 0.5, 0, 1;
  EXPECT_LT((deformation_gradient(second, after.state()) - expected).norm(), 1e-13);
}

// A stress that the cell cannot bear ends the run, and the message says why.
TEST(Cell, that_gives_way_says_so) {
  Scene scene = packed_cell(1000, 0);
  scene.cell->gradient = {};
  scene.cell->stress[0][0] = scene.cell->stress[1][1] = constant(0.05);
  const Model model = build_model(scene);
  Simulation simulation(model);
  try {
    advance(simulation, scene.time.end);
    ADD_FAILURE() << "nothing holds the grains together";
  } catch (const PhysicsError& error) {
    EXPECT_NE(std::string(error.what()).find("the cell gives way: its area is 4"), std::string::npos) << error.what();
  }
}

/// A disc that touches nothing, in a cell that begins to stretch within the run.
Scene stretched_disc(double scaling) {
  Scene scene = empty_scene(1);
  scene.discretisation.mass_scaling = scaling;
  scene.shapes = {disc_shape("disc", 1, 60)};
  scene.grains = {grains("disc", "disc", BodyKind::compliant, {{0.2, -0.1}})};
  CellSettings cell;
  cell.periods = {8, 8};
  cell.gradient[0][0] = {{0, 0.5, 1}, {1, 1, 1.02}};
  scene.cell = cell;
  return scene;
}

// EXACT: matter gets the velocity L x with lumped as with scaled mass, and its kinetic energy is the work on the cell.
// To rounding.
TEST(Cell, gives_matter_of_scaled_mass_its_velocity) {
  for (const double scaling : {1.0, 3.0, 10.0}) {
    const Model model = build_model(stretched_disc(scaling));
    Simulation simulation(model);
    advance(simulation, 0.5);
    const State& state = simulation.state();
    const Dofs velocity = material_velocity(model, state.reduced_momentum);
    const Body& body = model.bodies[0];
    for (int node = 0; node < model.shape_of(body).nodes(); ++node) {
      const Vec2 x = body.centre + node_value(model, body, state.position, node);
      EXPECT_LT((node_value(model, body, velocity, node) - Vec2(0.04 * x.x(), 0)).norm(), 1e-14) << scaling;
    }
    const Energies energy = simulation.energy_balance().energy;
    EXPECT_GT(energy.kinetic, 1e-6);
    EXPECT_NEAR(energy.kinetic, energy.external_work, 1e-12 * energy.kinetic) << scaling;
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
