#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/errors.hpp"
#include "geometry/curves.hpp"
#include "geometry/polygon_rules.hpp"
#include "input/read_scene.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

using scene_tests::good_scene;
using scene_tests::SceneFile;

/// The good scene with some of its text replaced.
Scene scene_changed(std::vector<std::pair<std::string, std::string>> changes) {
  std::string text = good_scene;
  for (const auto& [from, to] : changes) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return read_scene(SceneFile(text).path());
}

const std::string disc = "kind = \"disc\"\ndiameter = \"1 um\"";
const std::string pebble = "kind = \"fourier\"\ndiameter = \"1 um\"\ndescriptors = [0.1, 0.05]\nseed = 7";
const std::string lattice = "kind = \"hexagonal\", columns = 10, rows = 4, pitch = \"1 um\", row_pitch = \"1.1 um\"";

// EXACT throughout.

TEST(ReadPacking, ShapesOutOfRangeAndPartsThatAMeshLacks) {
  const auto message_of = [](const std::string& shape) {
    try {
      scene_changed({{disc, shape}});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string far = message_of("kind = \"polygon\"\npoints = [[0, 0], [1e200, 0], [1e200, 1e200]]");
  EXPECT_NE(far.find("'points' in [shapes.disc]: point 2 is out of range; allowed: coordinates of at most 1e+12 m"),
            std::string::npos)
      << far;
  const std::filesystem::path mesh = std::filesystem::path(::testing::TempDir()) / "read_packing_parts.msh";
  std::ofstream(mesh) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"left\"\n$EndPhysicalNames\n"
                         "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
                         "$Elements\n1\n1 2 2 7 1 1 2 3\n$EndElements\n";
  const std::string lacks = message_of("kind = \"file\"\nfile = \"" + mesh.string() + "\"\nparts = \"lft\"");
  EXPECT_NE(lacks.find(".toml:"), std::string::npos) << lacks;
  EXPECT_NE(lacks.find("'parts' in [shapes.disc]: " + mesh.string() + ": no part \"lft\""), std::string::npos) << lacks;
}

TEST(ReadPacking, AFilesDoubtfulAnglesAndPlacesTooFarOff) {
  const auto with_file = [](const std::string& rows) {
    const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "read_packing_far.csv";
    std::ofstream(file) << rows;
    return scene_changed(
        {{lattice, "kind = \"file\", file = \"" + file.string() + "\""}, {"angle = \"random\"\nseed", "seed"}});
  };
  const std::vector<std::string> warnings = with_file("x [um],y [um],angle\n1,1,0\n3,3,30\n").warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("read_packing_far.csv:3: column angle: found 30"), std::string::npos) << warnings[0];
  EXPECT_NO_THROW(with_file("x,y\n1e-6,900\n"));
  try {
    with_file("x,y\n1e-6,1e-6\n1e-6,-1100\n");
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("read_packing_far.csv:3: the grain, 1e-06 m wide, lies 1.1e+03 m"), std::string::npos)
        << message;
  }
}

TEST(ReadPacking, VariantsAreShapesOfTheirOwn) {
  const Scene scene = scene_changed({{disc, pebble + "\nvariants = 3"}});
  ASSERT_EQ(scene.shapes.size(), 4U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.shapes[i].name, "disc." + std::to_string(i + 1));
    EXPECT_EQ(scene.shapes[i].family, "disc");
    EXPECT_EQ(scene.shapes[i].points, fourier_grain(1e-6, {0.1, 0.05}, 7 + static_cast<int>(i)));
    EXPECT_EQ(scene.shapes[i].nodes, 168);
  }
  EXPECT_EQ(scene.shape("disc.2").points, scene.shapes[1].points);
  const auto shares = scene.shape_shares(scene.grains[0]);
  ASSERT_EQ(shares.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(shares[i].first, static_cast<int>(i));
    EXPECT_DOUBLE_EQ(shares[i].second, 1.0 / 3);
  }
  EXPECT_EQ(scene_changed({{disc, pebble}}).shapes[0].name, "disc") << "without variants it has no family";
}

TEST(ReadPacking, SeveralShapes) {
  const Scene scene = scene_changed(
      {{disc, pebble + "\nvariants = 2"},
       {"shape = \"disc\"\n", "shapes = [{ shape = \"box\", share = 0.4 }, { shape = \"disc\", share = 0.6 }]\n"}});
  const auto shares = scene.shape_shares(scene.grains[0]);
  const std::vector<std::pair<int, double>> expected{{2, 0.4}, {0, 0.3}, {1, 0.3}};
  EXPECT_EQ(shares, expected);
}

TEST(ReadPacking, OrderOfAMix) {
  EXPECT_EQ(scene_changed({}).grains[0].species_order, SpeciesOrder::random);
  EXPECT_EQ(scene_changed({{"seed = 7", "seed = 7\nspecies_order = \"random\""}}).grains[0].species_order,
            SpeciesOrder::random);
  EXPECT_EQ(scene_changed({{"seed = 7", "seed = 7\nspecies_order = \"in turn\""}}).grains[0].species_order,
            SpeciesOrder::in_turn);
  const Scene unseeded = scene_changed({{"angle = \"random\"\nseed = 7", "species_order = \"in turn\""}});
  EXPECT_EQ(unseeded.grains[0].species_order, SpeciesOrder::in_turn) << "nothing is random, so no seed is needed";
}

TEST(ReadPacking, FittedShapesKeepTheirDescriptors) {
  const Scene scene =
      scene_changed({{disc, pebble + "\nvariants = \"each\""},
                     {lattice, "kind = \"fourier-voronoi\", bottom = 0, top = \"7 um\", solid_fraction = 0.5"},
                     {"angle = \"random\"\n", ""}});
  EXPECT_EQ(scene.shapes[0].descriptors, (std::vector<double>{0.1, 0.05}));
  EXPECT_EQ(scene.grains[0].packing.count, std::lround(0.5 * 70 / (std::numbers::pi / 4)));
  EXPECT_FALSE(scene.grains[0].angle);
}

TEST(ReadPacking, CountsFollowSolidFractionAndSizes) {
  const std::string sizes = "seed = 7\nsize = { distribution = \"uniform\", low = 0.5, high = 1.5 }";
  const Scene scene = scene_changed(
      {{lattice, "kind = \"random\", bottom = \"-2 um\", top = \"5 um\", solid_fraction = 0.6"}, {"seed = 7", sizes}});
  const Packing& packing = scene.grains[0].packing;
  EXPECT_EQ(packing.kind, PackingKind::random);
  EXPECT_DOUBLE_EQ(packing.right, 10e-6);
  EXPECT_DOUBLE_EQ(packing.bottom, -2e-6);
  // Mean of size^2: 1 + 1/12.
  EXPECT_EQ(packing.count, std::lround(0.6 * 70 / (std::numbers::pi / 4 * 13 / 12)));
  EXPECT_EQ(packing.grain_count(), packing.count);
  EXPECT_EQ(scene.grains[0].size.kind, SizeDistribution::Kind::uniform);
  const Scene counted = scene_changed({{lattice, "kind = \"random\", bottom = 0, top = \"5 um\", count = 12"}});
  EXPECT_EQ(counted.grains[0].packing.grain_count(), 12);
  EXPECT_FALSE(counted.grains[0].packing.solid_fraction);
}

TEST(ReadPacking, RoundedPolygonsAreCurves) {
  const Scene scene =
      scene_changed({{"[0, \"1 um\"]]", "[0, \"1 um\"]]\nrounding = \"0.2 um\""},
                     {disc, "kind = \"regular\"\nsides = 4\ndiameter = \"1 um\"\nrounding = \"0.1 um\""}});
  EXPECT_EQ(scene.shapes[0].kind, ShapeKind::curve);
  EXPECT_EQ(scene.shapes[1].kind, ShapeKind::curve);
  EXPECT_NEAR(signed_area(scene.shapes[1].points), (1 - (4 - std::numbers::pi) * 0.04) * 1e-12, 1e-24);
  EXPECT_NEAR(signed_area(scene.shapes[0].points), (0.5 - (4 - std::numbers::pi) * 0.01) * 1e-12, 1e-24);
}

/// A file with the outline of a quarter of a square, beside the scenes of these tests.
struct Quarter {
  std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "quarter.csv";
  Quarter() { std::ofstream(path) << "x,y\n0,0\n4,0\n4,4\n"; }
  ~Quarter() { std::filesystem::remove(path); }
};

TEST(ReadPacking, OutlinesFromFiles) {
  const Quarter quarter;
  const std::string file = "kind = \"file\"\nfile = \"quarter.csv\"\n";
  const Scene own = scene_changed({{disc, file + "unit = \"um\""}});
  EXPECT_EQ(own.shapes[0].kind, ShapeKind::polygon);
  EXPECT_NEAR(signed_area(own.shapes[0].points), 8e-12, 1e-26);
  const Scene scaled = scene_changed({{disc, file + "diameter = \"1 um\"\noutline = \"curve\""}});
  EXPECT_EQ(scaled.shapes[0].kind, ShapeKind::curve);
  EXPECT_NEAR(signed_area(scaled.shapes[0].points), std::numbers::pi / 4 * 1e-12, 1e-26);
}

/// A text beside the scenes of these tests.
struct Beside {
  std::filesystem::path path;
  Beside(const char* name, const std::string& text) : path(std::filesystem::path(::testing::TempDir()) / name) {
    std::ofstream(path) << text;
  }
  ~Beside() { std::filesystem::remove(path); }
};

const std::string positions = "kind = \"positions\", positions = [[\"2 um\", \"8 um\"], [\"5 um\", \"8 um\"]]";

TEST(ReadPacking, GrainsFromAFile) {
  const Beside file("grains_from_a_file.csv", "x,y,scale\n1,2,0.5\n3,4,9.9\n");
  const std::string from_file = "kind = \"file\", file = \"grains_from_a_file.csv\", unit = \"um\"";
  const Packing packing = scene_changed({{lattice, from_file}}).grains[0].packing;
  EXPECT_EQ(packing.kind, PackingKind::positions);
  EXPECT_EQ(packing.positions, (Points{Vec2(1, 2) * 1e-6, Vec2(3, 4) * 1e-6}));
  EXPECT_EQ(packing.scales, (std::vector<double>{0.5, 9.9}));
  EXPECT_EQ(packing.grain_count(), 2);
  EXPECT_EQ(scene_changed({{lattice, from_file}, {"angle = \"random\"\nseed = 7", "species_order = \"in turn\""}})
                .grains.size(),
            2U);
}

TEST(ReadPacking, FilesThatSayTooMuchAreRefused) {
  const auto message = [](const std::vector<std::pair<std::string, std::string>>& changes) -> std::string {
    try {
      scene_changed(changes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const auto expect = [&](const std::string& found, const std::string& phrase) {
    EXPECT_NE(found.find(phrase), std::string::npos) << found;
  };
  const Beside file("too_much.csv", "x [um],y [um],diameter [um],angle\n1,2,3,0\n3,4,10,0.1\n");
  const std::string from_file = "kind = \"file\", file = \"too_much.csv\"";
  const std::string size = "seed = 7\nsize = { distribution = \"uniform\", low = 0.5, high = 1 }";
  expect(message({{lattice, from_file}}),
         "too_much.csv:3: the extent of the grain is 1e-05 m; allowed: less than the period");
  expect(message({{lattice, from_file + ", unit = \"mm\""}}), "too_much.csv:1: column x has a unit");
  expect(message({{positions, from_file}}), "too_much.csv:3: the extent of the grain is 1.25331e-05 m");
  const std::string wide = "period = \"10 um\"", wider = "period = \"20 um\"";
  expect(message({{wide, wider}, {lattice, from_file}}), "'angle' in [[grains]] 1: both it and the column angle");
  expect(message({{wide, wider}, {lattice, from_file}, {"angle = \"random\"\nseed = 7", size}}),
         "'size' in [[grains]] 1: both it and the sizes of the packing's file");
  expect(message({{wide, wider},
                  {positions, from_file},
                  {"angle = \"random\"\n", ""},
                  {"angle = \"45 deg\"\n", ""},
                  {"neo-hookean", "linear-elastic"}}),
         "'packing' in [[grains]] 2: an angle in its file: the law \"linear-elastic\"");
}

TEST(ReadPacking, InPlaceIsWhereThePointsLie) {
  const std::string corners = R"([[0, 0], ["1 um", 0], ["1 um", "1 um"], [0, "1 um"]])";
  const std::string moved = R"([["4 um", "6 um"], ["5 um", "6 um"], ["5 um", "7 um"], ["4 um", "7 um"]])";
  const Scene scene = scene_changed(
      {{positions, "kind = \"in place\", origin = [0, \"1 um\"]"}, {corners, moved}, {"angle = \"45 deg\"\n", ""}});
  const Packing& packing = scene.grains[1].packing;
  ASSERT_EQ(packing.positions.size(), 1U);
  EXPECT_NEAR((packing.positions[0] - Vec2(4.5e-6, 7.5e-6)).norm(), 0, 1e-20);
  EXPECT_EQ(packing.shapes, (std::vector<int>{1}));
}

}  // namespace
}  // namespace pliant
