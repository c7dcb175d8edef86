// Refused settings and laws of contact: place and words.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

using scene_tests::good_scene;
using scene_tests::SceneFile;

/// One change to the good scene, what stands where the error is, and a part of its text.
struct Bad {
  const char *from, *to, *at, *text;
};

void expect_refused(const Bad& bad) {
  SCOPED_TRACE(bad.to);
  std::string scene = good_scene;
  const auto from = scene.find(bad.from);
  ASSERT_NE(from, std::string::npos);
  scene.replace(from, std::string(bad.from).size(), bad.to);
  const auto at = scene.find(bad.at);
  ASSERT_NE(at, std::string::npos);
  const auto line = 1 + std::count(scene.begin(), scene.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const auto column = at - (at == 0 ? 0 : scene.rfind('\n', at - 1));
  const SceneFile file(scene);
  try {
    read_scene(file.path());
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string place = file.path().string() + ":" + std::to_string(line) + ":" + std::to_string(column) + ":";
    EXPECT_TRUE(message.starts_with(place)) << message << "\nexpected at " << place;
    EXPECT_NE(message.find(bad.text), std::string::npos) << message;
  }
}

// EXACT throughout.

TEST(BadContacts, Laws) {
  const char* friction = "friction = 0.3";
  const std::vector<Bad> all{
      {"[\"soft\", \"hard\"]", "[\"soft\", \"flor\"]", "\"flor\"", "nearest: floor"},
      {friction, "friction = \"90 deg\"", "\"90 deg\"", "an angle from 0 to below 90 deg"},
      {friction, "friction = \"-1 deg\"", "\"-1 deg\"", "an angle from 0 to below 90 deg"},
      {friction, "friction = \"45 dge\"", "\"45 dge\"", "an angle from 0 to below 90 deg"},
      {friction, "friction = -1", "-1\nstiffness", "an angle from 0 to below 90 deg"},
      {friction, "friction = 0.3\nsmoothing = \"1 deg\"", "\"1 deg\"", "no number; allowed: a number, >= 0 and <= 1"},
      {friction, "friction = 0.3\nrestitution = 0", "0\nstiffness", "'restitution' in [[contacts]] 2"},
      {friction, "pull = true\nfriction = 0.3", "pull", "unknown key 'pull'"},
      {friction, "friction = 0.3\nrestitution = 0.5\npull = 1", "1\nstiffness", "true or false"},
      {friction, "friction = 0.3\nrestitution = 0.5\nsmoothing = 0.02", "0.02", "constant stiffness"},
      {friction, "friction = 0.3\ntension = 1e6\nsmoothing = 0.02", "smoothing", "unknown key 'smoothing'"},
  };
  for (const Bad& bad : all) expect_refused(bad);
}

TEST(BadContacts, Bonds) {
  const char *law = "law = \"cohesive\"", *table = "[[contacts]]\nbetween = [\"soft\"";
  const std::vector<Bad> all{
      {law, "law = \"cohesive-fatigue\"", table, "missing key 'bond_gap'"},
      {law, "law = \"cohesive-fatigue\"\nbond_gap = 1e-9\nfatigue_rate = \"1 GPa-1\"", table,
       "missing key 'fatigue_threshold'"},
      {law, "law = \"cohesive-fatigue\"\nbond_gap = 1e-9\nresidual_strength = \"1 GPa\"", "\"1 GPa\"\nstrength",
       "'residual_strength' in [[contacts]] 1: found \"1 GPa\"; allowed: a quantity in Pa, >= 0 and <= 200000000"},
      {law, "law = \"cohesive-fatigue\"\nbond_gap = 1e-9\nshear_stiffness = 1", "shear_stiffness",
       "unknown key 'shear_stiffness'"},
  };
  for (const Bad& bad : all) expect_refused(bad);
}

TEST(BadContacts, Settings) {
  const char* skin = "skin = 0.4";
  const std::vector<Bad> all{
      {skin, "skin = 0.4\nrefresh = 0", "0\n[[probes]]", "an integer from 1"},
      {skin, "skin = 0.4\nrefresh = \"0 us\"", "\"0 us\"\n[[probes]]", "'refresh' in [contact]"},
      {skin, "skin = 0.4\nrefresh = \"saef\"", "\"saef\"", "\"safe\""},
      {skin, "skin = 0.4\nrefresh = 0.5", "0.5\n[[probes]]", "a number of steps"},
      {skin, "skin = 0.4\nlength = \"curent\"", "\"curent\"", "nearest: current"},
      {skin, "skin = 0.4\nself_contact = \"yes\"", "\"yes\"", "true or false"},
  };
  for (const Bad& bad : all) expect_refused(bad);
}

}  // namespace
}  // namespace pliant
