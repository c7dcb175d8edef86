#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "bodies/initial_state.hpp"
#include "bodies/reciprocal_mass.hpp"
#include "dynamics/time_step_bound.hpp"
#include "support/bench.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;

// One degree of freedom that can move: where it is stored, and its mass.
struct FreeDof {
  bool rigid;
  std::size_t index;
  int lane;
  double mass;
};

std::vector<FreeDof> free_dofs(const Model& model) {
  std::vector<FreeDof> dofs;
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c)
      if (!model.rigid_bodies[r].dof[c].imposed())
        dofs.push_back({true, 3 * r + c, 0, model.rigid_bodies[r].dof[c].mass});
  for (const Batch& batch : model.batches)
    for (int lane = 0; lane < batch.count; ++lane)
      for (std::size_t i = 0; i < 2U * model.shape_of(batch).nodes(); ++i)
        dofs.push_back({false, batch.offset + i, lane,
                        batch.density[lane] * model.shape_of(batch).space.mass_at_unit_density[i / 2]});
  return dofs;
}

double get(const Dofs& q, const FreeDof& d) { return d.rigid ? q.rigid[d.index] : q.compliant[d.index][d.lane]; }
void add(Dofs& q, const FreeDof& d, double by) {
  if (d.rigid)
    q.rigid[d.index] += by;
  else
    q.compliant[d.index][d.lane] += by;
}

// A model at rest in touch, and its forces.
struct Loaded : dynamics_tests::Bench {
  Trial trial;

  explicit Loaded(const Scene& scene) : Bench(scene), trial(model) {}
  void evaluate() { Bench::evaluate(trial); }
};

// Velocities by unit momenta, [dofs x dofs].
Eigen::MatrixXd inverse_mass(const Model& model, const std::vector<FreeDof>& dofs) {
  const auto n = static_cast<Eigen::Index>(dofs.size());
  Eigen::MatrixXd inverse(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    Dofs momentum = zero_dofs(model);
    add(momentum, dofs[j], 1 / dofs[j].mass);
    const Dofs velocity = material_velocity(model, momentum);
    for (Eigen::Index i = 0; i < n; ++i) inverse(i, j) = get(velocity, dofs[i]);
  }
  return 0.5 * (inverse + inverse.transpose());
}

// Largest eigenvalue of W K, K = -df/dq of all forces by central differences: w^2 of the fastest motion.
double fastest(Loaded& loaded) {
  const std::vector<FreeDof> dofs = free_dofs(loaded.model);
  const Eigen::Index n = static_cast<Eigen::Index>(dofs.size());
  constexpr double step = 1e-7;
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(n);
    for (const double sign : {1.0, -1.0}) {
      add(loaded.state.position, dofs[j], sign * step);
      loaded.evaluate();
      for (Eigen::Index i = 0; i < n; ++i) column[i] -= sign * get(loaded.trial.force, dofs[i]) / (2 * step);
      add(loaded.state.position, dofs[j], -sign * step);
    }
    K.col(j) = column;
  }
  const Eigen::MatrixXd root = inverse_mass(loaded.model, dofs).llt().matrixL();
  const Eigen::MatrixXd symmetric = root.transpose() * (0.5 * (K + K.transpose())) * root;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[n - 1];
}

// w^2 that the bound stands for: dt = safety x 2/w.
double bound_of(Loaded& loaded) {
  TimeStepBound bound(loaded.model, loaded.forces.contact().laws());
  bound.update_internal(loaded.state.position, loaded.state.memory);
  bound.update_contact(loaded.forces.contact(), loaded.forces.bonds());
  const double w = loaded.model.scene.time.safety * 2 / bound.largest_dt();
  return w * w;
}

const ContactRule bounded_rules[] = {frictionless(300), mohr_coulomb(300, 0.5, 1), cohesive(300, 1, 0.02, 5)};

// How loose a bound may be: 2 for neighbours that the fastest motion does not move against each other, and half as much
// again for nodes within the skin that are not in touch yet.
constexpr double loosest = 3;
// Where nothing rubs, discs turn freely; the bound has springs along the faces too, with them turning is the fastest,
// twice as fast in w^2 as moving aside, and half as much again is for springs along that way.
constexpr double loosest_where_discs_turn = 3 * loosest;

// A face of 11 segments between corners: either of its end nodes may come to stand for its other half too, and for half
// as much again of the next one's.
constexpr double loosest_between_corners = 13.0 / 11 * loosest;

// EXACT: an upper bound, and not a useless one.
void expect_bounded(const Scene& scene, const std::string& name, double times = loosest) {
  Loaded loaded(scene);
  const double exact = fastest(loaded), bound = bound_of(loaded);
  EXPECT_LE(exact, bound) << name;
  EXPECT_GT(exact, bound / times) << name;
}

// w^2 of a rigid disc in touch all around, turning, with springs along its face: k sum l r^2 / I; the largest of all.
double touched_all_around(const Model& model, double stiffness) {
  double largest = 0;
  for (const Body& body : model.bodies) {
    const OutlineShape& outline = model.outlines[body.outline];
    double turning = 0;
    for (int k = 0; k < outline.count; ++k) turning += outline.tributary_length[k] * outline.points[k].squaredNorm();
    largest = std::max(largest, stiffness * turning / model.rigid_bodies[body.rigid].dof[2].mass);
  }
  return largest;
}

// EXACT: two discs in touch at a few nodes have the bound's floor, which stands for contact all around.
void expect_the_floor(const Scene& scene, double stiffness) {
  Loaded loaded(scene);
  const double bound = bound_of(loaded);
  EXPECT_LE(fastest(loaded), bound);
  EXPECT_NEAR(bound / touched_all_around(loaded.model, stiffness), 1, 1e-12);
}

TEST(StiffnessBound, RigidBodies) {
  for (const ContactRule& rule : bounded_rules)
    for (const double y : {0.0, 0.7}) {
      Scene scene = bare_scene();
      scene.contacts = {rule};
      add_body(scene, polygonal_disc("disc", 2, 40), BodyKind::rigid, {0, 0});
      add_body(scene, polygonal_disc("disc", 1, 24), BodyKind::rigid, {std::sqrt(1.47 * 1.47 - y * y), y}, 0.1);
      expect_the_floor(scene, 300);
      Scene blocks = bare_scene();
      blocks.contacts = {rule};
      add_body(blocks, outline_shape("block", rectangle(2, 1, 0.11)), BodyKind::rigid, {0, 0});
      add_body(blocks, outline_shape("plank", rectangle(1.03, 0.2, 0.1)), BodyKind::rigid, {y, 0.59});
      expect_bounded(blocks, "blocks", loosest_between_corners);
    }
}

TEST(StiffnessBound, BlockBetweenWalls) {
  for (const ContactRule& rule : bounded_rules) {
    Scene scene = bare_scene();
    scene.period = 3;
    scene.contacts = {rule};
    add_body(scene, outline_shape("block", rectangle(1.03, 0.5, 0.1)), BodyKind::rigid, {0.5, 0.24});
    scene.walls = {flat_wall("floor", Wall::Solid::below, 0, 0.1), free_wall("lid", Wall::Solid::above, 0.48, 0.1)};
    expect_bounded(scene, "block");
  }
}

TEST(StiffnessBound, CompliantAndRigidBodies) {
  for (const ContactRule& rule : bounded_rules)
    for (const bool both : {false, true}) {
      Scene scene = bare_scene();
      scene.contacts = {rule};
      add_body(scene, polygonal_disc("disc", 2, 36, 90), BodyKind::compliant, {0, 0});
      add_body(scene, polygonal_disc("disc", 1.6, 30, 70), both ? BodyKind::compliant : BodyKind::rigid, {1.76, 0.1},
               0.1);
      expect_bounded(scene, both ? "compliant" : "mixed");
    }
}

// Outline nodes share their accelerations with inner ones.
TEST(StiffnessBound, MassScaling) {
  for (const ContactRule& rule : bounded_rules) {
    Scene scene = bare_scene();
    scene.contacts = {rule};
    scene.discretisation.mass_scaling = 3;
    add_body(scene, polygonal_disc("disc", 2, 36, 90), BodyKind::compliant, {0, 0});
    add_body(scene, polygonal_disc("disc", 1.6, 30, 70), BodyKind::compliant, {1.76, 0.1}, 0.1);
    expect_bounded(scene, "scaled mass");
  }
}

// A cluster squeezed from all sides: every disc has six partners.
TEST(StiffnessBound, Cluster) {
  for (const ContactRule& rule : bounded_rules) {
    Scene scene = bare_scene();
    scene.contacts = {rule};
    scene.shapes = {polygonal_disc("disc", 1, 36)};
    add_grain(scene, "disc", BodyKind::rigid, {0, 0}, 0.05);
    for (int i = 0; i < 6; ++i)
      add_grain(scene, "disc", BodyKind::rigid, 0.975 * Vec2(std::cos(i * M_PI / 3), std::sin(i * M_PI / 3)), 0.3 * i);
    expect_bounded(scene, "cluster", rule.law == ContactLawKind::frictionless ? loosest_where_discs_turn : loosest);
  }
}

// Neighbours that move against each other: twice the stiffness that each alone would see.
TEST(StiffnessBound, StackOfPlates) {
  for (const ContactRule& rule : bounded_rules) {
    Scene scene = bare_scene();
    scene.contacts = {rule};
    scene.shapes = {outline_shape("plate", rectangle(2, 0.2, 0.1))};
    for (int i = 0; i < 6; ++i) add_grain(scene, "plate", BodyKind::rigid, {0.011 * i, 0.195 * i});
    expect_bounded(scene, "plates");
  }
}

// EXACT: it holds until the next refresh, wherever bodies go within the skin.
TEST(StiffnessBound, HoldsUntilTheNextRefresh) {
  Random random(5);
  for (const ContactRule& rule : bounded_rules)
    for (int sample = 0; sample < 10; ++sample) {
      Scene scene = bare_scene();
      scene.contacts = {rule};
      add_body(scene, outline_shape("block", rectangle(2, 1, 0.11)), BodyKind::rigid, {0, 0});
      add_body(scene, polygonal_disc("disc", 1, 24), BodyKind::rigid, {random.uniform(-0.8, 0.8), 1.01},
               random.uniform(0, 1));
      Loaded loaded(scene);
      const double bound = bound_of(loaded);
      for (int step = 0; step < 5; ++step) {
        loaded.state.position.rigid[3] += random.uniform(-0.01, 0.01);
        loaded.state.position.rigid[4] -= random.uniform(0, 0.008);
        loaded.evaluate();
        std::swap(loaded.state.memory, loaded.trial.memory);
      }
      EXPECT_EQ(loaded.forces.contact().refreshes(), 1);
      EXPECT_LE(fastest(loaded), bound);
    }
}

// EXACT: a corner of a heavy block in the tip of a light soft bar. The bound takes all that lies within a skin for in
// touch, while a corner touches over its own depth: it is loose by so much.
TEST(StiffnessBound, CornerInASoftCorner) {
  Random random(11);
  double closest = 0;
  for (int sample = 0; sample < 60; ++sample) {
    Scene scene = bare_scene();
    scene.contacts = {bounded_rules[sample % 3]};
    scene.contacts[0].stiffness = 3e4;
    add_body(scene, outline_shape("bar", rectangle(0.6, 0.3, 0.1), 28), BodyKind::compliant, {0, 0});
    const double turn = random.uniform(-0.7, 0.7);
    const Vec2 inside{random.uniform(0.001, 0.02), random.uniform(0.001, 0.02)};
    const Vec2 corner = Vec2(0.3, 0.15) - inside;
    const Vec2 centre = corner + Eigen::Rotation2D(turn) * Vec2(0.5, 0.5);
    add_body(scene, outline_shape("block", rectangle(1, 1, 1)), BodyKind::rigid, centre, turn);
    Loaded loaded(scene);
    const double exact = fastest(loaded), bound = bound_of(loaded);
    EXPECT_LE(exact, bound) << sample;
    closest = std::max(closest, exact / bound);
  }
  EXPECT_GT(closest, 0.1);
}

}  // namespace
}  // namespace pliant
