// Places, sizes and angles of grains from a file. All EXACT.
#include "geometry/grain_file.hpp"

#include <numbers>

#include "geometry/outline_files.hpp"

namespace pliant {
namespace {

using namespace scene_tests;
using Numbers = std::vector<double>;

GrainFile grains_in(const std::string& text, const std::string& unit = "") {
  const TextFile file(".csv", text);
  return read_grain_file(file.path, unit, 3);
}

std::string grain_error(const std::string& text, const std::string& unit = "") {
  return refusal(".csv", text, [&](const std::filesystem::path& path) { read_grain_file(path, unit, 3); });
}

TEST(GrainFile, ColumnsInAnyOrderWithTheirUnits) {
  const GrainFile all =
      grains_in("# a box\nAngle [deg]; X [mm]; y [cm]; diameter [um]\r\n\r\n90;1;2;500\r\n-180;3;4;250 # last\r\n");
  EXPECT_EQ(all.positions, (Points{{1e-3, 0.02}, {3e-3, 0.04}}));
  EXPECT_EQ(all.diameters, (Numbers{500 * 1e-6, 250 * 1e-6}));
  EXPECT_DOUBLE_EQ(all.angles[0], std::numbers::pi / 2);
  EXPECT_TRUE(all.scales.empty());
  EXPECT_EQ(all.lines, (std::vector<int>{4, 5}));
  const GrainFile plain = grains_in("1 2\n3\t4\n", "mm");
  EXPECT_EQ(plain.positions, (Points{{1e-3, 2e-3}, {3e-3, 4e-3}}));
  EXPECT_TRUE(plain.angles.empty() && plain.scales.empty() && plain.diameters.empty());
  const GrainFile scaled = grains_in("\xEF\xBB\xBFx,y,scale,angle\n1,2,0.5,0.25\n", "mm");
  EXPECT_EQ(scaled.scales, Numbers{0.5});
  EXPECT_EQ(scaled.angles, Numbers{0.25}) << "rad, whatever the unit of length";
  EXPECT_EQ(grains_in("x,y,radius\n1,2,3\n").diameters, Numbers{6});
}

TEST(GrainFile, ACommentBeforeTheNumbersMayNameTheColumns) {
  const GrainFile commented = grains_in("# 2 grains\n# y [mm], X [mm], diameter [um]\n1,2,500\n");
  EXPECT_EQ(commented.positions, (Points{{2e-3, 1e-3}}));
  EXPECT_EQ(commented.diameters, Numbers{500 * 1e-6});
  EXPECT_EQ(grains_in("## x [mm] y [mm]\n\n1 2\n").positions, (Points{{1e-3, 2e-3}}));
  EXPECT_EQ(grains_in("# x [mm], y [mm]\nx [cm], y [cm]\n1,2\n").positions, (Points{{0.01, 0.02}})) << "the header";
  for (const char* prose : {"# x and y of grains\n", "# scale\n", "# x, y, mass\n", "#\n", "# x is right, y is up\n"})
    EXPECT_EQ(grains_in(std::string(prose) + "1,2\n").positions, (Points{{1, 2}})) << prose;
  EXPECT_EQ(grains_in("1,2\n# y [mm], x [mm]\n3,4\n").positions, (Points{{1, 2}, {3, 4}})) << "behind the first";
  expect_refused(grain_error("# none\n# x [mm], y [mn]\n1,2\n"), "2: column y: unknown unit", "a unit such as m");
  expect_refused(grain_error("# x (mm), y (mm)\n1,2\n"), "1: unknown column \"x (mm)\"", "write \"x [mm]\"");
  expect_refused(grain_error("# x [mm], y [mm]\n1,2\n", "mm"), "1: column x has a unit, and the scene", "remove one");
}

TEST(GrainFile, UnitsAndNumbersInOtherWritings) {
  const GrainFile blanks = grains_in("x [mm] y[cm]  angle [ deg ]\n1 2 180\n");
  EXPECT_EQ(blanks.positions, (Points{{1e-3, 0.02}}));
  EXPECT_DOUBLE_EQ(blanks.angles.at(0), std::numbers::pi);
  for (const char* x : {"x (mm)", "x_mm", "x/mm"})
    expect_refused(grain_error(std::string(x) + ",y\n1,2\n"), "1: unknown column", "write \"x [mm]\"");
  EXPECT_EQ(grain_error("x,y,y_velocity\n1,2,3\n").find("write"), std::string::npos);
  for (const char* comma : {"0,5;0,7", "0,5\t0,7", "0,5 0,7", "1;0,7", "0,5;2"})
    expect_refused(grain_error(std::string(comma) + "\n"), "1: found \"" + std::string(comma).substr(0, 1),
                   "decimal point");
  expect_refused(grain_error("x;y\n1;2\n0,5;0,7\n"), "3: found \"0,5;0,7\"", "decimal comma");
  EXPECT_EQ(grains_in("1, 2\n").positions, (Points{{1, 2}}));
  const std::string plain = "1,2\n";
  for (const bool low_first : {true, false}) {
    std::string wide;
    for (const char c : plain) wide += low_first ? std::string{c, '\0'} : std::string{'\0', c};
    expect_refused(grain_error(wide), " every second byte is zero", "UTF-8");
  }
}

TEST(GrainFile, DegreesWithoutAUnitAndAbsurdSizes) {
  EXPECT_NE(grains_in("x,y,angle\n1,2,6\n1,2,-30\n1,2,60\n")
                .doubt.find(".csv:3: column angle: found -30, which is read as radians; did you mean"),
            std::string::npos);
  EXPECT_EQ(grains_in("x,y,angle [rad]\n1,2,30\n").doubt + grains_in("x,y,angle [deg]\n1,2,720\n").doubt, "");
  EXPECT_EQ(grains_in("x,y,angle\n1,2,6.28\n").doubt, "");
  expect_refused(grain_error("x,y,diameter [mm]\n1,2,3\n1,2,1e300\n"), "3: column diameter", "at most 1e+12");
  expect_refused(grain_error("x,y,diameter [mm]\n1,2,1e-300\n"), "2: column diameter", "at least 1e-12");
  expect_refused(grain_error("x,y,scale\n1,2,1e-13\n"), "2: column scale", "at least 1e-12");
  expect_refused(grain_error("-1e13,2\n"), "1: column x", "at most 1e+12");
}

TEST(GrainFile, BadFilesAreRefusedWithTheirLine) {
  expect_refused(grain_error(""), "1: no grains", "at least one line");
  expect_refused(grain_error("x,y\n# none\n"), "2: no grains", "at least one line");
  expect_refused(grain_error("1,2,3\n"), "1: found 3 columns without names", "diameter [mm]");
  expect_refused(grain_error("x,y,diametre\n1,2,3\n"), "1: unknown column \"diametre\"", "nearest: diameter");
  expect_refused(grain_error("x,x,y\n1,2,3\n"), "1: a second column x", "allowed: one");
  expect_refused(grain_error("x,scale\n1,2\n"), "1: no column y", "x and y at least");
  expect_refused(grain_error("x,y,scale,radius\n1,2,1,1\n"), "1: several columns of sizes", "one of");
  expect_refused(grain_error("x [s],y\n1,2\n"), "1: column x: wrong unit", "a unit such as m");
  expect_refused(grain_error("x,y,angle [mm]\n1,2,3\n"), "1: column angle: wrong unit", "a unit such as rad");
  expect_refused(grain_error("x,y,scale [mm]\n1,2,3\n"), "1: column scale: wrong unit", "it is a factor");
  expect_refused(grain_error("x [mm],y\n1,2\n", "mm"), "1: column x has a unit, and the scene gives 'mm' too",
                 "remove one");
  expect_refused(grain_error("x,y,scale\n1,2,3\n1,2\n"), "3: found 2 columns", "allowed: 3");
  expect_refused(grain_error("x,y,scale\n1,2,0\n"), "2: column scale: found \"0\"", "a number > 0");
  expect_refused(grain_error("x,y\n1,two\n"), "2: column y: found \"two\"", "a number");
  expect_refused(grain_error("x [km],y\n1e308,2\n"), "2: column x: found \"1e308\"", "a number");
  expect_refused(grain_error("1,2\n1,2\n1,2\n1,2\n"), "4: more grains", "at most 3");
}

}  // namespace
}  // namespace pliant
