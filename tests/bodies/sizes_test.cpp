// Bodies of several sizes, materials and angles in one group against bodies of as many shapes, each of its own size.
#include <gtest/gtest.h>

#include "bodies/nodal.hpp"
#include "setup/build_model.hpp"
#include "support/simulations.hpp"
#include "support/steered.hpp"

namespace pliant::dynamics_tests {
namespace {

struct Grain {
  double size;
  BodyKind kind;
  Vec2 centre;
  double angle;
  std::string material;
};

/// Two compliant discs of different size and material on a floor, a small and a large rigid one beside and above them,
/// all in touch after a while, and two free ones that stretch and turn as they fly.
const std::vector<Grain> grains_of_all_sizes = {
    {1, BodyKind::compliant, {1.5, 0.99}, 0.3, "soft"},   {0.5, BodyKind::compliant, {2.92, 0.49}, 1.1, "tough"},
    {2.3, BodyKind::rigid, {6.5, 2.29}, 0.2, "hard"},     {0.5, BodyKind::rigid, {3.7, 1.05}, 0.7, "hard"},
    {2.3, BodyKind::compliant, {2.5, 4.06}, 2.0, "soft"}, {0.5, BodyKind::rigid, {9.3, 0.49}, 0.1, "hard"},
    {0.13, BodyKind::compliant, {11, 3}, 0.4, "tough"}};

/// `shared`: all of one shape, to be given the sizes as scales; else each of a shape of its own size.
Scene scene_of(bool shared, Integrator integrator, DiscretisationMethod method) {
  Scene scene = on_a_floor(2, 12, 0.2, {0.01, -0.02});
  scene.discretisation.method = method;
  scene.time.integrator = integrator;
  scene.time.tolerance = scene.time.target = 1;  // steps are given, and the skin allows them: light nodes are fast
  scene.skin = 1;
  scene.materials.push_back({"tough", MaterialLaw::neo_hookean, 1.7, 4, 0.3});
  scene.contacts = {mohr_coulomb(60, 0.3)};
  scene.shapes = {disc_shape("disc", 2, 60)};
  for (const Grain& grain : grains_of_all_sizes) {
    std::string shape = "disc";
    if (!shared) {
      shape += std::to_string(scene.shapes.size());
      scene.shapes.push_back(disc_shape(shape, 2 * grain.size, 60));
    }
    InitialVelocity velocity = moving({0.02, -0.05}, 0.03);
    if (grain.kind == BodyKind::compliant) velocity.gradient << 0.01, 0.02, 0, -0.02;
    scene.grains.push_back(
        grains("grain" + std::to_string(scene.grains.size()), shape, grain.kind, {grain.centre}, velocity));
    scene.grains.back().angle = grain.angle;
    scene.grains.back().species[0].material = grain.material;
  }
  return scene;
}

BuildOptions with_all_sizes() {
  BuildOptions options;
  for (const Grain& grain : grains_of_all_sizes) options.scales.push_back(grain.size);
  return options;
}

/// Tables of two sizes of a shape differ by the solver's 1e-12; what is compared below is of order 1, over some hundred
/// steps.
constexpr double rounding_of_tables = 1e-9;

class Sizes : public ::testing::TestWithParam<std::tuple<Integrator, DiscretisationMethod>> {};

TEST_P(Sizes, of_one_shape_move_as_bodies_of_their_own_shapes) {
  const auto [integrator, method] = GetParam();
  Steered here(build_model(scene_of(true, integrator, method), with_all_sizes()));
  Steered there(build_model(scene_of(false, integrator, method)));
  const Model &model = here.bench.model, &twin = there.bench.model;
  ASSERT_EQ(model.batches.size(), 1U) << "one group, one batch";
  ASSERT_EQ(twin.batches.size(), 4U);
  expect_same_bound(here, there, 0.02);
  const int contacts = step_side_by_side(here, there, 0.003, 500, 1e-4);
  EXPECT_GT(contacts, 20) << "all kinds of pairs must touch";
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body &body = model.bodies[b], &other = twin.bodies[b];
    EXPECT_NEAR(body.mass / other.mass, 1, 1e-13) << "EXACT";
    EXPECT_NEAR(body.area / other.area, 1, 1e-13) << "EXACT";
    if (body.kind != BodyKind::compliant) continue;
    for (const auto& [q, p] : {std::pair(&here.bench.state.position, &there.bench.state.position),
                               std::pair(&here.bench.state.reduced_momentum, &there.bench.state.reduced_momentum)}) {
      const Points values = nodal_values(model, body, *q), expected = nodal_values(twin, other, *p);
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_LT((values[i] - expected[i]).norm(), rounding_of_tables) << "EXACT, body " << b;
      EXPECT_LT((mean_value(model, body, *q) - mean_value(twin, other, *p)).norm(), rounding_of_tables) << "EXACT";
    }
  }
  for (std::size_t i = 0; i < here.bench.state.position.rigid.size(); ++i) {
    EXPECT_NEAR(here.bench.state.position.rigid[i], there.bench.state.position.rigid[i], rounding_of_tables) << "EXACT";
    EXPECT_NEAR(here.bench.state.reduced_momentum.rigid[i], there.bench.state.reduced_momentum.rigid[i],
                rounding_of_tables)
        << "EXACT";
  }
  const EnergyBalance audit = here.auditor.audit(here.bench.state);
  const Energies a = audit.energy, b = there.auditor.audit(there.bench.state).energy;
  for (const auto& [x, y] :
       {std::pair(a.kinetic, b.kinetic), std::pair(a.strain, b.strain), std::pair(a.contact, b.contact),
        std::pair(a.dissipated, b.dissipated), std::pair(a.external_work, b.external_work)}) {
    EXPECT_NEAR(x / y, 1, 1e-7) << "EXACT: energies, down to 1e-3 of the largest";
    EXPECT_GT(std::abs(y), 1e-9) << "nothing to compare";
  }
  EXPECT_LT(audit.momentum_error, 1e-13) << "EXACT: internal and contact forces balance";
  EXPECT_NEAR(here.auditor.balance_error(a), there.auditor.balance_error(b), 1e-8) << "EXACT";
  if (here.verlet) EXPECT_LT(here.auditor.balance_error(a), 2e-3) << "FROZEN: with either";
}

INSTANTIATE_TEST_SUITE_P(All, Sizes,
                         ::testing::Combine(::testing::Values(Integrator::verlet, Integrator::step_doubling),
                                            ::testing::Values(DiscretisationMethod::mls, DiscretisationMethod::es_t3)));

/// EXACT: bodies of one shape and size share their outline, others have their own; lanes carry what belongs to each.
TEST(BodySizes, share_what_is_equal) {
  const Model model = build_model(scene_of(true, Integrator::verlet, DiscretisationMethod::mls), with_all_sizes());
  const auto outline = [&](int body) { return model.bodies[body].outline; };
  EXPECT_EQ(outline(3), outline(5));
  EXPECT_NE(outline(3), outline(2));
  EXPECT_NE(outline(0), outline(1));
  for (const Body& body : model.bodies)
    if (!body.wall) EXPECT_NEAR(model.outlines[body.outline].spacing / body.scale, 2 * M_PI / 29, 0.02);
  const Batch& batch = model.batches[0];
  for (const Body& body : model.bodies) {
    if (body.kind != BodyKind::compliant) continue;
    EXPECT_EQ(batch.weight[body.lane], body.scale * body.scale);
    EXPECT_DOUBLE_EQ(batch.density[body.lane], model.scene.materials[body.material].density * body.scale * body.scale);
  }
}

}  // namespace
}  // namespace pliant::dynamics_tests
