// The stability bound along whole runs, against the largest w^2 of all forces by dense eigenvalues (docs/method.md 6).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "dynamics/true_spectrum.hpp"
#include "dynamics/verlet.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr int samples = 20;

struct NamedScene {
  const char* name;
  Scene scene;
};

/// Stiffness of contacts as by default: 8 E / h, E = 2.8, of discs of radius 1 with so many outline nodes.
double automatic_stiffness(int outline_nodes) { return 8 * 2.8 / (2 * std::sin(M_PI / outline_nodes)); }

Scene two_bodies(const Vec2& second, const Vec2& velocity, const ContactRule& contact, double end) {
  Scene scene = free_disc(40, end);
  scene.grains.push_back(grains("other", "disc", BodyKind::compliant, {second}, moving(velocity)));
  scene.contacts = {contact};
  return scene;
}

/// A disc pressed flat, to two fifths of its height.
Scene compression() {
  Scene scene = free_disc(40, 14);
  scene.period = 8;
  scene.walls = {flat_wall("lower", Wall::Solid::below, -1, 0.25), flat_wall("upper", Wall::Solid::above, 1.01, 0.25)};
  scene.walls[1].y = {AxisCondition::Mode::velocity, {{0, 1, 14}, {0, -0.09, -0.09}}};
  scene.contacts = {frictionless(automatic_stiffness(24))};
  return scene;
}

/// A disc a thousand times as stiff comes fast onto a soft one, off its middle.
Scene sudden_contact() {
  Scene scene = two_bodies({2.05, 0.3}, {-0.5, 0}, mohr_coulomb(automatic_stiffness(24), 0.3), 2);
  scene.materials.push_back(elastic());
  scene.materials.back().name = "stiff";
  scene.materials.back().young *= 1000;
  scene.grains[1].species[0].material = "stiff";
  return scene;
}

/// Discs that have not touched yet come within the range of their cohesion.
Scene cohesion_sets_in() {
  const double stiffness = automatic_stiffness(24);
  return two_bodies({2.06, 0}, {-0.02, 0.01}, cohesive(stiffness, 0.3, 0.05, 0.3), 8);
}

/// A light compliant disc between rigid ones ten thousand times as dense, of which one falls on it.
Scene light_between_heavy() {
  Scene scene = free_disc(40, 12);
  scene.materials.push_back(rigid_material(1e4, "heavy"));
  scene.grains.push_back(grains("anvil", "disc", BodyKind::rigid, {{0, -2.02}}));
  scene.grains.push_back(grains("hammer", "disc", BodyKind::rigid, {{0.1, 2.03}}, moving({0, -0.03})));
  for (int i : {1, 2}) scene.grains[i].species[0].material = "heavy";
  scene.contacts = {mohr_coulomb(automatic_stiffness(24), 0.3)};
  return scene;
}

/// w^2 of all forces at a state; whatever touches sticks.
double true_square_frequency(const Scene& scene, const State& state) {
  Bench bench(scene);
  bench.state.position = state.position;
  bench.evaluate_here();
  return largest_square_frequency(bench, 1e-7);
}

class BoundOverRuns : public ::testing::TestWithParam<NamedScene> {};

// The step of a run at the default safety is that share of the bound, or less. INDEPENDENT: dense eigenvalues.
TEST_P(BoundOverRuns, lies_below_the_true_limit) {
  const Scene& scene = GetParam().scene;
  Bench bench(scene);
  Verlet verlet(bench.forces, bench.state);
  double nearest = 1e300, furthest = 0;
  for (int k = 1; k <= samples; ++k) {
    const double until = k * scene.time.end / samples;
    double dt = 0;
    while (bench.state.time < until) dt = take_step(verlet, bench.forces, bench.state, bench.control, until).dt;
    const double bound = verlet.bound().largest_dt() / scene.time.safety,
                 limit = 2 / std::sqrt(true_square_frequency(scene, bench.state));
    EXPECT_LE(bound, limit) << "INDEPENDENT, at " << until;
    nearest = std::min(nearest, limit / bound), furthest = std::max(furthest, limit / bound);
    fmt::print("{}: t {:.3g}, dt {:.4g}, bound {:.4g}, true limit {:.4g}\n", GetParam().name, until, dt, bound, limit);
  }
  fmt::print("{}: true limit over bound {:.3f} to {:.3f}\n", GetParam().name, nearest, furthest);
}

INSTANTIATE_TEST_SUITE_P(Scenes, BoundOverRuns,
                         ::testing::Values(NamedScene{"compression", compression()},
                                           NamedScene{"sudden_contact", sudden_contact()},
                                           NamedScene{"cohesion_sets_in", cohesion_sets_in()},
                                           NamedScene{"light_between_heavy", light_between_heavy()}),
                         [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace pliant::dynamics_tests
