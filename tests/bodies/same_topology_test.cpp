// Bodies of shapes of one topology in the lanes of one batch against the same bodies vectorised nodewise, each by the
// table of its own shape.
#include <gtest/gtest.h>
#include <omp.h>

#include "bodies/make_batches.hpp"
#include "bodies/nodal.hpp"
#include "geometry/curves.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"
#include "support/steered.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr int grains_in_all = 11;

enum class Extras { none, damping_and_corrected_mass, mass_scaling };

/// Fourier grains of eleven shapes and several sizes on a floor, pushed together, and a rigid disc.
Scene heap(DiscretisationMethod method, Integrator integrator, Extras extras = Extras::none) {
  Scene scene = on_a_floor(2, 9, 0.2, {0.01, -0.05});
  scene.discretisation.method = method;
  scene.time.integrator = integrator;
  scene.time.tolerance = scene.time.target = 1;  // steps are given
  scene.materials.push_back({"tough", MaterialLaw::neo_hookean, 1.7, 4, 0.3});
  if (extras == Extras::damping_and_corrected_mass) {
    scene.discretisation.mass = Mass::corrected;
    for (Material& material : scene.materials) material.viscosity = 0.003, material.mass_damping = 0.1;
  }
  if (extras == Extras::mass_scaling) scene.discretisation.mass_scaling = 3;
  scene.contacts = {mohr_coulomb(60, 0.3)};
  for (int i = 0; i < grains_in_all; ++i) {
    ShapeSpec shape;
    shape.name = "grain" + std::to_string(i);
    shape.kind = ShapeKind::curve;
    shape.points = fourier_grain(2, {0.08, 0.03}, i + 1);
    shape.nodes = 80;
    shape.outline_nodes = 30;
    scene.shapes.push_back(shape);
    InitialVelocity velocity = moving({0.02 * (i % 3), -0.05}, 0.03);
    velocity.gradient << 0.01, 0.02, 0, -0.02;
    const Vec2 centre(1.2 + 2.12 * (i % 4), 1.08 + 2.12 * (i / 4));
    scene.grains.push_back(grains(shape.name, shape.name, BodyKind::compliant, {centre}, velocity));
    scene.grains.back().angle = 0.3 * i;
    if (i % 3 == 1) scene.grains.back().species[0].material = "tough";
  }
  scene.shapes.push_back(disc_shape("disc", 1, 60));
  scene.grains.push_back(grains("disc", "disc", BodyKind::rigid, {{4.3, 7.1}}, moving({0, -0.2})));
  return scene;
}

BuildOptions always() {
  BuildOptions options{.least_sparse_nodes = 0, .unite_topologies = true, .scales = {}};
  for (int i = 0; i <= grains_in_all; ++i) options.scales.push_back(1 + 0.02 * (i % 4));
  return options;
}

/// The same bodies, meshes and tables, each body vectorised nodewise.
Model nodewise(Model model) {
  model.groups.clear(), model.batches.clear(), model.regions.clear(), model.same_topology_shapes.clear();
  model.compliant_size = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    if (const Body& body = model.bodies[b]; body.kind == BodyKind::compliant)
      model.groups.push_back({body.compliant_shape, MaterialLaw::neo_hookean, {b}});
  make_batches(model, 0);
  return model;
}

class SameTopology : public ::testing::TestWithParam<std::tuple<DiscretisationMethod, Integrator, Extras>> {};

TEST_P(SameTopology, bodies_move_as_nodewise_ones) {
  const auto [method, integrator, extras] = GetParam();
  Steered here(build_model(heap(method, integrator, extras), always()));
  Steered there(nodewise(here.bench.model));
  const Model &united = here.bench.model, &alone = there.bench.model;
  ASSERT_EQ(united.batches.size(), 2U) << "eight bodies and three";
  for (const Batch& batch : united.batches) ASSERT_EQ(batch.layout, Layout::same_topology);
  ASSERT_EQ(alone.batches.size(), 11U);
  for (const Batch& batch : alone.batches) ASSERT_EQ(batch.layout, Layout::nodewise);
  expect_same_bound(here, there, 0.02);
  const int contacts = step_side_by_side(here, there, 4e-3, 300, 1e-6);
  EXPECT_GT(contacts, 20);
  const State &x = here.bench.state, &y = there.bench.state;
  for (std::size_t b = 0; b < alone.bodies.size(); ++b) {
    const Body &body = united.bodies[b], &other = alone.bodies[b];
    if (body.kind != BodyKind::compliant) continue;
    expect_equal_points(nodal_values(united, body, x.position), nodal_values(alone, other, y.position),
                        rounding_of_order, "node");
    expect_equal_points(nodal_values(united, body, x.reduced_momentum), nodal_values(alone, other, y.reduced_momentum),
                        100 * rounding_of_order,
                        "velocity");  // a frequency of 100
  }
  const EnergyBalance a = here.auditor.audit(x), b = there.auditor.audit(y);
  EXPECT_NEAR(a.energy.kinetic / b.energy.kinetic, 1, 1e-10) << "EXACT";
  EXPECT_NEAR(a.energy.strain / b.energy.strain, 1, 1e-9) << "EXACT";
  EXPECT_NEAR(a.energy.contact / b.energy.contact, 1, 1e-9) << "EXACT";
  EXPECT_NEAR(a.energy.external_work / b.energy.external_work, 1, 1e-9) << "EXACT";
  EXPECT_LT(a.momentum_error, 1e-12) << "EXACT";
  if (here.verlet) EXPECT_LT(here.auditor.balance_error(a.energy), 2e-3) << "FROZEN: with either";
}

INSTANTIATE_TEST_SUITE_P(Methods, SameTopology,
                         ::testing::Combine(::testing::Values(DiscretisationMethod::mls, DiscretisationMethod::es_t3,
                                                              DiscretisationMethod::mls_gauss),
                                            ::testing::Values(Integrator::verlet, Integrator::step_doubling),
                                            ::testing::Values(Extras::none, Extras::damping_and_corrected_mass,
                                                              Extras::mass_scaling)));

/// EXACT: the same bits with one, two and three threads.
TEST(SameTopologyBodies, do_not_depend_on_the_number_of_threads) {
  const Model model = build_model(heap(DiscretisationMethod::mls, Integrator::verlet), always());
  const int before = omp_get_max_threads();
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Simulation simulation(model);
    for (int step = 0; step < 60; ++step) simulation.step(2);
    hashes.push_back(state_hash(simulation.state()));
  }
  omp_set_num_threads(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

/// EXACT: the rule. Small scenes are left alone, as are shapes with many bodies, polygons and fewer than three
/// relatives.
TEST(SameTopologyBodies, are_few_of_many_smooth_shapes) {
  Scene scene = heap(DiscretisationMethod::es_t3, Integrator::verlet);
  const Model small = build_model(scene);  // 880 nodes
  EXPECT_EQ(small.batches.size(), 11U);
  EXPECT_EQ(small.lane_batches, 11);
  for (Batch batch : small.batches) EXPECT_EQ(batch.layout, Layout::shared);
  for (ShapeSpec& shape : scene.shapes) shape.nodes = 100;
  const Model large = build_model(scene);
  EXPECT_EQ(large.batches.size(), 2U);
  EXPECT_EQ(large.batches[0].layout, Layout::same_topology);
  EXPECT_EQ(build_model(scene, {.least_sparse_nodes = 0, .unite_topologies = false, .scales = {}}).batches[0].layout,
            Layout::nodewise);
  for (int i = 0; i < 9; ++i) scene.shapes[i].nodes = 101 + i;  // of eleven only two agree
  for (const Batch& batch : build_model(scene).batches) EXPECT_EQ(batch.layout, Layout::nodewise);
}

}  // namespace
}  // namespace pliant::dynamics_tests
