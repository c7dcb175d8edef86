// The schema is complete: what its scenes ask for is what readers know. All EXACT.
#include "scene/schema.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "scene/names.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;
const fs::path root = PLIANT_SOURCE_DIR;

void read_all(const fs::path& folder, SceneSchema& schema) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") read_scene(entry.path(), &schema);
}

std::string markdown_of(const std::string& text) {
  const scene_tests::SceneFile file(text);
  SceneSchema schema;
  read_scene(file.path(), &schema);
  return schema.markdown();
}

/// A key that only a misspelling check knows, or that no scene of docs/keys and cases asks for, is not documented: add
/// a scene to docs/keys.
TEST(Schema, knows_every_key_and_no_other) {
  SceneSchema schema;
  read_all(root / "docs/keys", schema);
  read_all(root / "cases", schema);
  const std::set<std::string> keys(scene_keys().begin(), scene_keys().end());
  EXPECT_EQ(schema.keys(), keys);
}

TEST(Schema, the_files_of_docs_alone_know_every_key_of_the_cases) {
  SceneSchema documented, used;
  read_all(root / "docs/keys", documented);
  read_all(root / "cases", used);
  for (const std::string& key : used.keys()) EXPECT_TRUE(documented.keys().contains(key)) << key;
}

TEST(Schema, rows_say_what_is_allowed_and_what_holds_without) {
  const std::string text = markdown_of(scene_tests::good_scene);
  for (const char* row : {
           "## [materials.NAME]\n",
           "| `density` | a quantity in kg/m3, > 0 | required |  |\n",
           "| `integrator` | one of \"verlet\", \"step-doubling\" | \"verlet\" |  |\n",
           "| `tolerance` | a number, > 0 and <= 1 | 0.01 |  |\n",
           "| `skin` | a number, > 0 and <= 4 | 0.5 |  |\n",
           "| `stiffness` | \"auto\" or a quantity in Pa/m, > 0 | \"auto\" |  |\n",
           "| `period` | \"never\" or a quantity in s, > 0 | 600 s |  |\n",
           "| `gravity` | [x, y], each a quantity in m/s2 | zero |  |\n",
           "## mix of [[grains]]\n",
       })
    EXPECT_NE(text.find(row), std::string::npos) << row << text;
}

TEST(Schema, a_choice_that_decides_is_named) {
  const std::string text = markdown_of(scene_tests::good_scene);
  EXPECT_NE(text.find("| `strength` | a quantity in Pa, > 0 | required | law = \"cohesive\" |\n"), std::string::npos);
  EXPECT_NE(text.find("| `young` | a quantity in Pa, > 0 | required | law = \"neo-hookean\" |\n"), std::string::npos);
  EXPECT_NE(text.find("| `solid` | one of \"below\", \"above\" | required |  |\n"), std::string::npos);
}

// EXACT: a key with another list of choices in each of several tables has all of them.
TEST(Schema, lists_of_choices_stand_side_by_side) {
  SceneSchema schema;
  const int root = schema.begin_table(top_pattern);
  schema.asked(root, "probes", true);
  for (const char* allowed : {"one of \"a\", \"b\"", "one of \"c\", \"a\"", "one of \"c\""}) {
    const int table = schema.begin_table("[[probes]]");
    schema.asked(table, "reduce", true);
    schema.note(table, "reduce", {"name", allowed, "", true});
  }
  const std::string text = schema.markdown();
  const std::string row = "one of \"a\", \"b\", or one of \"c\", \"a\", or one of \"c\"";
  EXPECT_NE(text.find(row), std::string::npos) << text;
}

TEST(Schema, reading_is_the_same_with_and_without) {
  const scene_tests::SceneFile file(scene_tests::good_scene);
  SceneSchema schema;
  const Scene with = read_scene(file.path(), &schema), without = read_scene(file.path());
  EXPECT_EQ(with.grains.size(), without.grains.size());
  EXPECT_EQ(with.contacts[1].stiffness, without.contacts[1].stiffness);
  EXPECT_EQ(with.walls[1].y.history.value, without.walls[1].y.history.value);
}

}  // namespace
}  // namespace pliant
