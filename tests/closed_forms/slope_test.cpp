// Blocks on slopes, rigid and compliant, from any start on floors of any nodes: Coulomb's law in slip and in stick.
// Gravity is turned, not the floor. Units: the block's width, its density and gravity are 1; it is 1 x 0.5.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double friction = 0.3, slope_stiffness = 1e4, young = 2000, poisson = 0.4, mass = 0.5, height = 0.5;

struct Block {
  int segments;    ///< on its face
  double spacing;  ///< of the floor's nodes
  double place;    ///< of its centre at the start
  bool compliant;
};

/// Calls check(block) for blocks and floors of every kind, whose nodes are aligned or not.
template <class Check>
void for_blocks(Check&& check) {
  for (const int segments : {4, 6, 8, 16})
    for (const double spacing : {0.25, 1.0 / 16, 0.11})
      for (const double place : {1.0, 1.0437})
        for (const bool compliant : {false, true}) {
          SCOPED_TRACE(fmt::format("{} segments, floor of {}, from {}, {}", segments, spacing, place,
                                   compliant ? "compliant" : "rigid"));
          check(Block{segments, spacing, place, compliant});
        }
}

/// In touch with the floor, without weight at the start; compliant blocks lose what they ring with.
Scene on_a_slope(const Block& block, double speed, const History& down, const History& press) {
  Scene scene = on_a_floor(down.time.back(), 4, block.spacing, {down.value[0], press.value[0]});
  scene.gravity_history = {down, press};
  scene.materials[0].young = young;
  scene.materials[0].poisson = poisson;
  scene.materials[0].viscosity = 3e-4 * young;
  scene.shapes = {box_shape("block", 1, height, 1.0 / block.segments)};
  if (block.compliant) scene.shapes[0].nodes = block.segments * block.segments + 14;
  scene.grains = {grains("block", "block", block.compliant ? BodyKind::compliant : BodyKind::rigid,
                         {{block.place, height / 2}}, moving({speed, 0}))};
  scene.contacts = {mohr_coulomb(slope_stiffness, friction)};
  scene.contact.energy_consistent = false;  // forces of the correction after contact have no friction
  return scene;
}

/// A block in motion, by its centre of mass.
struct Slider {
  Model model;
  Simulation simulation{model};
  double longest_step = 0;

  explicit Slider(const Scene& scene) : model(build_model(scene)) {}
  Vec2 velocity() const { return mean_of(simulation.state().reduced_momentum); }
  double way() const { return mean_of(simulation.state().position).x() - start_; }
  void advance(double until) {
    while (simulation.state().time < until) longest_step = std::max(longest_step, simulation.step(until).dt);
  }

 private:
  Vec2 mean_of(const Dofs& dofs) const {
    const Body& body = model.bodies[0];
    return body.rigid < 0 ? mass_mean(model, body, dofs) : Vec2(rigid(dofs, 0).head<2>());
  }
  double start_ = mean_of(simulation.state().position).x();
};

/// EXACT: while all of it slips, friction is mu times the normal force, whatever that is, so u + mu v grows as if
/// pressed by gravity, by
/// (sin - mu cos) times 3/4 s of it. A node that comes under the block rubs from its second step on, when it has come
/// in by v dt at most and stands for 7/2 (v dt / s)^2 of its segment s: missing is 7/4 v dt (v dt / s)^2 / L of the
/// friction. Half of the pressure acts on the block's own face, which is tilted by less than twice the depth over its
/// length, or an end would lift.
TEST(BlockOnASlope, slips_as_coulomb_says) {
  const double slope = std::numbers::pi / 6, speed = 0.5;
  const History down{{0, 0.5, 1}, {0, std::sin(slope), std::sin(slope)}};
  const History press{{0, 0.5, 1}, {0, -std::cos(slope), -std::cos(slope)}};
  for_blocks([&](const Block& block) {
    Slider slider(on_a_slope(block, speed, down, press));
    slider.advance(1);
    const double pressed = 0.75 * std::cos(slope), depth = mass * std::cos(slope) / slope_stiffness;
    const double step = slider.velocity().x() * slider.longest_step, entering = step / block.spacing;
    EXPECT_NEAR(slider.velocity().x() + friction * slider.velocity().y(),
                speed + 0.75 * std::sin(slope) - friction * pressed,
                friction * pressed * 1.75 * step * entering * entering + 0.5 * pressed * 2 * depth);
  });
}

/// INDEPENDENT, estimates as bounds: pressed first, then pulled along a slope that is too flat, it stays where its
/// springs carry it: m g sin (1 / (kt L) + 3 h^2 / (kn L^3)) for shear and tilt of its contact; a compliant block leans
/// by m g sin (h / (3 G L) + 3 h^3 / (5 E' L^3)) more, as a column does. Few nodes stand for the face, which makes it
/// twice as stiff against tilt or half; what corners give way is half of all that at most. Pulled no more, it comes
/// back, but for half of the tilt.
TEST(BlockOnASlope, sticks_as_coulomb_says) {
  const double slope = 10 * std::numbers::pi / 180, pull = mass * std::sin(slope);
  const double shear = pull / slope_stiffness, tilt = pull * 3 * height * height / slope_stiffness;
  const double lean = pull * (height * 2 * (1 + poisson) / (3 * young) +
                              3 * std::pow(height, 3) * (1 - poisson * poisson) / (5 * young));
  const History down{{0, 0.5, 1, 1.5, 2, 2.5}, {0, 0, std::sin(slope), std::sin(slope), 0, 0}};
  const History press{{0, 0.5}, {0, -std::cos(slope)}};
  for_blocks([&](const Block& block) {
    Slider slider(on_a_slope(block, 0, down, press));
    const double least = shear + 0.5 * tilt + (block.compliant ? lean : 0);
    const double most = shear + 2 * tilt + (block.compliant ? lean + 0.5 * (shear + tilt + lean) : 0);
    slider.advance(1);
    for (const double time : {1.1, 1.2, 1.3, 1.4, 1.5}) {
      slider.advance(time);
      EXPECT_GT(slider.way(), least);
      EXPECT_LT(slider.way(), most);
    }
    slider.advance(2.5);
    EXPECT_LT(std::abs(slider.way()), 0.5 * tilt);
  });
}

}  // namespace
}  // namespace pliant::dynamics_tests
