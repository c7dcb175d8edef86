// What a run that goes on may find changed in its scene. All EXACT.
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "input/scene_difference.hpp"
#include "scene/scene.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

const std::string& before = scene_tests::good_scene;

std::string difference_after(const std::string& old, const std::string& by) {
  std::string now = before;
  EXPECT_NE(now.find(old), std::string::npos) << old;
  return scene_difference(before, now.replace(now.find(old), old.size(), by));
}

TEST(SceneDifference, what_changes_no_step_may_change) {
  EXPECT_EQ(scene_difference(before, before), "");
  EXPECT_EQ(difference_after("end = \"2 us\"", "end = \"3 us\" # longer"), "");
  EXPECT_EQ(difference_after("title = \"Good\"", "title = \"Better\""), "");
  EXPECT_EQ(difference_after("[contact]", "[checkpoint]\nperiod = \"1 h\"\n[contact]"), "");
  EXPECT_EQ(difference_after("[[0, 0], ", "[[0.0, 0], "), "") << "the same number";
  EXPECT_EQ(difference_after("density = 1200\n[shapes", "density = 1200.0\n[shapes"), "");
}

std::string restarted(const std::string& old, const std::string& by) {
  std::string now = before;
  EXPECT_NE(now.find(old), std::string::npos) << old;
  return start_difference(before, now.replace(now.find(old), old.size(), by));
}

TEST(StartDifference, loads_laws_and_outputs_may_change) {
  EXPECT_EQ(restarted("[contact]", "[start]\nfrom = \".\"\n[contact]"), "");
  EXPECT_EQ(restarted("tolerance = 1e-2", "integrator = \"step-doubling\""), "");
  EXPECT_EQ(restarted("\"2 GPa\"", "\"3 GPa\""), "");
  EXPECT_EQ(restarted("poisson = 0.4\n", "poisson = 0.4\nyield = \"5 MPa\"\nheat_capacity = 900\n"), "");
  EXPECT_EQ(restarted("gravity = [\"0 m/s2\", -9.81]\n", ""), "");
  EXPECT_EQ(restarted("skin = 0.4", "length = \"current\""), "");
  EXPECT_EQ(restarted("friction = 0.3", "friction = 0.4"), "");
  EXPECT_EQ(restarted("x = { velocity = \"10 m/s\" }", "x = \"fixed\""), "");
  EXPECT_EQ(restarted("[frames]", "[frames] # none\n[other]").substr(0, 7), "'other.");
}

TEST(StartDifference, one_quantity_in_other_units_is_the_same) {
  EXPECT_EQ(restarted("period = \"10 um\"", "period = \"0.01 mm\""), "");
  EXPECT_EQ(restarted("period = \"10 um\"", "period = 1e-5"), "");
  EXPECT_EQ(restarted("period = \"10 um\"", "period = \"10 mm\""), "'domain.period' was '10 um', now '10 mm'");
}

TEST(StartDifference, bodies_shapes_and_the_discretisation_must_not) {
  EXPECT_EQ(restarted("support = 9", "support = 10"), "'discretisation.support' was 9, now 10");
  EXPECT_EQ(restarted("\"neo-hookean\"", "\"melody\""), "'materials.soft.law' was 'neo-hookean', now 'melody'");
  EXPECT_EQ(restarted("seed = 7", "seed = 8"), "'grains 1.seed' was 7, now 8");
  EXPECT_EQ(restarted("nodes = 168", "nodes = 169"), "'shapes.disc.nodes' was 168, now 169");
  EXPECT_EQ(restarted("period = \"10 um\"", "period = \"11 um\""), "'domain.period' was '10 um', now '11 um'");
  EXPECT_EQ(restarted("level = \"-1 um\"", "level = \"-2 um\""), "'walls 1.level' was '-1 um', now '-2 um'");
  EXPECT_EQ(restarted("skin = 0.4", "self_contact = true"), "'contact.self_contact' was not there, now true");
}

TEST(SceneDifference, the_first_other_key_is_named_with_both_values) {
  EXPECT_EQ(difference_after("support = 9", "support = 10"), "'discretisation.support' was 9, now 10");
  EXPECT_EQ(difference_after("\"2 GPa\"", "\"3 GPa\""), "'materials.soft.young' was '2 GPa', now '3 GPa'");
  EXPECT_EQ(difference_after("poisson = 0.4\n", ""), "'materials.soft.poisson' was 0.4, now not there");
  EXPECT_EQ(difference_after("seed = 7", "seed = 8"), "'grains 1.seed' was 7, now 8");
  EXPECT_EQ(difference_after("seed = 7", "seed = 7\nspecies_order = \"in turn\""),
            "'grains 1.species_order' was not there, now 'in turn'");
  EXPECT_EQ(difference_after(", \"von_mises\"]", "]"), "'frames.fields 2' was 'von_mises', now not there");
  EXPECT_EQ(difference_after("x = { velocity = \"10 m/s\" }", "x = \"fixed\""), "'walls 2.x' was a table, now 'fixed'");
  EXPECT_EQ(difference_after("[[probes]]", "[[probes]]\nname = \"new\"\nquantity = \"energy\"\nperiod = 1\n[[probes]]"),
            "'probes 1.name' was 'drag', now 'new'");
}

TEST(SceneDifference, text_that_is_not_toml_is_refused) { EXPECT_THROW(scene_difference(before, "= 1"), InputError); }

}  // namespace
}  // namespace pliant
