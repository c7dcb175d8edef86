#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bad_scenes.hpp"
#include "core/errors.hpp"
#include "input/read_scene.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

using scene_tests::good_scene;
using scene_tests::SceneFile;

// EXACT throughout: what the file says, in SI. EXPECT_DOUBLE_EQ (4 roundings) where a unit is converted.

TEST(ReadScene, Settings) {
  const SceneFile file(good_scene);
  const Scene scene = read_scene(file.path());
  EXPECT_EQ(scene.title, "Good");
  EXPECT_EQ(scene.name, "ReadScene_Settings");
  EXPECT_EQ(scene.file, file.path());
  EXPECT_DOUBLE_EQ(*scene.period, 10e-6);
  EXPECT_EQ(scene.gravity, Vec2(0, -9.81));
  EXPECT_DOUBLE_EQ(scene.time.end, 2e-6);
  EXPECT_EQ(scene.time.integrator, Integrator::verlet);
  EXPECT_EQ(scene.time.safety, TimeSettings{}.safety);
  EXPECT_EQ(scene.skin, 0.4);
  EXPECT_DOUBLE_EQ(scene.probes.at(0).period, 1e-8);
  EXPECT_EQ(scene.probes.at(0).of, "floor");
  EXPECT_EQ(scene.frames.fields, (std::vector<std::string>{"velocity", "von_mises"}));
}

TEST(ReadScene, ProbesTakeTheirSettings) {
  // EXACT
  std::string text = good_scene;
  text.replace(text.find("[frames]"), 0, R"(
[[probes]]
name = "squeezed"
quantity = "contact_pressure"
of = "boxes 1"
with = "compliant"
reduce = "max"
period = "1 us"
[[probes]]
name = "corner"
quantity = "displacement"
of = "boxes 0"
node = 4
period = "1 us"
[[probes]]
name = "dense"
quantity = "solid_fraction"
of = "all"
box = [[0, "1 um"], ["5 um", 4e-6]]
period = "1 us"
[[probes]]
name = "denser"
quantity = "solid_fraction"
of = "rigid"
between = ["lid", "floor"]
period = "1 us"
)");
  const SceneFile file(text);
  const Scene scene = read_scene(file.path());
  EXPECT_EQ(scene.probes.at(1).of, "boxes 1");
  EXPECT_EQ(scene.probes.at(1).with, "compliant");
  EXPECT_EQ(scene.probes.at(1).reduce, Reduction::max);
  EXPECT_FALSE(scene.probes.at(1).node);
  EXPECT_EQ(scene.probes.at(2).node, 4);
  EXPECT_FALSE(scene.probes.at(2).reduce);
  EXPECT_NEAR((scene.probes.at(3).box->low - Vec2(0, 1e-6)).norm(), 0, 1e-20) << "a rounding of 1e-6 is 1e-22";
  EXPECT_NEAR((scene.probes.at(3).box->high - Vec2(5e-6, 4e-6)).norm(), 0, 1e-20);
  EXPECT_EQ(scene.probes.at(4).between, (std::vector<std::string>{"lid", "floor"}));
}

TEST(ReadScene, MaterialsKeepTheOrderOfTheFile) {
  const Scene scene = read_scene(SceneFile(good_scene).path());
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].name, "soft");
  EXPECT_EQ(scene.materials[0].young, 2e9);
  EXPECT_EQ(scene.materials[0].poisson, 0.4);
  EXPECT_EQ(scene.materials[1].law, MaterialLaw::rigid);
  EXPECT_EQ(scene.materials[1].density, 1200);
  EXPECT_EQ(scene.shapes[0].nodes, 168);
  EXPECT_FALSE(scene.shapes[0].spacing);
  EXPECT_DOUBLE_EQ(*scene.shapes[1].spacing, 1e-7);
}

TEST(ReadScene, Grains) {
  const Scene scene = read_scene(SceneFile(good_scene).path());
  ASSERT_EQ(scene.grains.size(), 2u);
  EXPECT_EQ(scene.grains[0].name, "grains");
  EXPECT_EQ(scene.grains[0].seed, 7u);
  EXPECT_FALSE(scene.grains[0].angle);
  EXPECT_EQ(scene.grains[0].species[1].body, BodyKind::rigid);
  EXPECT_EQ(scene.grains[0].species[1].share, 0.75);
  const Grains& boxes = scene.grains[1];
  EXPECT_DOUBLE_EQ(*boxes.angle, std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(boxes.packing.positions.at(1).x(), 5e-6);
  EXPECT_EQ(boxes.velocity.uniform, Vec2(1, 0));
  EXPECT_EQ(boxes.velocity.rotation, 3);
  EXPECT_EQ(boxes.velocity.gradient(0, 1), 1);
  EXPECT_EQ(boxes.velocity.gradient(1, 0), 0);
}

TEST(ReadScene, WallsAndContacts) {
  const Scene scene = read_scene(SceneFile(good_scene).path());
  EXPECT_EQ(scene.walls[0].x.mode, AxisCondition::Mode::fixed);
  EXPECT_EQ(scene.walls[0].asperities->count, 10);
  EXPECT_DOUBLE_EQ(scene.walls[0].asperities->half_angles[0], std::numbers::pi / 6);
  EXPECT_EQ(scene.walls[1].x.history.at(1), 10);
  EXPECT_EQ(scene.walls[1].y.mode, AxisCondition::Mode::pressure);
  EXPECT_DOUBLE_EQ(scene.walls[1].y.history.at(0.5e-6), 0.5e9);
  EXPECT_EQ(scene.contacts[0].strength, 200e6);
  EXPECT_FALSE(scene.contacts[0].stiffness);
  EXPECT_EQ(scene.contacts[1].first, "all");
  EXPECT_EQ(scene.contacts[1].friction, 0.3);
  EXPECT_EQ(*scene.contacts[1].stiffness, 1e15);
}

std::string replaced(std::string text, const std::string& from, const std::string& to);

TEST(ReadScene, ContactSettingsAndLaws) {
  std::string text =
      replaced(good_scene, "skin = 0.4", "skin = 0.4\nlength = \"current\"\nself_contact = true\nrefresh = \"2 ns\"");
  text = replaced(text, "between = \"all\"", "between = [\"hard\", \"hard\"]");
  text = replaced(text, "friction = 0.3", "friction = 0.3\nrestitution = 0.5\npull = true");
  text = replaced(text, "[contact]\n",
                  "[[contacts]]\nbetween = [\"soft\", \"soft\"]\nlaw = \"frictionless\"\n[contact]\n");
  const Scene scene = read_scene(SceneFile(text).path());
  EXPECT_EQ(scene.contact.length, ContactLength::current);
  EXPECT_TRUE(scene.contact.self_contact);
  EXPECT_DOUBLE_EQ(scene.contact.refresh_period, 2e-9);
  EXPECT_EQ(scene.contact.refresh_steps, 0);
  EXPECT_EQ(*scene.contacts[1].restitution, 0.5);
  EXPECT_TRUE(scene.contacts[1].pull);
  EXPECT_EQ(read_scene(SceneFile(replaced(good_scene, "skin = 0.4", "refresh = 30")).path()).contact.refresh_steps, 30);
  const Scene plain = read_scene(SceneFile(replaced(good_scene, "skin = 0.4", "refresh = \"safe\"")).path());
  EXPECT_EQ(plain.contact.refresh_steps, 0);
  EXPECT_EQ(plain.contact.refresh_period, 0);
  EXPECT_FALSE(plain.contact.self_contact);
}

TEST(ReadScene, AFrictionAngleIsItsTangent) {
  const auto friction = [](const std::string& value) {
    return read_scene(SceneFile(replaced(good_scene, "friction = 0.3", "friction = " + value)).path())
        .contacts.at(1)
        .friction;
  };
  // Two roundings, of the unit's factor and of the tangent.
  EXPECT_NEAR(friction("\"45 deg\""), 1, 1e-15);
  EXPECT_NEAR(friction("\"30°\""), 1 / std::numbers::sqrt3, 1e-15);
  EXPECT_NEAR(friction("\"0.5 rad\""), std::tan(0.5), 1e-15);
  EXPECT_EQ(friction("\"0 deg\""), 0);
  EXPECT_EQ(friction("\"0.7\""), 0.7);
  EXPECT_NEAR(friction("\"70 %\""), 0.7, 1e-15);
  EXPECT_EQ(friction("2"), 2);
}

TEST(ReadScene, WarnsOfAnglesThatMayBeDegrees) {
  const auto warnings = [](const std::string& angle) {
    return read_scene(SceneFile(replaced(good_scene, "angle = \"45 deg\"", "angle = " + angle)).path()).warnings;
  };
  for (const char* meant : {"6.28", "-6.28", "\"6.28\"", "\"45 rad\"", "\"4500 deg\""})
    EXPECT_TRUE(warnings(meant).empty()) << meant;
  for (const char* doubtful : {"45", "45.0", "-45", "\"45\""}) {
    const std::vector<std::string> all = warnings(doubtful);
    ASSERT_EQ(all.size(), 1u) << doubtful;
    EXPECT_NE(all[0].find(".toml:39:9: 'angle' in [[grains]] 2: found "), std::string::npos) << all[0];
    EXPECT_NE(all[0].find("read as radians; did you mean \""), std::string::npos) << all[0];
    EXPECT_NE(all[0].find("45 deg\"?"), std::string::npos) << all[0];
  }
}

// EXACT: a coefficient that is likelier an angle is warned of, no other.
TEST(ReadScene, WarnsOfFrictionThatSeemsToBeInDegrees) {
  const auto warnings = [](const std::string& friction) {
    const SceneFile file(replaced(good_scene, "friction = 0.3", "friction = " + friction));
    return read_scene(file.path()).warnings;
  };
  for (const char* meant : {"2", "0", "90", "1e6", "\"89 deg\""}) EXPECT_TRUE(warnings(meant).empty()) << meant;
  const std::vector<std::string> all = warnings("30");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_NE(all[0].find("which is a coefficient, of 88.1 deg; did you mean \"30 deg\"?"), std::string::npos) << all[0];
  EXPECT_NE(all[0].find(".toml:"), std::string::npos) << all[0];
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ReadScene, ClockwisePolygonsAreReversed) {
  const std::string clockwise = replaced(good_scene, R"([[0, 0], ["1 um", 0], ["1 um", "1 um"], [0, "1 um"]])",
                                         R"([[0, "1 um"], ["1 um", "1 um"], ["1 um", 0], [0, 0]])");
  EXPECT_EQ(read_scene(SceneFile(clockwise).path()).shapes[1].points,
            read_scene(SceneFile(good_scene).path()).shapes[1].points);
}

// EXACT: the last point may be the first, written alike, in another unit or off by rounding.
TEST(ReadScene, PolygonsMayEndWhereTheyBegin) {
  const std::string corners = R"([0, "1 um"]])";
  const Points expected = read_scene(SceneFile(good_scene).path()).shapes[1].points;
  for (const char* last : {"[0, 0]", "[\"0 mm\", \"0 mm\"]", "[1e-22, -1e-22]"}) {
    const std::string closed = replaced(good_scene, corners, R"([0, "1 um"], )" + std::string(last) + "]");
    EXPECT_EQ(read_scene(SceneFile(closed).path()).shapes[1].points, expected) << last;
  }
}

// EXACT
TEST(ReadScene, AByteOrderMarkIsNoText) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(read_scene(SceneFile(mark + good_scene).path()).title, "Good");
  EXPECT_TRUE(scene_tests::error_of(mark + "titel = 1\n" + good_scene.substr(good_scene.find('\n')))
                  .starts_with("1:1: unknown key 'titel'"));
}

TEST(ReadScene, RowPitchFollowsFromThePitch) {
  const std::string hexagonal = replaced(good_scene, R"(, row_pitch = "1.1 um")", "");
  EXPECT_DOUBLE_EQ(read_scene(SceneFile(hexagonal).path()).grains[0].packing.row_pitch, 2e-6 / std::sqrt(3.0));
  const std::string grid = replaced(hexagonal, "hexagonal", "grid");
  EXPECT_DOUBLE_EQ(read_scene(SceneFile(grid).path()).grains[0].packing.row_pitch, 1e-6);
}

TEST(ReadScene, StepDoublingHasItsOwnKeys) {
  const std::string text = replaced(good_scene, "tolerance = 1e-2", "integrator = \"step-doubling\"\ntarget = 1e-5");
  const Scene scene = read_scene(SceneFile(text).path());
  EXPECT_EQ(scene.time.integrator, Integrator::step_doubling);
  EXPECT_EQ(scene.time.target, 1e-5);
  EXPECT_EQ(scene.time.alpha, 2);
}

TEST(ReadScene, FilesThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      read_scene(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message("/no/such/scene.toml"), "/no/such/scene.toml: no such file; check the path");
  EXPECT_NE(message(::testing::TempDir()).find("is a folder"), std::string::npos);
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
    const SceneFile file(mark + std::string("t\0", 2));
    EXPECT_EQ(message(file.path()), file.path().string() + ": is UTF-16; allowed: UTF-8, save it as that");
  }
  const SceneFile empty("");
  EXPECT_EQ(message(empty.path()), empty.path().string() + ":1:1: the file is empty; see cases/ for examples");
  const SceneFile blank(" \n\t\r\n");
  EXPECT_NE(message(blank.path()).find(":1:1: the file is empty"), std::string::npos);
  for (const std::string& garbage : {std::string("\x7f"
                                                 "ELF\x02\x01\x00\x00",
                                                 8),
                                     std::string("\xff\xfd"), std::string(1000, '\0'), std::string(10000, '[')}) {
    const SceneFile file(garbage);
    EXPECT_TRUE(message(file.path()).starts_with(file.path().string() + ":1:")) << message(file.path());
    EXPECT_NE(message(file.path()).find("not valid TOML"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
