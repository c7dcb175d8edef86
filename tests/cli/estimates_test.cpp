#include "cli/estimates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cli/dry_run.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

Probe energy_probe(double period) {
  Probe probe;
  probe.name = "p";
  probe.quantity = "energy";
  probe.period = period;
  return probe;
}

TEST(LargestPressure, IsThatOfTheWallsUntilTheEnd) {
  Scene scene = testing::bare_scene();
  scene.period = 4;
  scene.time.end = 2;
  EXPECT_EQ(largest_pressure(scene), 0);  // EXACT
  Wall wall;
  wall.y.mode = AxisCondition::Mode::pressure;
  wall.y.history = {{0, 4}, {0, 8}};
  scene.walls.push_back(wall);
  EXPECT_DOUBLE_EQ(largest_pressure(scene), 4);  // EXACT: halfway up the ramp
  wall.y.mode = AxisCondition::Mode::force;
  wall.y.history = {{0, 1, 3}, {0, -40, 0}};
  scene.walls.push_back(wall);
  EXPECT_DOUBLE_EQ(largest_pressure(scene), 10);  // EXACT: 40 N/m over a period of 4 m, either sign
}

TEST(Penetration, OfRigidDiscsCarriesTheForceOfItsSegment) {
  // INDEPENDENT: pressure kn (depth - curvature x^2 / 2), summed by the midpoint rule over the overlap of two
  // parabolas.
  PairEstimate pair;
  pair.stiffness = 3e9;
  pair.curvature = 2 / 0.05 + 2 / 0.08;
  pair.width = 0.05;
  const double pressure = 1e5, depth = pair.penetration(pressure), half = std::sqrt(2 * depth / pair.curvature);
  constexpr int strips = 20'000;
  double force = 0;
  for (int i = 0; i < strips; ++i) {
    const double x = half * ((2.0 * i + 1) / strips - 1);
    force += pair.stiffness * (depth - pair.curvature * x * x / 2) * 2 * half / strips;
  }
  EXPECT_NEAR(force, pressure * pair.width, 1e-7 * force);  // midpoint rule: 1/strips^2
  pair.curvature = 0;
  EXPECT_DOUBLE_EQ(pair.penetration(pressure), pressure / pair.stiffness);  // EXACT
}

TEST(OutputCount, HasTheLastOneInSpiteOfRounding) {
  // EXACT: 0.1 and 10 in units of 1e-9 are not 100 periods in binary.
  EXPECT_EQ(output_count(0.1e-9, 10e-9), 101);
  EXPECT_EQ(output_count(3, 10), 4);
  EXPECT_EQ(output_count(20, 10), 1);
  EXPECT_EQ(output_count(0, 10), 0);
}

TEST(LeastSteps, MeetTheOutputsIfTheyStopThere) {
  Scene scene = testing::bare_scene();
  // EXACT
  EXPECT_DOUBLE_EQ(least_steps(scene, 10, 0.3), 34);
  scene.frames.period = 1;
  EXPECT_DOUBLE_EQ(least_steps(scene, 10, 0.3), 34);
  scene.time.stop_at_outputs = true;
  EXPECT_DOUBLE_EQ(least_steps(scene, 10, 0.3), 40);
  scene.probes.push_back(energy_probe(0.5));
  EXPECT_DOUBLE_EQ(least_steps(scene, 10, 0.3), 40);
  EXPECT_DOUBLE_EQ(least_steps(scene, 10, 0.6), 20);
  EXPECT_DOUBLE_EQ(least_steps(scene, 0, 0.3), 0);
}

/// A hard wall below a soft and two hard discs.
Scene three_discs_and_a_wall() {
  Scene scene = testing::bare_scene();
  scene.period = 10;
  scene.time.end = 1e-3;
  scene.shapes = {testing::polygonal_disc("disc", 1, 24, 40)};
  for (const char* material : {"soft", "hard"}) {
    Grains grains;
    grains.name = material;
    grains.shape = "disc";
    const bool soft = grains.name == "soft";
    grains.packing.positions = soft ? Points{{1, 0}} : Points{{3, 0}, {5, 0}};
    grains.species = {{soft ? BodyKind::compliant : BodyKind::rigid, material, 1}};
    scene.grains.push_back(grains);
  }
  Wall wall;
  wall.name = "floor";
  wall.material = "hard";
  wall.level = -1;
  scene.walls = {wall};
  scene.contacts = {testing::frictionless(7)};
  scene.contacts[0].stiffness.reset();
  return scene;
}

TEST(ContactPairs, AreThoseThatCanMeet) {
  Scene scene = three_discs_and_a_wall();
  scene.contacts.push_back(testing::mohr_coulomb(50, 0.3));
  scene.contacts[1].first = "hard", scene.contacts[1].second = "soft";
  const Model model = build_model(scene);
  const std::vector<PairEstimate> pairs = pair_estimates(model, LawTable(model));
  // EXACT: the only soft disc does not meet itself, and the wall no wall.
  ASSERT_EQ(pairs.size(), 4U);
  const auto find = [&](const std::string& first, const std::string& second) {
    for (const PairEstimate& pair : pairs)
      if (pair.first == first && pair.second == second) return pair;
    ADD_FAILURE() << first << " - " << second;
    return PairEstimate{};
  };
  const PairEstimate mixed = find("hard", "soft");
  EXPECT_EQ(mixed.law, "mohr-coulomb");
  EXPECT_FALSE(mixed.automatic);
  EXPECT_EQ(mixed.stiffness, 50);
  EXPECT_EQ(mixed.shear_stiffness, 50);
  EXPECT_EQ(mixed.curvature, 0) << "the soft disc flattens";
  find("soft", "wall of hard");
  const PairEstimate hard = find("hard", "hard");
  EXPECT_TRUE(hard.automatic);
  EXPECT_EQ(hard.shear_stiffness, 0);
  EXPECT_DOUBLE_EQ(hard.curvature, 4);
  EXPECT_DOUBLE_EQ(hard.width, 1);
  EXPECT_DOUBLE_EQ(find("hard", "wall of hard").curvature, 2);
}

TEST(OutputSizes, GrowWithWhatIsAskedFor) {
  Scene scene = three_discs_and_a_wall();
  const OutputSize none = output_size(build_model(scene), 100);
  EXPECT_EQ(none.frames, 0);  // EXACT
  EXPECT_EQ(none.frames_h5 + none.frames_xdmf + none.probes_csv, 0);
  scene.frames = {1e-4, {"velocity"}};
  scene.probes.push_back(energy_probe(1e-5));
  const OutputSize some = output_size(build_model(scene), 400'000);
  EXPECT_EQ(some.frames, 11);
  EXPECT_EQ(some.probe_rows, 101);
  EXPECT_EQ(some.step_rows, 220'000) << "every tenth beyond 200,000";
  EXPECT_GT(some.frames_h5, 11 * 0.5 * frame_bytes(build_model(scene)));
}

TEST(DryRun, CountsWhatARunCounts) {
  Scene scene = three_discs_and_a_wall();
  scene.grains[0].velocity.uniform = Vec2(1, 0);
  scene.time.end = 0.5;
  scene.frames.period = 0.05;
  scene.probes.push_back(energy_probe(0.03));
  for (const bool stops : {false, true}) {
    scene.time.stop_at_outputs = stops;
    const Model model = build_model(scene);
    Simulation rehearsed(model);
    const DryRun first = dry_run(rehearsed);
    ASSERT_TRUE(first.finished);
    // EXACT: the same steps as a run, which stops at the union of both periods or before the end.
    Simulation run(model);
    std::vector<double> outputs;
    for (int i = 1; i <= 10; ++i) outputs.push_back(0.05 * i);
    for (int i = 1; i <= 16; ++i) outputs.push_back(0.03 * i);
    std::sort(outputs.begin(), outputs.end());
    for (double output : outputs)
      while (stops && run.state().time < output * (1 - 1e-12)) run.step(output);
    const Observer end{[] { return 0.5; }, [] { return false; }};
    while (!stops && run.step(std::numeric_limits<double>::infinity(), &end).dt > 0);
    EXPECT_EQ(rehearsed.state().steps, run.state().steps);
    EXPECT_EQ(first.evaluations, run.state().evaluations);
    EXPECT_GT(first.seconds_per_evaluation, 0);
  }
}

}  // namespace
}  // namespace pliant
