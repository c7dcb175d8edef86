// The same motion seen from elsewhere takes the same steps: bodies listed in another order, all of it in uniform
// motion, all of it turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "setup/build_model.hpp"
#include "support/random.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr int columns = 5, rows = 4;

/// How a scene is told.
struct Telling {
  std::vector<int> order;  ///< of the grains; empty: as they are
  Vec2 drift{0, 0};        ///< m/s
  double turn = 0;         ///< about the origin, rad

  Vec2 turned(Vec2 x) const { return Eigen::Rotation2Dd(turn) * x; }
};

/// What the cloud is made of.
enum class Grit { viscous, undamped };

/// A cloud of compliant and rigid grains of two sizes that falls in upon itself with gravity aside. Undamped bodies
/// correct energy: the cloud lasts over two corrections.
Scene cloud(const Telling& telling, Grit grit) {
  testing::Random random(4);
  const bool viscous = grit == Grit::viscous;
  Scene scene = empty_scene(viscous ? 5 : 10);
  scene.gravity = telling.turned({0, -0.02});
  scene.materials[0].viscosity = viscous ? 0.002 : 0;
  scene.shapes = {disc_shape("disc", 1, 60), disc_shape("small", 0.9, 40)};
  std::vector<Grains> all;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const Vec2 at{1.03 * i + 0.2 * (j % 2) + random.uniform(0, 0.03), 1.01 * j + random.uniform(0, 0.02)};
      const Vec2 inward = -0.05 * Vec2(i - 0.5 * (columns - 1), j - 0.5 * (rows - 1));
      const Vec2 velocity = inward + Vec2{random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02)};
      const std::string name = "g" + std::to_string(all.size());
      all.push_back(grains(name, i % 2 == 0 ? "disc" : "small",
                           (i + j) % 2 == 0 ? BodyKind::compliant : BodyKind::rigid, {telling.turned(at)},
                           moving(telling.turned(velocity) + telling.drift)));
      all.back().angle = random.uniform(0, 6) + telling.turn;
    }
  if (telling.order.empty()) scene.grains = all;
  for (const int i : telling.order) scene.grains.push_back(all[static_cast<std::size_t>(i)]);
  scene.contacts = {viscous ? contact_rule(ContactLawKind::mohr_coulomb, 0, 0.3)
                            : contact_rule(ContactLawKind::cohesive, 0)};
  scene.contacts[0].stiffness.reset();
  if (!viscous) scene.contacts[0].strength = 0.02;
  return scene;
}

struct End {
  std::int64_t steps = 0, rejections = 0;
  long refreshes = 0;
  int contacts = 0;
  std::vector<Points> outlines;  ///< of the grains in their own order, back where the plain telling has them
};

End run_as_told(const Telling& telling, Integrator integrator, Grit grit = Grit::viscous) {
  Scene scene = cloud(telling, grit);
  scene.time.integrator = integrator;
  const Model model = build_model(scene);
  Simulation simulation(model);
  End end;
  while (simulation.state().time < scene.time.end)
    end.contacts = std::max(end.contacts, simulation.step(scene.time.end).evaluation.contact.contacts);
  end.steps = simulation.state().steps, end.rejections = simulation.state().rejections;
  end.refreshes = simulation.forces().contact().refreshes();
  end.outlines.resize(model.bodies.size());
  const Telling back{{}, {0, 0}, -telling.turn};
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (int i = model.outline_offset[b]; i < model.outline_end(b); ++i)
      end.outlines[telling.order.empty() ? b : static_cast<std::size_t>(telling.order[b])].push_back(
          back.turned(simulation.state().outlines.position.at(i) - scene.time.end * telling.drift));
  return end;
}

double largest_distance_of_ends(const End& a, const End& b) {
  double largest = 0;
  for (std::size_t body = 0; body < a.outlines.size(); ++body)
    for (std::size_t i = 0; i < a.outlines[body].size(); ++i)
      largest = std::max(largest, (a.outlines[body][i] - b.outlines[body][i]).norm());
  return largest;
}

/// Each step rounds positions as far out as `reach` by 2^-52 of it at most; and the step's bound comes from finite
/// differences over 1e-6 of the nodal distance, 0.1, which rounding of positions within a body changes by 1e-9, and so
/// the steps, and the integration's error of less than 1e-3, by 1e-12. The energy error of pairs is a force times the
/// way of a step: rounded positions are removed by pressures as far off as the gap's way goes into the depth, and
/// touches last some 20 steps.
double tolerance(const End& end, double reach) {
  constexpr double depth_over_way = 10;
  return static_cast<double>(end.steps) * depth_over_way * reach * std::numeric_limits<double>::epsilon() + 1e-12;
}

class Invariance : public ::testing::TestWithParam<Integrator> {};

TEST_P(Invariance, same_steps_and_motion) {
  const End plain = run_as_told({}, GetParam());
  EXPECT_GT(plain.contacts, 20);
  Telling permuted, moving{{}, {500, -490}}, turned{{}, {0, 0}, M_PI / 2}, askew{{}, {0, 0}, 0.65},
      all{{}, {0, 700}, -2.2};
  permuted.order.resize(columns * rows);
  std::iota(permuted.order.begin(), permuted.order.end(), 0);
  testing::Random random(9);
  for (int i = columns * rows - 1; i > 0; --i) std::swap(permuted.order[i], permuted.order[random.below(i + 1)]);
  all.order = permuted.order;
  const std::pair<const char*, Telling> tellings[] = {
      {"permuted", permuted}, {"moving", moving}, {"turned", turned}, {"askew", askew}, {"all", all}};
  for (const auto& [name, telling] : tellings) {
    SCOPED_TRACE(name);
    const End end = run_as_told(telling, GetParam());
    EXPECT_EQ(end.steps, plain.steps) << "EXACT";
    EXPECT_EQ(end.rejections, plain.rejections) << "EXACT";
    EXPECT_EQ(end.refreshes, plain.refreshes) << "EXACT";
    const double bound = tolerance(plain, 10 + 5 * telling.drift.norm()),
                 difference = largest_distance_of_ends(end, plain);
    EXPECT_LT(difference, bound) << "EXACT: rounding";
    RecordProperty(name, std::to_string(difference / bound));
  }
}

/// EXACT: the energy correction of undamped bodies does not depend on the observer. Rounded positions are a share of
/// 1e-12 of what vibrates.
TEST(Invariance, undamped_bodies_are_corrected_equally) {
  const End plain = run_as_told({}, Integrator::verlet, Grit::undamped);
  EXPECT_GT(plain.steps, 400) << "the balance has started, and was corrected";
  for (const Telling& telling : {Telling{{}, {5, -4.9}}, Telling{{}, {0, 0}, 0.65}, Telling{{}, {-500, 70}, 2.2}}) {
    SCOPED_TRACE(telling.drift.x());
    const End end = run_as_told(telling, Integrator::verlet, Grit::undamped);
    EXPECT_EQ(end.steps, plain.steps) << "EXACT";
    EXPECT_EQ(end.refreshes, plain.refreshes) << "EXACT";
    EXPECT_LT(largest_distance_of_ends(end, plain), tolerance(plain, 10 + 10 * telling.drift.norm()))
        << "EXACT: rounding";
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Invariance, ::testing::Values(Integrator::verlet, Integrator::step_doubling));

/// EXACT: a periodic layer and its walls, all in motion along the period.
TEST(Invariance, a_moving_layer_takes_the_same_steps) {
  const auto run = [](double drift) {
    Scene scene = small_third_body(1);
    scene.grains[0].velocity.uniform.x() = drift;
    for (Wall& wall : scene.walls) wall.x = {AxisCondition::Mode::velocity, {{0}, {drift}}};
    const Model model = build_model(scene);
    Simulation simulation(model);
    advance(simulation, 1);
    return simulation.state();
  };
  const State plain = run(0), moved = run(700);
  EXPECT_EQ(moved.steps, plain.steps);
  EXPECT_EQ(moved.rejections, plain.rejections);
}

}  // namespace
}  // namespace pliant::dynamics_tests
