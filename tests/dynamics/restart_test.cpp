// A simulation that is read back goes on with the same bits, from any step, with any number of threads (docs/design.md
// 5). All EXACT. A new feature that keeps something from step to step joins by a scene in `scenes`.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <functional>
#include <map>
#include <span>

#include "core/archive.hpp"
#include "setup/build_model.hpp"
#include "support/random.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

constexpr int last_step = 300;

/// Compliant and rigid grains with cohesion between unlike ones and friction between like ones, sheared across the
/// period.
Scene friction_and_cohesion() {
  Scene scene = small_third_body(1000);
  scene.walls[1].x.history = {{0, 1}, {0.3, 0.6}};
  scene.grains[0].velocity = moving({0.4, 0}, 0.1);
  scene.contacts.push_back(scene.contacts[0]);
  scene.contacts[1].first = "soft", scene.contacts[1].second = "hard";
  scene.contacts[0].law = ContactLawKind::mohr_coulomb;
  scene.contacts[0].friction = 0.4;
  return scene;
}

/// The same with what else lives from step to step: bonds that wear between grains of one kind, a servo wall,
/// viscosity, corrected mass, and candidates found anew at fixed times.
Scene bonds_and_servo() {
  Scene scene = friction_and_cohesion();
  scene.grains[0].velocity.rotation = 0.02;
  scene.grains[0].packing.row_pitch = 2.0;
  scene.walls[1].level = 7.02;
  scene.walls[1].y.damping = 0.5;
  BondRule bonds;
  bonds.first = bonds.second = "soft";
  bonds.strength = 0.5, bonds.fracture_energy = 0.075;
  bonds.gap = 0.02;
  bonds.fatigue_rate = bonds.shear_fatigue_rate = 0.5;
  bonds.fatigue_threshold = 1e-3;
  scene.bonds = {bonds};
  scene.materials[0].viscosity = 0.01;
  scene.discretisation.mass = Mass::corrected;
  scene.contact.refresh_steps = 7;
  return scene;
}

/// Rigid blocks that slide fast enough to use up the skin within few steps, so that trials are rejected and candidates
/// rebuilt.
Scene fast_blocks() {
  Scene scene = on_a_floor(1000, 20, 0.1, {0.2, -1});
  scene.shapes = {box_shape("block", 1, 0.5, 0.1)};
  scene.grains = {grains("fast", "block", BodyKind::rigid, {{10, 0.245}}, moving({3, 0})),
                  grains("slow", "block", BodyKind::rigid, {{2, 0.245}}, moving({1, 0}))};
  scene.contacts = {mohr_coulomb(100, 0.5)};
  scene.time.tolerance = 1e-4;
  scene.time.target = 1e-2;
  return scene;
}

/// Two discs, one with a memory, that rub against their own periodic images and each other.
Scene own_images() {
  Scene scene = empty_scene(1000);
  scene.period = 1.99;
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0.3, 0}}, moving({0, 0.1}, 0.3)),
                  grains("hard", "disc", BodyKind::rigid, {{1.3, 1.74}}, moving({0, -0.1}, 0.2))};
  Material& soft = scene.materials[0];
  soft.law = MaterialLaw::neo_hookean_maxwell, soft.branch_modulus = 1, soft.relaxation_time = 0.1;
  scene.contacts = {mohr_coulomb(100, 0.4)};
  return scene;
}

/// Its pieces meet across the period.
Scene bursting_across_a_period() {
  Scene scene = bursting_disc(1000);
  scene.period = 2;
  return scene;
}

/// The same discs of which one flows plastically.
Scene plastic_images() {
  Scene scene = own_images();
  Material& soft = scene.materials[0];
  soft.law = MaterialLaw::von_mises, soft.yield = 0.01, soft.saturation = 0.02, soft.saturation_rate = 5;
  soft.viscoplastic_time = 0.01, soft.heat_capacity = 1;
  return scene;
}

/// Discs of both kinds in a cell with two periods that is sheared, while a stress presses it.
Scene stressed_cell() {
  Scene scene = empty_scene(1000);
  scene.shapes = {disc_shape("disc", 1, 60), disc_shape("small", 0.9, 40)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0.5, 0.5}, {1.55, 1.52}, {8.77, -0.57}}),
                  grains("hard", "small", BodyKind::rigid, {{1.5, 0.48}, {0.5, 1.5}, {2.5, 0.5}})};
  scene.contacts = {mohr_coulomb(100, 0.3)};
  scene.cell.emplace();
  scene.cell->periods = {3.1, 2.1};
  scene.cell->gradient[0][1] = {{0, 0.1, 1000}, {0, 0.01, 200}};
  scene.cell->stress[1][1] = History{{0, 0.5}, {0, -0.2}};
  scene.cell->stress[0][0] = History{{0, 0.5}, {0, -0.1}};
  return scene;
}

const std::vector<std::pair<std::string, std::function<Scene()>>> scenes = {
    {"friction_and_cohesion", friction_and_cohesion},
    {"bonds_and_servo", bonds_and_servo},
    {"fast_blocks", fast_blocks},
    {"own_images", own_images},
    {"plastic_images", plastic_images},
    {"stressed_cell", stressed_cell},
    {"bursting_disc", bursting_across_a_period}};

std::string saved(Simulation& simulation) {
  std::string bytes;
  SaveLeaf save(bytes);
  Walk{save}("simulation", simulation);
  return bytes;
}

/// Everything of a simulation by name, in text, to tell what differs.
struct Parts {
  static constexpr bool loads = false;
  std::vector<std::pair<std::string, std::uint64_t>> all;
  void value(const std::string& path, const auto& value) { add(path, &value, sizeof value); }
  void array(const std::string& path, const PlainArray auto& values) {
    add(path, values.data(), values.size() * sizeof values[0]);
  }
  void add(const std::string& path, const void* data, std::size_t bytes) {
    Fnv1a hash;
    hash.add(data, bytes);
    all.emplace_back(path, hash.value());
  }
};

/// Names of the parts that differ.
std::string different_parts(Simulation& a, Simulation& b) {
  Parts parts[2];
  Walk{parts[0]}("simulation", a);
  Walk{parts[1]}("simulation", b);
  std::string names;
  for (std::size_t i = 0; i < parts[0].all.size(); ++i)
    if (parts[0].all[i] != parts[1].all[i]) names += parts[0].all[i].first + " ";
  return names;
}

class Restart : public ::testing::TestWithParam<std::tuple<std::size_t, Integrator>> {
 protected:
  Restart() : threads_(omp_get_max_threads()) {}
  ~Restart() override { omp_set_num_threads(threads_); }
  static Model model() {
    Scene scene = scenes[std::get<0>(GetParam())].second();
    if (!scene.cell) scene.time.integrator = std::get<1>(GetParam());  // "step-doubling" moves no cell
    // Every other scene, so that both ways to keep a history go through restarts.
    scene.contact.energy_consistent = std::get<0>(GetParam()) % 2 == 0 && scene.time.integrator == Integrator::verlet;
    return build_model(scene);
  }

 private:
  int threads_;
};

TEST_P(Restart, same_bits_from_any_step_with_any_number_of_threads) {
  const Model scene_model = model();
  Simulation whole(scene_model), watched(scene_model);
  testing::Random random(std::get<0>(GetParam()) + 7);
  std::map<long, std::string> saves = {
      {0, ""}, {49, ""}, {50, ""}};  // around the power iterations, and three at random
  for (int i = 0; i < 3; ++i) saves[1 + random.below(last_step - 1)];
  std::vector<std::uint64_t> hashes;
  for (long step = 0; step <= last_step; ++step) {
    if (const auto wanted = saves.find(step); wanted != saves.end()) wanted->second = saved(watched);
    hashes.push_back(state_hash(whole.state()));
    ASSERT_EQ(state_hash(watched.state()), hashes.back()) << "saving changed the run at step " << step;
    whole.step(1000), watched.step(1000);
  }
  for (const auto& [first, bytes] : saves) {
    Simulation resumed(scene_model);
    for (const int threads : {1, 2}) {  // the second time into one that went on
      omp_set_num_threads(threads);
      LoadLeaf load(bytes);
      Walk{load}("simulation", resumed);
      EXPECT_TRUE(load.empty());
      for (long step = first; step <= last_step; ++step) {
        ASSERT_EQ(state_hash(resumed.state()), hashes[step]) << "step " << step << ", saved at " << first;
        resumed.step(1000);
      }
      EXPECT_EQ(different_parts(resumed, whole), "") << "saved at " << first << ", " << threads << " threads";
      EXPECT_EQ(resumed.energy_balance().energy.mechanical(), whole.energy_balance().energy.mechanical());
      EXPECT_EQ(resumed.balance_error(resumed.energy_balance().energy),
                whole.balance_error(whole.energy_balance().energy));
    }
  }
}

/// Outputs are looks of an observer.
TEST_P(Restart, looks_on_the_way_leave_the_motion_as_it_is_and_see_a_step_that_ends_there) {
  const Model scene_model = model();
  Simulation whole(scene_model), watched(scene_model), cut(scene_model);
  testing::Random random(std::get<0>(GetParam()) + 11);
  std::string before;
  double next = 1e300;  // the first step is too short to be passed by
  int looks = 0;
  const Observer observer{[&] { return next; },
                          [&] {
                            const State& seen = watched.state();
                            EXPECT_EQ(seen.time, next);
                            watched.energy_balance();
                            if (++looks % 20 == 0) {
                              LoadLeaf load(before);
                              Walk{load}("simulation", cut);
                              while (cut.state().time < next) cut.step(next);
                              const State& there = cut.state();
                              EXPECT_EQ(seen.steps + 1, there.steps) << "in one step, which does not count";
                              EXPECT_EQ(seen.dissipated, there.dissipated);
                              EXPECT_EQ(seen.external_work, there.external_work);
                              for (const auto part : {&State::position, &State::reduced_momentum, &State::force}) {
                                EXPECT_EQ((seen.*part).rigid, (there.*part).rigid);
                                EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span((seen.*part).compliant)),
                                                               std::as_bytes(std::span((there.*part).compliant))));
                              }
                            }
                            next += random.uniform(0.1, 1.5) * watched.control().next_dt;
                            return true;
                          }};
  for (long step = 0; step <= last_step; ++step) {
    before = saved(watched);
    if (step > 0 && !(next > watched.state().time && next < 1e300))
      next = watched.state().time + 0.3 * watched.control().next_dt;
    whole.step(1000), watched.step(1000, &observer);
    ASSERT_EQ(state_hash(watched.state()), state_hash(whole.state())) << "looking changed the run at step " << step;
  }
  EXPECT_GT(looks, last_step / 2);
  EXPECT_EQ(watched.energy_balance().energy.mechanical(), whole.energy_balance().energy.mechanical());
}

/// The scenes show what restarts may lose.
TEST_P(Restart, scenes_refresh_slip_and_cross_the_period) {
  const Model scene_model = model();
  Simulation simulation(scene_model);
  for (long step = 0; step <= last_step; ++step) simulation.step(1000);
  EXPECT_GT(simulation.forces().contact().refreshes(), 3) << "candidates were rebuilt";
  const ContactHistory& history = simulation.state().memory.contact;
  int slipping = 0, worn = 0;
  for (int i = 0; i < history.records(); ++i) slipping += history.number(i, ContactHistory::slip) != 0;
  const BondHistory& bonds = simulation.state().memory.bonds;
  for (std::size_t i = 0; i < simulation.forces().bonds().bonds().size(); ++i)
    for (int end = 0; end < 2; ++end) worn += bonds.damage(i, end) > 0;
  EXPECT_GT(slipping, 1) << "contacts have slip";
  EXPECT_GT(simulation.state().dissipated, 0);
  EXPECT_EQ(worn > 0, !scene_model.scene.bonds.empty()) << "bonds are damaged";
  const std::vector<ContactPair>& contact_pairs = simulation.forces().contact().contact_pairs();
  EXPECT_TRUE(std::any_of(contact_pairs.begin(), contact_pairs.end(), [&](const ContactPair& p) {
    return p.images != Images{} || scene_model.bodies[p.first].wall || scene_model.bodies[p.second].wall;
  })) << "bodies touch across the period";
}

/// A block pressed against another one that is held at first: their dashpot is that of another mass once it is let go.
Scene let_go() {
  Scene scene = empty_scene(1000);
  scene.shapes = {box_shape("block", 1, 1, 0.25)};
  scene.grains = {grains("left", "block", BodyKind::rigid, {{0, 0}}, moving({0.1, 0})),
                  grains("right", "block", BodyKind::rigid, {{0.998, 0}})};
  BoundaryCondition held;
  held.grains = "right";
  held.x = held.y = {AxisCondition::Mode::velocity, constant(0)};
  held.x.window.until = held.y.window.until = 0.01;
  scene.boundary = {held};
  scene.contacts[0].restitution = 0.5;
  return scene;
}

/// The laws of a save are those of its time, not of the start.
TEST(RestartWhileTouching, laws_are_those_of_the_time) {
  const Model model = build_model(let_go());
  Simulation whole(model), resumed(model);
  while (whole.state().time < 0.02) whole.step(1000);
  const std::string bytes = saved(whole);
  LoadLeaf load(bytes);
  Walk{load}("simulation", resumed);
  const long refreshes = whole.forces().contact().refreshes();
  EXPECT_EQ(refreshes, 2) << "when it was let go: not since";
  for (int step = 0; step < 20; ++step) {
    whole.step(1000), resumed.step(1000);
    ASSERT_EQ(state_hash(resumed.state()), state_hash(whole.state())) << "step " << step;
  }
  EXPECT_GT(whole.energy_balance().energy.dissipated, 0) << "the dashpot works";
  EXPECT_EQ(whole.forces().contact().refreshes(), refreshes) << "else this test says nothing";
}

std::string name_of(const ::testing::TestParamInfo<Restart::ParamType>& info) {
  return scenes[std::get<0>(info.param)].first +
         (std::get<1>(info.param) == Integrator::verlet ? "_verlet" : "_step_doubling");
}

INSTANTIATE_TEST_SUITE_P(Scenes, Restart,
                         ::testing::Combine(::testing::Range(std::size_t{0}, scenes.size()),
                                            ::testing::Values(Integrator::verlet, Integrator::step_doubling)),
                         name_of);

}  // namespace
}  // namespace pliant::dynamics_tests
