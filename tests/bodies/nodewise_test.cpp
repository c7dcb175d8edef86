// Bodies that are vectorised over their nodes against the same bodies in a lane each.
#include <gtest/gtest.h>
#include <omp.h>

#include <numeric>

#include "bodies/body_view.hpp"
#include "bodies/internal_forces.hpp"
#include "bodies/nodal.hpp"
#include "setup/build_model.hpp"
#include "support/bench.hpp"
#include "support/random.hpp"
#include "support/simulations.hpp"
#include "support/steered.hpp"

namespace pliant::dynamics_tests {
namespace {

using testing::Random;

/// Of the pile's grains: all of a size of their own.
const std::vector<double> pile_sizes{1.01, 0.99, 1.02, 1, 0.97};
const BuildOptions always_nodewise{.least_sparse_nodes = 0, .unite_topologies = true, .scales = pile_sizes};
const BuildOptions never_nodewise{.least_sparse_nodes = 1 << 30, .unite_topologies = true, .scales = pile_sizes};

/// Two discs of 603 nodes (two regions, with padding) and one of 60 of another law, on a floor under rigid grains.
Scene pile(DiscretisationMethod method, Integrator integrator = Integrator::verlet) {
  Scene scene = on_a_floor(2, 5, 0.1, {0.01, -0.05});
  scene.discretisation.method = method;
  scene.time.integrator = integrator;
  scene.time.tolerance = scene.time.target = 1;  // steps are given
  scene.materials.push_back({"other", MaterialLaw::melody, 1.5, 2, 0.3});
  scene.contacts = {mohr_coulomb(60, 0.3)};
  scene.shapes = {disc_shape("large", 2, 603), disc_shape("small", 1, 60)};
  InitialVelocity velocity = moving({0.03, -0.05}, 0.02);
  velocity.gradient << 0.01, 0.03, 0, -0.02;
  scene.grains = {grains("large", "large", BodyKind::compliant, {{1.2, 0.99}, {3.7, 0.995}}, velocity),
                  grains("small", "small", BodyKind::compliant, {{2.45, 1.805}}, moving({0, -0.1})),
                  grains("rigid", "small", BodyKind::rigid, {{1.2, 2.49}, {3.3, 2.44}}, moving({0, -0.05}))};
  scene.grains[0].angle = 0.4;
  scene.grains[1].species[0].material = "other";
  return scene;
}

class Nodewise : public ::testing::TestWithParam<std::tuple<DiscretisationMethod, Integrator>> {};

TEST_P(Nodewise, bodies_move_as_those_in_lanes) {
  const auto [method, integrator] = GetParam();
  Steered here(build_model(pile(method, integrator), always_nodewise));
  Steered there(build_model(pile(method, integrator), never_nodewise));
  const Model &nodewise = here.bench.model, &lanes = there.bench.model;
  ASSERT_EQ(nodewise.lane_batches, 0);
  ASSERT_EQ(nodewise.batches.size(), 3U);
  ASSERT_EQ(nodewise.batches[0].regions, 2);
  ASSERT_EQ(lanes.batches.size(), 2U);
  EXPECT_EQ(nodewise.dof_count(), lanes.dof_count());
  expect_same_bound(here, there, 0.01);
  const int contacts = step_side_by_side(here, there, 2e-3, 60, 1e-6);
  EXPECT_GT(contacts, 10);
  for (std::size_t b = 0; b < lanes.bodies.size(); ++b) {
    const Body &body = nodewise.bodies[b], &other = lanes.bodies[b];
    if (body.kind != BodyKind::compliant) continue;
    const State &x = here.bench.state, &y = there.bench.state;
    expect_equal_points(nodal_values(nodewise, body, x.position), nodal_values(lanes, other, y.position),
                        rounding_of_order, "node");
    expect_equal_points(outline_values(nodewise, body, x.position), outline_values(lanes, other, y.position),
                        rounding_of_order, "outline node");
    expect_equal_points(nodal_values(nodewise, body, x.reduced_momentum),
                        nodal_values(lanes, other, y.reduced_momentum), 100 * rounding_of_order,
                        "velocity");  // a frequency of 100
    EXPECT_LT((mean_value(nodewise, body, x.position) - mean_value(lanes, other, y.position)).norm(), rounding_of_order)
        << "EXACT";
  }
  const EnergyBalance a = here.auditor.audit(here.bench.state), b = there.auditor.audit(there.bench.state);
  EXPECT_NEAR(a.energy.kinetic / b.energy.kinetic, 1, 1e-10) << "EXACT";
  EXPECT_NEAR(a.energy.strain / b.energy.strain, 1, 1e-9) << "EXACT";
  EXPECT_NEAR(a.energy.contact / b.energy.contact, 1, 1e-9) << "EXACT";
  EXPECT_NEAR(a.energy.external_work / b.energy.external_work, 1, 1e-9) << "EXACT";
  EXPECT_LT(a.momentum_error, 1e-12) << "EXACT";
}

INSTANTIATE_TEST_SUITE_P(Methods, Nodewise,
                         ::testing::Combine(::testing::Values(DiscretisationMethod::mls, DiscretisationMethod::es_t3,
                                                              DiscretisationMethod::mls_gauss),
                                            ::testing::Values(Integrator::verlet, Integrator::step_doubling)));

/// Random smooth deformations, the same in both models.
Dofs deformed(const Model& model, std::uint64_t seed) {
  Dofs q = initial_positions(model);
  Random random(seed);
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    const BodyOffsets offsets(model, body);
    const BodyView view(model, body, q);
    for (int i = 0; i < model.shape_of(body).nodes(); ++i) {
      const auto node = static_cast<std::size_t>(i);
      const Vec2 x = view[node];
      const Vec2 noise{random.uniform(-1, 1), random.uniform(-1, 1)};
      set_node(offsets, node, x + 0.1 * Vec2(x.y() * x.y(), -x.x() * x.y()) + 0.002 * noise, q);
    }
  }
  return q;
}

/// EXACT: energies and least Jacobians of a state; forces are minus the gradient of the energy (central differences:
/// 1e-10 of forces of order 1 by rounding over 1e-5, and 1e-9 by the third derivative).
TEST(NodewiseForces, belong_to_the_energy) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss}) {
    const Model nodewise = build_model(pile(method), always_nodewise),
                lanes = build_model(pile(method), never_nodewise);
    Dofs q = deformed(nodewise, 3);
    const Dofs p = deformed(lanes, 3);
    Dofs f = zero_dofs(nodewise), g = zero_dofs(lanes);
    std::vector<double> least;
    for (const Batch& batch : nodewise.batches)
      least.push_back(
          add_internal_forces(nodewise, batch, {.position = &q.compliant[batch.offset]}, &f.compliant[batch.offset])
              .least_jacobian[0]);
    std::vector<Lanes> least_lanes;
    for (const Batch& batch : lanes.batches)
      least_lanes.push_back(
          add_internal_forces(lanes, batch, {.position = &p.compliant[batch.offset]}, &g.compliant[batch.offset])
              .least_jacobian);
    for (int b = 0; b < 3; ++b) {
      const Body &body = nodewise.bodies[b], &other = lanes.bodies[b];
      const BodyView forces(nodewise, body, f), expected(lanes, other, g);
      for (int i = 0; i < nodewise.shape_of(body).nodes(); ++i) {
        const auto node = static_cast<std::size_t>(i);
        ASSERT_LT((forces[node] - expected[node]).norm(), 1e-13);
      }
      EXPECT_NEAR(least[body.batch], least_lanes[other.batch][other.lane], 1e-13);
      const Batch& batch = nodewise.batches[body.batch];
      const Batch& lane_batch = lanes.batches[other.batch];
      const auto energy = [&] { return strain_energy(nodewise, batch, {.position = &q.compliant[batch.offset]})[0]; };
      EXPECT_NEAR(energy(), strain_energy(lanes, lane_batch, {.position = &p.compliant[lane_batch.offset]})[other.lane],
                  1e-13);
      const BodyOffsets offsets(nodewise, body);
      for (std::size_t i = 0; i < 60; i += 7) {
        double& x = reinterpret_cast<double*>(q.compliant.data())[offsets[i]];
        const double here = x;
        x = here + 1e-5;
        const double above = energy();
        x = here - 1e-5;
        const double below = energy();
        x = here;
        EXPECT_NEAR(forces[i].x(), -(above - below) / 2e-5 / (body.scale * body.scale), 2e-9);  // f/s against q/s
      }
    }
  }
}

/// EXACT: the same bits with one, two and three threads.
TEST(NodewiseForces, do_not_depend_on_the_number_of_threads) {
  for (const Integrator integrator : {Integrator::verlet, Integrator::step_doubling}) {
    const Model model = build_model(pile(DiscretisationMethod::mls, integrator), always_nodewise);
    const int before = omp_get_max_threads();
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3}) {
      omp_set_num_threads(threads);
      Simulation simulation(model);
      for (int step = 0; step < 60; ++step) simulation.step(2);
      const EnergyBalance audit = simulation.energy_balance();
      hashes.push_back(state_hash(simulation.state()) ^
                       std::bit_cast<std::uint64_t>(audit.energy.strain + audit.energy.kinetic));
    }
    omp_set_num_threads(before);
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
  }
}

/// EXACT: all nodes once, all points once, the two tables the same numbers.
TEST(NodewiseShape, is_the_table_in_another_order) {
  const Model model = build_model(pile(DiscretisationMethod::mls), always_nodewise);
  const NodewiseShape& shape = model.nodewise_shapes[0];
  const Discretisation& space = model.shapes[0].space;
  std::vector<int> offsets = shape.offset;
  std::sort(offsets.begin(), offsets.end());
  for (int n = 0; n < static_cast<int>(offsets.size()); ++n) EXPECT_EQ(offsets[n], offset_of(n));
  EXPECT_NEAR(std::accumulate(shape.weight.begin(), shape.weight.end(), 0.0), M_PI, 1e-12);
  EXPECT_EQ(shape.points() % lane_count, 0);
  EXPECT_EQ(shape.point.size(), shape.node.size());
  Lanes mass{};
  for (const Lanes& m : shape.mass_at_unit_density) mass += m;
  EXPECT_NEAR(sum(mass), M_PI, 1e-12);
  for (std::size_t n = 0; n < space.mass_at_unit_density.size(); ++n)
    EXPECT_EQ(shape.mass_at_unit_density[n / 8][n % 8] * shape.inverse_mass_at_unit_density[n / 8][n % 8] > 0.99, true);
}

/// Neighbours in space are neighbours in memory: the mean distance of the places of nodes that share a point. The
/// mesh's own order has a sixth of all nodes.
TEST(NodewiseShape, keeps_neighbours_together) {
  const Model model = build_model(pile(DiscretisationMethod::mls), always_nodewise);
  const NodewiseShape& shape = model.nodewise_shapes[0];
  double total = 0;
  int count = 0;
  for (int p = 0; p < shape.points(); ++p)
    for (int e = shape.start[p] + 1; e < shape.start[p + 1]; ++e, ++count)
      total += std::abs(shape.node[e] - shape.node[e - 1]) / 2;
  EXPECT_LT(total / count, 40) << "FROZEN: 30 when written";
}

/// EXACT: an inverted element is found and told with its node's place in the mesh, a NaN with its node.
TEST(NodewiseBodies, fail_by_name) {
  Bench bench(build_model(pile(DiscretisationMethod::mls), always_nodewise));
  const Body& body = bench.model.bodies[1];
  const BodyOffsets offsets(bench.model, body);
  set_node(offsets, 600, BodyView(bench.model, body, bench.state.position)[600] + Vec2(0.5, 0), bench.state.position);
  Trial trial(bench.model);
  const Evaluation evaluation = bench.evaluate(trial);
  EXPECT_LT(evaluation.least_jacobian, 0);
  EXPECT_FALSE(evaluation.valid);
  double least = 1e300;
  for (const Tensor<double>& F : deformation_gradients(bench.model, body, bench.state.position))
    least = std::min(least, determinant(F));
  EXPECT_NEAR(evaluation.least_jacobian, least, 1e-12);
}

/// The rule: many nodes in nearly empty batches.
TEST(NodewiseBodies, are_those_that_would_leave_lanes_empty) {
  const Model model = build_model(pile(DiscretisationMethod::es_t3));  // 1266 sparse nodes
  EXPECT_EQ(model.lane_batches, 0);
  const BuildOptions nodewise{.least_sparse_nodes = 0, .unite_topologies = true, .scales = {}};
  Scene many = pile(DiscretisationMethod::es_t3);
  for (int i = 0; i < 7; ++i) many.grains[0].packing.positions.push_back({1.2, 4.0 + 3 * i});
  const Model mixed = build_model(many, nodewise);  // nine large discs: eight in lanes, one nodewise
  EXPECT_EQ(mixed.lane_batches, 1);
  EXPECT_EQ(mixed.batches.size(), 3U);
  EXPECT_EQ(build_model(many).lane_batches, 3) << "663 nodes are not worth it";
}

}  // namespace
}  // namespace pliant::dynamics_tests
