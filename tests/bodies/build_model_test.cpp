#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "bodies/initial_state.hpp"
#include "bodies/model.hpp"
#include "core/errors.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

Grains grid_of(int columns, int rows, std::vector<Species> species, std::uint64_t seed) {
  Grains grains;
  grains.name = "grains";
  grains.shape = "disc";
  grains.packing = {PackingKind::grid, columns, rows, 2, 2, {0, 0}, {}};
  grains.species = std::move(species);
  grains.seed = seed;
  return grains;
}

Scene mixed_scene(int columns, int rows, std::vector<Species> species, std::uint64_t seed = 1) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(1)};
  scene.materials.push_back({"tough", MaterialLaw::neo_hookean, 2, 1, 0.3});
  scene.materials.push_back({"other", MaterialLaw::melody, 3, 1, 0.3});
  scene.shapes = {polygonal_disc("disc", 1, 24, 50)};
  scene.grains = {grid_of(columns, rows, std::move(species), seed)};
  return scene;
}

int count_of(const Model& model, BodyKind kind, const std::string& material) {
  return static_cast<int>(std::count_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) {
    return b.kind == kind && model.scene.materials[b.material].name == material;
  }));
}

// EXACT: shares that divide the number of grains come out exactly, whatever the seed.
TEST(BuildModel, MixHasExactShares) {
  const std::vector<Species> species = {
      {BodyKind::compliant, "soft", 0.3}, {BodyKind::rigid, "hard", 0.5}, {BodyKind::compliant, "tough", 0.2}};
  std::set<std::vector<int>> arrangements;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Model model = build_model(mixed_scene(10, 4, species, seed));
    EXPECT_EQ(count_of(model, BodyKind::compliant, "soft"), 12);
    EXPECT_EQ(count_of(model, BodyKind::rigid, "hard"), 20);
    EXPECT_EQ(count_of(model, BodyKind::compliant, "tough"), 8);
    std::vector<int> arrangement;
    for (const Body& b : model.bodies) arrangement.push_back(b.material);
    arrangements.insert(arrangement);
  }
  EXPECT_EQ(arrangements.size(), 3U);
}

// EXACT: otherwise within one grain of the share, and all are used.
TEST(BuildModel, MixRoundsByLessThanOneGrain) {
  const std::vector<Species> species = {
      {BodyKind::compliant, "soft", 0.37}, {BodyKind::rigid, "hard", 0.33}, {BodyKind::compliant, "tough", 0.3}};
  for (int count = 4; count < 12; ++count) {  // of fewer, a share is less than one grain
    const Model model = build_model(mixed_scene(count, 1, species));
    const int soft = count_of(model, BodyKind::compliant, "soft"), hard = count_of(model, BodyKind::rigid, "hard");
    const int tough = count_of(model, BodyKind::compliant, "tough");
    EXPECT_EQ(soft + hard + tough, count);
    EXPECT_LT(std::abs(soft - 0.37 * count), 1);
    EXPECT_LT(std::abs(hard - 0.33 * count), 1);
    EXPECT_LT(std::abs(tough - 0.3 * count), 1);
  }
}

// EXACT: mass and inertia of a regular polygon of n corners and radius R: area n/2 R^2 sin(2 pi/n),
// polar moment area R^2/6 (2 + cos(2 pi/n)); its area is that of the circle.
TEST(BuildModel, RigidMassAndInertia) {
  for (const int n : {6, 24, 1000}) {
    Scene scene = bare_scene();
    scene.contacts = {frictionless(1)};
    scene.materials[1].density = 2.5;
    add_body(scene, polygonal_disc("disc", 3, n), BodyKind::rigid, {1, 2}, 0.3);
    const Model model = build_model(scene);
    const double turn = 2 * M_PI / n, R2 = 1.5 * 1.5 * turn / std::sin(turn), mass = 2.5 * M_PI * 1.5 * 1.5;
    const RigidBody& rigid = model.rigid_bodies.at(0);
    EXPECT_NEAR(rigid.dof[0].mass / mass, 1, 1e-13);
    EXPECT_NEAR(rigid.dof[1].mass / mass, 1, 1e-13);
    EXPECT_NEAR(rigid.dof[2].mass / (mass * R2 / 6 * (2 + std::cos(turn))), 1, 1e-13);
    for (const RigidDof& dof : rigid.dof) EXPECT_NEAR(dof.mass * dof.inverse_mass, 1, 1e-15);
    EXPECT_NEAR(model.bodies[0].mass / mass, 1, 1e-13);
    EXPECT_NEAR(model.bodies[0].area / (M_PI * 1.5 * 1.5), 1, 1e-13);
    EXPECT_NEAR(rigid.max_radius, std::sqrt(R2), 1e-13);
  }
}

// EXACT: an excentric polygon turns about its centroid: a right-angled triangle a, b has A = ab/2, Ip = A (a^2 +
// b^2)/18.
TEST(BuildModel, PolygonTurnsAboutItsCentroid) {
  Scene scene = bare_scene();
  scene.contacts = {frictionless(1)};
  add_body(scene, outline_shape("triangle", {{0, 0}, {3, 0}, {0, 2}}), BodyKind::rigid, {5, 5});
  const Model model = build_model(scene);
  EXPECT_NEAR(model.rigid_bodies[0].dof[0].mass, 3, 1e-14);
  EXPECT_NEAR(model.rigid_bodies[0].dof[2].mass, 3.0 * 13 / 18, 1e-14);
  EXPECT_LT((model.outlines[0].points[0] - Vec2(-1, -2.0 / 3)).norm(), 1e-15);
}

// EXACT: lanes, groups and indices point at each other; copies of one shape share one table, each form of law has its
// own group.
TEST(BuildModel, BatchesAndBodiesAgree) {
  const std::vector<Species> species = {{BodyKind::compliant, "soft", 0.3},
                                        {BodyKind::rigid, "hard", 0.2},
                                        {BodyKind::compliant, "tough", 0.3},
                                        {BodyKind::compliant, "other", 0.2}};
  const Model model = build_model(mixed_scene(10, 4, species));
  EXPECT_EQ(model.shapes.size(), 1U);
  EXPECT_EQ(model.groups.size(), 2U);  // neo-Hookean: soft and tough; MELODY's form: other
  EXPECT_EQ(model.outlines.size(), 2U);
  std::size_t compliant = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.kind == BodyKind::rigid) {
      EXPECT_EQ(model.rigid_bodies.at(body.rigid).body, static_cast<int>(b));
      EXPECT_EQ(body.batch, -1);
      continue;
    }
    ++compliant;
    const Batch& batch = model.batches.at(body.batch);
    ASSERT_LT(body.lane, batch.count);
    EXPECT_EQ(model.groups[batch.group].bodies[batch.first + body.lane], static_cast<int>(b));
    const Material& material = model.scene.materials[body.material];
    EXPECT_EQ(model.groups[batch.group].law, material.law);
    EXPECT_DOUBLE_EQ(batch.mu[body.lane], material.young / (2 * (1 + material.poisson)));
    EXPECT_EQ(batch.density[body.lane], material.density);
    EXPECT_EQ(Vec2(batch.centre_x[body.lane], batch.centre_y[body.lane]), body.centre);
    EXPECT_NEAR(body.mass, body.area * material.density, 1e-15);
  }
  EXPECT_EQ(compliant, 32U);
  EXPECT_EQ(model.dof_count(), 8 * 3 + 32 * 100);
  EXPECT_EQ(model.node_count(), 8 * 24 + 32 * 50);
}

// EXACT: a wall has the mass of its slab, no rotation, and a pressure positive towards the grains.
TEST(BuildModel, Walls) {
  Scene scene = bare_scene();
  scene.period = 4;
  scene.contacts = {frictionless(1)};
  scene.materials[1].density = 3;
  scene.shapes = {polygonal_disc("disc", 1, 24)};
  add_grain(scene, "disc", BodyKind::rigid, {1, 1});
  scene.walls = {flat_wall("floor", Wall::Solid::below, 0.5, 0.1), flat_wall("lid", Wall::Solid::above, 2, 0)};
  scene.walls[0].thickness = 0.7;
  scene.walls[1].y = {AxisCondition::Mode::pressure, {{0}, {5}}};
  const Model model = build_model(scene);
  ASSERT_EQ(model.bodies.size(), 3U);
  const RigidBody& floor = model.rigid_bodies[1];
  const RigidBody& lid = model.rigid_bodies[2];
  EXPECT_DOUBLE_EQ(model.bodies[1].mass, 3 * 4 * 0.7);
  EXPECT_EQ(floor.dof[0].inverse_mass, 0);
  EXPECT_EQ(floor.dof[2].inverse_mass, 0);
  EXPECT_EQ(lid.dof[2].inverse_mass, 0);
  EXPECT_DOUBLE_EQ(lid.dof[1].inverse_mass * 3 * 4, 1);
  EXPECT_EQ(lid.dof[1].force_scale, -4);
  EXPECT_EQ(model.outlines[floor.outline].turn_shift, -4);
  EXPECT_EQ(model.outlines[lid.outline].turn_shift, 4);
  // Left open, the wall's spacing is the grains' finest.
  EXPECT_NEAR(model.outlines[lid.outline].spacing, model.outlines[model.bodies[0].outline].spacing, 0.1 * 0.13);
  EXPECT_LE(model.outlines[lid.outline].spacing, model.outlines[model.bodies[0].outline].spacing);
  EXPECT_NEAR(model.outlines[lid.outline].spacing * model.outlines[lid.outline].count, 4, 1e-14);
  // One grain a million times smaller than the others would ask for walls of 3e7 nodes.
  EXPECT_THROW(build_model(scene, {.scales = {1e-6}}), InputError);
}

// EXACT: the initial velocity field of the scene at each node, v = uniform + rotation x r + gradient r, r from the
// body's own centre.
TEST(InitialState, VelocityFields) {
  Scene scene = mixed_scene(3, 1, {{BodyKind::compliant, "soft", 0.67}, {BodyKind::rigid, "hard", 0.33}});
  InitialVelocity& field = scene.grains[0].velocity;
  field.uniform = {0.5, -1};
  field.rotation = 2;
  field.gradient << 0.1, 0.2, 0.3, -0.4;
  const Model model = build_model(scene);
  const Dofs q = initial_positions(model), v = initial_velocities(model, q);
  const Batch& batch = model.batches[0];
  for (std::size_t i = 0; i < q.compliant.size(); i += 2)
    for (int lane = 0; lane < batch.count; ++lane) {
      const double x = q.compliant[i][lane], y = q.compliant[i + 1][lane];
      EXPECT_NEAR(v.compliant[i][lane], 0.5 - 2 * y + 0.1 * x + 0.2 * y, 1e-14);
      EXPECT_NEAR(v.compliant[i + 1][lane], -1 + 2 * x + 0.3 * x - 0.4 * y, 1e-14);
    }
  EXPECT_EQ(v.rigid, (std::vector<double>{0.5, -1, 2}));
}

// EXACT: bodies carry the shapes and sizes of their packing, in any kind of body; shapes fitted to cells join the
// scene's.
TEST(BuildModel, PackingsGiveShapesAndSizes) {
  Scene scene = mixed_scene(10, 4, {{BodyKind::compliant, "soft", 0.5}, {BodyKind::rigid, "hard", 0.5}});
  scene.shapes.push_back(polygonal_disc("large", 1.2, 20, 50));
  Grains& grains = scene.grains[0];
  grains.shape.clear();
  grains.shapes = {{"disc", 0.25}, {"large", 0.75}};
  grains.size.factors = {0.5, 2};
  grains.size.shares = {0.5, 0.5};
  const Model model = build_model(scene);
  const auto count = [&](auto&& holds) { return std::count_if(model.bodies.begin(), model.bodies.end(), holds); };
  EXPECT_EQ(count([](const Body& b) { return b.shape == 0; }), 10);
  EXPECT_EQ(count([](const Body& b) { return b.shape == 1; }), 30);
  EXPECT_EQ(count([](const Body& b) { return b.scale == 0.5; }), 20);
  EXPECT_EQ(count([](const Body& b) { return b.scale == 2; }), 20);
  EXPECT_GT(count([](const Body& b) { return b.shape == 0 && b.scale == 2 && b.kind == BodyKind::rigid; }), 0);
  for (const Body& b : model.bodies)
    EXPECT_EQ(model.outlines[b.outline].count, b.shape == 0 ? 24 : 20) << "each body shows the outline of its shape";
}

}  // namespace
}  // namespace pliant
