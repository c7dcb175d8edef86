// Old names of keys are read as the new ones, with a warning. All EXACT.
#include "input/old_keys.hpp"

#include <gtest/gtest.h>

#include "input/bad_scenes.hpp"
#include "input/portable_scene.hpp"
#include "input/read_scene.hpp"
#include "input/scene_difference.hpp"
#include "input/scene_keys.hpp"

namespace pliant {
namespace {

using scene_tests::edited;
using scene_tests::good_scene;
using scene_tests::SceneFile;

struct Renamed {
  std::string now, formerly;
};
const std::vector<Renamed> keys{
    {"method", "recipe"}, {"asperities", "caps"}, {"species", "mix"}, {"species_order", "mix_order"}};

/// The good scene with all of these keys, by their present or their old names.
std::string scene_by_names(std::string Renamed::* name) {
  std::string text = edited({{"seed = 7", "seed = 7\nspecies_order = \"random\""}});
  for (const Renamed& key : keys) text.replace(text.find("\n" + key.now + " =") + 1, key.now.size(), key.*name);
  return text;
}

TEST(OldKeys, AreReadAsTheNewOnesWithAWarningAtTheirPlace) {
  const std::string text = scene_by_names(&Renamed::formerly), present = scene_by_names(&Renamed::now);
  const SceneFile old(text);
  const Scene scene = read_scene(old.path());
  ASSERT_EQ(scene.warnings.size(), keys.size());
  EXPECT_EQ(scene.warnings[0], old.path().string() +
                                   ":9:1: 'recipe' in [discretisation] is now called 'method'; the next version will "
                                   "refuse the old name");
  EXPECT_EQ(scene_difference(text, present), "");
  EXPECT_EQ(start_difference(text, present), "");
  EXPECT_EQ(place_of_key(text, "discretisation.method"), "9:10");
}

// The list of keys above is that of the table.
TEST(OldKeys, AreAllTried) {
  std::size_t rows = 0;
  for (const SceneTable& table : scene_tables())
    for (const SceneKey& row : table.keys) rows += row.formerly.empty() ? 0 : 1;
  EXPECT_EQ(rows, keys.size());
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
