// Places, sizes and angles of grains from a file. All EXACT.
#include "scene/grain_file.hpp"

#include <numbers>

#include "scene/outline_files.hpp"

namespace pliant {
namespace {

using namespace scene_tests;
using Numbers = std::vector<double>;

GrainFile read(const std::string& text, const std::string& unit = "") {
  const TextFile file(".csv", text);
  return read_grain_file(file.path, unit, 3);
}

std::string error_of(const std::string& text, const std::string& unit = "") {
  return refusal(".csv", text, [&](const std::filesystem::path& path) { read_grain_file(path, unit, 3); });
}

TEST(GrainFile, ColumnsInAnyOrderWithTheirUnits) {
  const GrainFile all =
      read("# a box\nAngle [deg]; X [mm]; y [cm]; diameter [um]\r\n\r\n90;1;2;500\r\n-180;3;4;250 # last\r\n");
  EXPECT_EQ(all.positions, (Points{{1e-3, 0.02}, {3e-3, 0.04}}));
  EXPECT_EQ(all.diameters, (Numbers{500 * 1e-6, 250 * 1e-6}));
  EXPECT_DOUBLE_EQ(all.angles[0], std::numbers::pi / 2);
  EXPECT_TRUE(all.scales.empty());
  EXPECT_EQ(all.lines, (std::vector<int>{4, 5}));
  const GrainFile plain = read("1 2\n3\t4\n", "mm");
  EXPECT_EQ(plain.positions, (Points{{1e-3, 2e-3}, {3e-3, 4e-3}}));
  EXPECT_TRUE(plain.angles.empty() && plain.scales.empty() && plain.diameters.empty());
  const GrainFile scaled = read("\xEF\xBB\xBFx,y,scale,angle\n1,2,0.5,0.25\n", "mm");
  EXPECT_EQ(scaled.scales, Numbers{0.5});
  EXPECT_EQ(scaled.angles, Numbers{0.25}) << "rad, whatever the unit of length";
  EXPECT_EQ(read("x,y,radius\n1,2,3\n").diameters, Numbers{6});
}

TEST(GrainFile, BadFilesAreRefusedWithTheirLine) {
  expect_refused(error_of(""), "1: no grains", "at least one line");
  expect_refused(error_of("x,y\n# none\n"), "2: no grains", "at least one line");
  expect_refused(error_of("1,2,3\n"), "1: found 3 columns without names", "diameter [mm]");
  expect_refused(error_of("x,y,diametre\n1,2,3\n"), "1: unknown column \"diametre\"", "nearest: diameter");
  expect_refused(error_of("x,x,y\n1,2,3\n"), "1: a second column x", "allowed: one");
  expect_refused(error_of("x,scale\n1,2\n"), "1: no column y", "x and y at least");
  expect_refused(error_of("x,y,scale,radius\n1,2,1,1\n"), "1: several columns of sizes", "one of");
  expect_refused(error_of("x [s],y\n1,2\n"), "1: column x: wrong unit", "a unit such as m");
  expect_refused(error_of("x,y,angle [mm]\n1,2,3\n"), "1: column angle: wrong unit", "a unit such as rad");
  expect_refused(error_of("x,y,scale [mm]\n1,2,3\n"), "1: column scale: wrong unit", "it is a factor");
  expect_refused(error_of("x [mm],y\n1,2\n", "mm"), "1: column x has a unit, and the scene gives 'mm' too",
                 "remove one");
  expect_refused(error_of("x,y,scale\n1,2,3\n1,2\n"), "3: found 2 columns", "allowed: 3");
  expect_refused(error_of("x,y,scale\n1,2,0\n"), "2: column scale: found \"0\"", "a number > 0");
  expect_refused(error_of("x,y\n1,two\n"), "2: column y: found \"two\"", "a number");
  expect_refused(error_of("x [km],y\n1e308,2\n"), "2: column x: found \"1e308\"", "a number");
  expect_refused(error_of("1,2\n1,2\n1,2\n1,2\n"), "4: more grains", "at most 3");
}

}  // namespace
}  // namespace pliant
