// What a run that goes on may find changed in its scene. All EXACT.
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "scene/scene.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

const std::string& before = scene_tests::good_scene;

std::string changed(const std::string& old, const std::string& by) {
  std::string now = before;
  EXPECT_NE(now.find(old), std::string::npos) << old;
  return scene_difference(before, now.replace(now.find(old), old.size(), by));
}

TEST(SceneDifference, what_changes_no_step_may_change) {
  EXPECT_EQ(scene_difference(before, before), "");
  EXPECT_EQ(changed("end = \"2 us\"", "end = \"3 us\" # longer"), "");
  EXPECT_EQ(changed("title = \"Good\"", "title = \"Better\""), "");
  EXPECT_EQ(changed("[contact]", "[checkpoint]\nperiod = \"1 h\"\n[contact]"), "");
  EXPECT_EQ(changed("[[0, 0], ", "[[0.0, 0], "), "") << "the same number";
  EXPECT_EQ(changed("density = 1200\n[shapes", "density = 1200.0\n[shapes"), "");
}

TEST(SceneDifference, the_first_other_key_is_named_with_both_values) {
  EXPECT_EQ(changed("support = 9", "support = 10"), "'discretisation.support' was 9, now 10");
  EXPECT_EQ(changed("\"2 GPa\"", "\"3 GPa\""), "'materials.soft.young' was '2 GPa', now '3 GPa'");
  EXPECT_EQ(changed("poisson = 0.4\n", ""), "'materials.soft.poisson' was 0.4, now not there");
  EXPECT_EQ(changed("seed = 7", "seed = 8"), "'grains 1.seed' was 7, now 8");
  EXPECT_EQ(changed("seed = 7", "seed = 7\nmix_order = \"in turn\""),
            "'grains 1.mix_order' was not there, now 'in turn'");
  EXPECT_EQ(changed(", \"von_mises\"]", "]"), "'frames.fields 2' was 'von_mises', now not there");
  EXPECT_EQ(changed("x = { velocity = \"10 m/s\" }", "x = \"fixed\""), "'walls 2.x' was a table, now 'fixed'");
  EXPECT_EQ(changed("[[probes]]", "[[probes]]\nname = \"new\"\nquantity = \"energy\"\nperiod = 1\n[[probes]]"),
            "'probes 1.name' was 'drag', now 'new'");
}

TEST(SceneDifference, text_that_is_not_toml_is_refused) { EXPECT_THROW(scene_difference(before, "= 1"), InputError); }

}  // namespace
}  // namespace pliant
