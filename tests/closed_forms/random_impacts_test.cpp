// Rigid bodies of all kinds of corners meet at random, frictionless: contact as an integral keeps their energy.
#include <gtest/gtest.h>

#include <cmath>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr double face_stiffness = 1e5;

Points random_shape(Random& random) {
  const double wide = std::tan(random.uniform(5, 15) * M_PI / 180);
  switch (random.below(4)) {
    case 0:
      return rectangle(1, 1, 0.25);
    case 1:
      return refined({{-wide, 0.7}, {0, -0.3}, {wide, 0.7}}, 0.2);
    case 2:
      return refined(regular(8, 0.6, 0), 0.16);
    default:
      return regular(48, 0.5, 0);
  }
}

Scene random_impact(Random& random, double safety, bool corrects) {
  Scene scene = bare_scene();
  scene.contact.quadrature = ContactQuadrature::segments;
  scene.contact.energy_consistent = corrects;
  scene.contacts = {frictionless(face_stiffness)};
  scene.time.safety = safety;
  scene.time.end = 100;
  for (int body = 0; body < 2; ++body) {
    const Points shape = random_shape(random);
    const double angle = random.uniform(0, 2 * M_PI), spin = random.uniform(-0.3, 0.3);
    add_body(scene, outline_shape("body", shape), BodyKind::rigid, {0, 0}, angle);
    scene.grains[body].velocity = moving({0, 0}, spin);
  }
  const double direction = random.uniform(0, 2 * M_PI), aside = random.uniform(-0.4, 0.4);
  const Vec2 d(std::cos(direction), std::sin(direction));
  scene.grains[1].packing.positions = {2 * d + aside * Vec2(-d.y(), d.x())};
  scene.grains[1].velocity.uniform = -random.uniform(0.5, 2) * d;
  return scene;
}

double kinetic_energy(const Simulation& simulation) {
  double energy = 0;
  for (std::size_t r = 0; r < simulation.model().rigid_bodies.size(); ++r)
    for (std::size_t c = 0; c < 3; ++c)
      energy += 0.5 * simulation.model().rigid_bodies[r].dof[c].mass *
                std::pow(simulation.state().reduced_momentum.rigid[3 * r + c], 2);
  return energy;
}

/// Change of the energy in an impact, over all of it; 0: they missed each other.
double change_of_energy(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  const double before = kinetic_energy(simulation);
  constexpr int long_parted = 30;  // steps
  bool touched = false;
  for (int parted = 0; simulation.state().time < 8 && parted < long_parted;) {
    simulation.step(100);
    const bool touches = simulation.state().contact_energy > 0;
    touched |= touches;
    parted = touched && !touches ? parted + 1 : 0;
  }
  return touched ? (kinetic_energy(simulation) + simulation.state().contact_energy) / before - 1 : 0;
}

double root_mean_square(double safety, bool corrects) {
  double sum = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const double change = change_of_energy(random_impact(random, safety, corrects));
    sum += change * change, count += change != 0;
  }
  return std::sqrt(sum / count);
}

/// INDEPENDENT: the bound that is promised at the defaults (docs/notes/quadrature.md).
TEST(RandomImpacts, keep_their_energy) { EXPECT_LT(root_mean_square(0.8, true), 1e-3); }

/// RATE: forces have an energy and are continuous, so that half the step leaves a quarter of the error of velocity
/// Verlet, which is where contacts begin and end.
TEST(RandomImpacts, err_by_the_square_of_the_step) {
  EXPECT_LT(root_mean_square(0.4, false), 0.4 * root_mean_square(0.8, false));
}

}  // namespace
}  // namespace pliant::dynamics_tests
