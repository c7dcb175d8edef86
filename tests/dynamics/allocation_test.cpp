// A step allocates nothing: memory that a step needs is found when the simulation is built, or with new candidates.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace {

std::atomic<long> allocations{0};  // only counts: no result depends on it

/// Null where there is none.
void* find_room(std::size_t bytes, std::size_t alignment) noexcept {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  return std::aligned_alloc(alignment, whole == 0 ? alignment : whole);
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (void* memory = find_room(bytes, alignment)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// Of the whole program: the counter is looked at here alone. Room for sorting is asked for without exceptions.
void* operator new(std::size_t bytes) { return allocate(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  return find_room(bytes, alignof(std::max_align_t));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace pliant::dynamics_tests {
namespace {

/// Allocations in the steps of a run that neither search candidates, nor improve the bound of the internal forces, nor
/// end where a load switches.
long allocations_of_steps(const Scene& scene) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, 0.5 * scene.time.end);
  long counted = 0, steps = 0;
  while (steps < 200) {
    const long refreshes = simulation.forces().contact().refreshes(), before = allocations;
    simulation.step(1e300);
    const State& state = simulation.state();
    const bool rare = simulation.forces().contact().refreshes() != refreshes || state.steps % 50 == 0 ||
                      std::ranges::find(model.switch_times, state.time) != model.switch_times.end();
    if (rare) continue;
    counted += allocations - before;
    ++steps;
  }
  return counted;
}

TEST(Allocation, there_is_none_in_a_step) { EXPECT_EQ(allocations_of_steps(small_third_body(2)), 0) << "EXACT"; }

class AllocationOfAll : public ::testing::TestWithParam<Integrator> {};

/// Whatever a scene asks for beside contact.
TEST_P(AllocationOfAll, there_is_none_in_a_step) {
  using Condition = BoundaryCondition;
  for (const Mass mass : {Mass::lumped, Mass::corrected}) {
    Scene scene = small_third_body(2);
    scene.time.integrator = GetParam();
    scene.discretisation.mass = mass;
    scene.contact.length = ContactLength::current;
    scene.contact.energy_consistent = GetParam() == Integrator::verlet;
    for (Material& material : scene.materials) material.viscosity = 0.01, material.mass_damping = 0.1;
    scene.contacts = {mohr_coulomb(1, 0.5), mohr_coulomb(1, 0.5)};
    for (ContactRule& rule : scene.contacts) rule.stiffness.reset();
    scene.contacts[1].first = scene.contacts[1].second = "hard";
    scene.contacts[1].restitution = 0.5;
    scene.walls[1].y.damping = 0.2;
    Condition pressure;
    pressure.kind = Condition::Kind::pressure;
    pressure.grains = "layer";
    pressure.pressure = {{0, 5}, {0.02, 0.05}};
    Condition support;
    support.kind = Condition::Kind::support;
    support.grains = "layer";
    support.stiffness = support.damping = 0.01;
    support.x = {AxisCondition::Mode::velocity, constant(0.01)};
    scene.boundary = {pressure, support};
    EXPECT_EQ(allocations_of_steps(scene), 0) << "EXACT";
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, AllocationOfAll,
                         ::testing::Values(Integrator::verlet, Integrator::step_doubling));

TEST(Allocation, is_seen) {
  const long before = allocations;
  const std::vector<double> one(1);
  EXPECT_EQ(allocations - before, 1) << "EXACT: " << one[0];
}

}  // namespace
}  // namespace pliant::dynamics_tests
