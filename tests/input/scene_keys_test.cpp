// The table of scene keys is what readers ask for, default by default. All EXACT. The reader itself refuses a key
// without a row, a default or a condition that the row gives otherwise.
#include "input/scene_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "input/read_scene.hpp"
#include "input/table_reader.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

namespace fs = std::filesystem;

KeyUse use_of(const std::string& folder) {
  KeyUse use;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(PLIANT_SOURCE_DIR) / folder))
    if (entry.path().extension() == ".toml") read_scene(entry.path(), &use);
  return use;
}

// A row that no scene of docs/keys asks for, or not both with and without a default where it says so, is not checked
// by anything: add a scene.
TEST(SceneKeys, EveryRowIsAskedForByTheScenesOfTheDocs) {
  const KeyUse use = use_of("docs/keys");
  for (const SceneTable& table : scene_tables())
    for (const SceneKey& row : table.keys) {
      const std::string name = row.name + " in " + table.title + " with " + row.with;
      const bool tables = std::holds_alternative<SubTable>(row.kind);
      if (!row.otherwise.value.empty() && !tables) EXPECT_TRUE(use.contains({&row, false})) << name;
      if (!row.otherwise.required.empty() && !tables) EXPECT_TRUE(use.contains({&row, true})) << name;
      if (tables) EXPECT_TRUE(use.contains({&row, false}) || use.contains({&row, true})) << name;
    }
}

TEST(SceneKeys, CasesAgreeWithTheTable) { EXPECT_FALSE(use_of("cases").empty()); }

TEST(SceneKeys, RowsSayInAFewWordsWhatTheKeyIs) {
  for (const SceneTable& table : scene_tables())
    for (const SceneKey& row : table.keys) {
      const auto blanks = std::count(row.meaning.begin(), row.meaning.end(), ' ');
      EXPECT_TRUE(!row.meaning.empty() && blanks < 15) << row.name << ": " << row.meaning;
    }
}

// The reader compares all other defaults with their fields.
TEST(SceneKeys, DefaultsThatReadersDeriveAreThese) {
  std::string keys;
  for (const SceneTable& table : scene_tables())
    for (const SceneKey& row : table.keys)
      if (row.otherwise.derived) keys += row.name + " in " + table.title + ": " + row.otherwise.value + "\n";
  EXPECT_EQ(keys,
            "title in Top level: name of the file\n"
            "name in [[grains]]: \"grains\", \"grains2\", ...\n"
            "row_pitch in packing of [[grains]]: `pitch`; hexagonal: 2/sqrt(3) `pitch`\n"
            "spacing in [[walls]]: finest of the grains\n"
            "from in x of [[walls]]: start of the run\n"
            "until in x of [[walls]]: end of the run\n"
            "from in y of [[walls]]: start of the run\n"
            "until in y of [[walls]]: end of the run\n"
            "from in [[boundary]]: start of the run\n"
            "until in [[boundary]]: end of the run\n"
            "from in x of [[boundary]]: start of the run\n"
            "until in x of [[boundary]]: end of the run\n"
            "from in y of [[boundary]]: start of the run\n"
            "until in y of [[boundary]]: end of the run\n"
            "from in angle of [[boundary]]: start of the run\n"
            "until in angle of [[boundary]]: end of the run\n"
            "shear_fatigue_rate in [[bonds]]: `fatigue_rate`\n");
}

TEST(SceneKeys, DerivedDefaultsHold) {
  const scene_tests::SceneFile file(scene_tests::edited({{"title = \"Good\"\n", ""},
                                                         {", row_pitch = \"1.1 um\"", ""},
                                                         {"[contact]\n",
                                                          "[[bonds]]\nbetween = \"all\"\nstrength = 2\n"
                                                          "fracture_energy = 1\nfatigue_rate = 3\n"
                                                          "fatigue_threshold = 1\n[contact]\n"}}));
  const Scene scene = read_scene(file.path());
  EXPECT_EQ(scene.title, file.path().stem().string());
  EXPECT_EQ(scene.grains[0].name, "grains");
  EXPECT_DOUBLE_EQ(scene.grains[0].packing.row_pitch, 1e-6 * 2 / std::sqrt(3.0));
  EXPECT_EQ(scene.bonds[0].shear_fatigue_rate, 3);
  EXPECT_TRUE(scene.walls[0].x.window.always());
}

TEST(SceneKeys, RowsArePrinted) {
  const std::string text = scene_key_tables();
  for (const char* row : {
           "## [materials.NAME]\n",
           "| `density` | Mass density of the undeformed material | a quantity in kg/m3, > 0 | required |  |\n",
           "| `tolerance` | Error estimate allowed per step, over the nodal distance | a number, > 0 and <= 1 | 0.01 | "
           "integrator = \"verlet\" |\n",
           "| `material` | Material of the grains | a material of the scene | required without `species` |  |\n",
           "## species of [[grains]]\n",
       })
    EXPECT_NE(text.find(row), std::string::npos) << row << text;
}

TEST(SceneKeys, NamesAreOnesOfTheTable) {
  EXPECT_TRUE(is_scene_key("density"));
  for (const char* word : {"densty", "", " ", "x y", "alpha angle"}) EXPECT_FALSE(is_scene_key(word)) << word;
}

// What disagrees with the table is a mistake of the program, not of the user.
TEST(SceneKeys, ReadersThatDisagreeFail) {
  const toml::table text = toml::parse("[time]\nend = 1\nintegrator = \"step-doubling\"");
  const Source source{"scene.toml"};
  const auto time = [&] { return TableReader(text, source).required_table("time"); };
  TableReader table = time();
  TimeSettings read;
  int wrong_type = 0;
  EXPECT_THROW(table.has("colour"), std::logic_error);
  EXPECT_THROW(table.optional("end", read.end), std::logic_error) << "required";
  EXPECT_THROW(table.required("end", wrong_type), std::logic_error);
  read.stop_at_outputs = true;
  EXPECT_THROW(table.optional("stop_at_outputs", read.stop_at_outputs), std::logic_error) << "another default";
  EXPECT_THROW(table.optional("tolerance", read.tolerance), std::logic_error) << "before its condition";
  table.required("end", read.end);
  table.optional("integrator", read.integrator);
  EXPECT_THROW(table.optional("tolerance", read.tolerance), std::logic_error) << "against its condition";
  EXPECT_THROW(table.finish(), std::logic_error) << "target is not read";
}

}  // namespace
}  // namespace pliant
