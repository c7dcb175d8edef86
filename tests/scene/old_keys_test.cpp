// Old names of keys are read as the new ones, with a warning. All EXACT.
#include "scene/old_keys.hpp"

#include <gtest/gtest.h>

#include "scene/bad_scenes.hpp"
#include "scene/portable_scene.hpp"
#include "scene/scene_keys.hpp"

namespace pliant {
namespace {

using scene_tests::edited;
using scene_tests::good_scene;
using scene_tests::SceneFile;

/// New names as the good scene has them, and old ones.
const std::vector<std::pair<std::string, std::string>> renamed{
    {"method = \"mls\"", "recipe = \"mls\""},
};

TEST(OldKeys, AreReadAsTheNewOnesWithAWarningAtTheirPlace) {
  const std::string text = edited(renamed);
  const SceneFile old(text);
  const Scene scene = read_scene(old.path());
  ASSERT_EQ(scene.warnings.size(), renamed.size());
  EXPECT_EQ(scene.warnings[0], old.path().string() +
                                   ":9:1: 'recipe' in [discretisation] is now called 'method'; the next version will "
                                   "refuse the old name");
  EXPECT_EQ(scene.discretisation.method, DiscretisationMethod::mls);
  EXPECT_EQ(scene_difference(text, good_scene), "");
  EXPECT_EQ(start_difference(text, good_scene), "");
  EXPECT_EQ(place_of_key(text, "discretisation.method"), "9:10");
}

TEST(OldKeys, HaveNoWarningUnderTheirNewNames) {
  const SceneFile file(good_scene);
  EXPECT_TRUE(read_scene(file.path()).warnings.empty());
}

TEST(OldKeys, AreRefusedBesideTheNewOnes) {
  scene_tests::expect_refused({"", "method = 'mls'", "method = 'mls'\nrecipe = 'mls'", "recipe",
                               "'recipe' in [discretisation] is the old name of 'method' ... remove one"});
}

// A mistake in the value of an old key is told at its place.
TEST(OldKeys, KeepThePlaceOfTheirValues) {
  scene_tests::expect_refused({"", "method = 'mls'", "recipe = 'msl'", "'msl'", "'method' in [discretisation]"});
}

}  // namespace
}  // namespace pliant
