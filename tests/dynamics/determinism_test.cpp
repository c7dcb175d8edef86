// The same bits for any number of threads, and twice (docs/design.md 5).
#include <gtest/gtest.h>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

class Determinism : public ::testing::TestWithParam<Integrator> {};

TEST_P(Determinism, same_bits_with_1_2_and_3_threads_and_twice) {
  Scene scene = small_third_body(2);
  scene.time.integrator = GetParam();
  const Model model = build_model(scene);
  const std::uint64_t one = hash_after(model, 1, 2);
  EXPECT_EQ(hash_after(model, 2, 2), one) << "EXACT: threads";
  EXPECT_EQ(hash_after(model, 3, 2), one) << "EXACT: threads";
  EXPECT_EQ(hash_after(model, 1, 2), one) << "EXACT: twice";
  EXPECT_EQ(hash_after(build_model(scene), 1, 2), one) << "EXACT: the model built anew";
}

TEST_P(Determinism, same_bits_with_damping_and_boundary_conditions) {
  Scene scene = small_third_body(2);
  scene.time.integrator = GetParam();
  for (Material& material : scene.materials) material.viscosity = 0.01, material.mass_damping = 0.1;
  scene.walls[1].y.damping = 0.2;
  scene.contact.energy_consistent = GetParam() == Integrator::verlet;
  BoundaryCondition pressure;
  pressure.kind = BoundaryCondition::Kind::pressure;
  pressure.grains = "layer";
  pressure.pressure = {{0}, {0.02}};
  pressure.window = {0.3, 1.5};
  scene.boundary = {pressure};
  const Model model = build_model(scene);
  const std::uint64_t one = hash_after(model, 1, 2);
  EXPECT_EQ(hash_after(model, 2, 2), one) << "EXACT: threads";
  EXPECT_EQ(hash_after(model, 3, 2), one) << "EXACT: threads";
}

TEST_P(Determinism, same_bits_while_bonds_tear) {
  Scene scene = bursting_disc(3);
  scene.time.integrator = GetParam();
  const Model model = build_model(scene);
  const std::uint64_t one = hash_after(model, 1, 3);
  EXPECT_EQ(hash_after(model, 2, 3), one) << "EXACT: threads";
  EXPECT_EQ(hash_after(model, 3, 3), one) << "EXACT: threads";
}

INSTANTIATE_TEST_SUITE_P(Integrators, Determinism, ::testing::Values(Integrator::verlet, Integrator::step_doubling));

TEST(StateHash, sees_the_last_bit_of_every_part) {
  const Model model = build_model(small_third_body(2));
  Simulation simulation(model);
  advance(simulation, 0.5);
  const State state = simulation.state();
  const std::uint64_t hash = state_hash(state);
  const auto differs = [&](auto change) {
    State copy = state;
    change(copy);
    return state_hash(copy) != hash;
  };
  const auto nudge = [](double& x) { x = std::nextafter(x, 1e300); };
  EXPECT_EQ(state_hash(State(state)), hash);
  EXPECT_TRUE(differs([&](State& s) { nudge(s.time); }));
  EXPECT_TRUE(differs([&](State& s) { nudge(s.dissipated); }));
  EXPECT_TRUE(differs([&](State& s) { nudge(s.external_work); }));
  EXPECT_TRUE(differs([&](State& s) { ++s.rejections; }));
  EXPECT_TRUE(differs([&](State& s) { nudge(s.position.rigid[4]); }));
  EXPECT_TRUE(differs([&](State& s) { nudge(s.reduced_momentum.rigid[4]); }));
  EXPECT_TRUE(
      differs([&](State& s) { s.position.compliant[7][2] = std::nextafter(s.position.compliant[7][2], 1e300); }));
  EXPECT_TRUE(
      differs([&](State& s) { nudge(reinterpret_cast<double*>(s.memory.contact.at(0) + ContactHistory::slip)[3]); }));
}

}  // namespace
}  // namespace pliant::dynamics_tests
