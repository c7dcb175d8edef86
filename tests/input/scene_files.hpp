#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.hpp"

namespace pliant::scene_tests {

/// A scene file in the temporary folder, removed at the end.
class SceneFile {
 public:
  explicit SceneFile(const std::string& text) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    for (char& c : name) c = c == '/' ? '_' : c;
    path_ = std::filesystem::path(::testing::TempDir()) / (name + ".toml");
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~SceneFile() { std::filesystem::remove(path_); }
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A valid scene that uses most tables; tests change one thing in it.
inline const std::string good_scene = R"(title = "Good"
[domain]
period = "10 um"
gravity = ["0 m/s2", -9.81]
[time]
end = "2 us"
tolerance = 1e-2
[discretisation]
method = "mls"
support = 9
[materials.soft]
law = "neo-hookean"
density = "1200 kg/m3"
young = "2 GPa"
poisson = 0.4
[materials.hard]
law = "rigid"
density = 1200
[shapes.disc]
kind = "disc"
diameter = "1 um"
nodes = 168
[shapes.box]
kind = "polygon"
points = [[0, 0], ["1 um", 0], ["1 um", "1 um"], [0, "1 um"]]
spacing = "0.1 um"
[[grains]]
shape = "disc"
packing = { kind = "hexagonal", columns = 10, rows = 4, pitch = "1 um", row_pitch = "1.1 um" }
species = [{ body = "compliant", material = "soft", share = 0.25 }, { body = "rigid", material = "hard", share = 0.75 }]
angle = "random"
seed = 7
[[grains]]
name = "boxes"
shape = "box"
packing = { kind = "positions", positions = [["2 um", "8 um"], ["5 um", "8 um"]] }
body = "compliant"
material = "soft"
angle = "45 deg"
velocity = { uniform = ["1 m/s", "0 m/s"], rotation = "3 rad/s", gradient = [[0, "1 s-1"], [0, 0]] }
[[walls]]
name = "floor"
material = "hard"
solid = "below"
level = "-1 um"
asperities = { diameter = "1 um", count = 10, first = "0.5 um", heights = [0, "0.1 um"], half_angles = ["30 deg", 0.5] }
[[walls]]
name = "lid"
material = "hard"
solid = "above"
level = "12 um"
thickness = "5 um"
x = { velocity = "10 m/s" }
y = { pressure = [["0 us", 0], ["1 us", "1 GPa"]] }
[[contacts]]
between = ["soft", "hard"]
law = "cohesive"
strength = "200 MPa"
[[contacts]]
between = "all"
law = "mohr-coulomb"
friction = 0.3
stiffness = "1e15 Pa/m"
[contact]
skin = 0.4
[[probes]]
name = "drag"
quantity = "friction_factor"
of = "floor"
period = "10 ns"
[frames]
period = "0.1 us"
fields = ["velocity", "von_mises"]
)";

/// The good scene with some texts replaced, each at its first place.
inline std::string edited(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = good_scene;
  for (const auto& [from, to] : changes) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the good scene has no '" + from + "'");
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace pliant::scene_tests
