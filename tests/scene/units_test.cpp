#include "scene/units.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/floating_point_traps.hpp"
#include "geometry/polygon_rules.hpp"
#include "scene/names.hpp"

namespace pliant {
namespace {

TEST(Units, ConvertToSi) {
  // EXACT; two roundings, of the unit's factor and of the product.
  const auto near = [](const char* text, const char* unit, double expected) {
    EXPECT_NEAR(parse_quantity(text, unit), expected, 4.5e-16 * std::abs(expected)) << text;
  };
  near("2 GPa", "Pa", 2e9);
  near("87 um", "m", 87e-6);
  near("87 µm", "m", 87e-6);
  near("1200 kg/m3", "kg/m3", 1200);
  near("1.2 g/cm3", "kg/m3", 1200);
  near("10 m/s", "m/s", 10);
  near("-9.81 m/s2", "m/s2", -9.81);
  near("60 deg", "rad", std::numbers::pi / 3);
  near("60 degrees", "rad", std::numbers::pi / 3);
  near("60°", "rad", std::numbers::pi / 3);
  near("0.5 rad", "rad", 0.5);
  near("2 rad/s", "rad/s", 2);
  near("0.25 turn", "rad", std::numbers::pi / 2);
  near("90 deg/s", "rad/s", std::numbers::pi / 2);
  near("30 rpm", "rad/s", std::numbers::pi);
  near("2 s-1", "rad/s", 2);
  near("0.5", "rad", 0.5);
  near("5 Hz", "1/s", 5);
  near("20 1/s", "s-1", 20);
  near("3 1/ms", "1/s", 3000);
  near("2 1/(GPa)", "Pa-1", 2e-9);
  near("5 ns", "s", 5e-9);
  near("0.1 GPa/m", "Pa/m", 1e8);
  near("1 MPa/um", "Pa/m", 1e12);
  near("3 N/m", "N/m", 3);
  near("1e3", "1", 1000);
  near("30 %", "1", 0.3);
  near("  +4.5e-1km ", "m", 450);
}

TEST(Units, RejectWhatTheyCannotMean) {
  // EXACT: each message names what is wrong.
  const auto rejects = [](const char* text, const char* unit, const char* why) {
    try {
      const double value = parse_quantity(text, unit);
      ADD_FAILURE() << text << " passed as " << value << " " << unit;
    } catch (const UnitError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << text << ": " << error.what();
    }
  };
  rejects("2 GPa", "m", "wrong unit");
  rejects("2", "m", "no unit");
  rejects("1 MHz", "s", "wrong unit");  // the reciprocal, which UDUNITS-2 calls convertible
  rejects("1 s/m", "m/s", "wrong unit");
  // The angle is no number, whatever its unit and whatever stands beside it.
  for (const char* angle :
       {"45 deg", "45°", "0.785 rad", "785 mrad", "0.125 turn", "45 arc_degree", "50 grade", "1 sr"})
    rejects(angle, "1", "which is no number");
  for (const char* rate : {"20 rad/s", "20 deg/s", "20 rpm"}) rejects(rate, "1/s", "which is no number");
  rejects("2 m rad", "m", "which is no number");
  rejects("30 %", "rad", "wrong unit");
  rejects("1 sr", "rad", "wrong unit");
  rejects("1 rad2/s", "rad/s", "wrong unit");
  rejects("2 1/1000 s", "s", "unknown unit");
  rejects("2 1/s", "s", "wrong unit");
  rejects("10 Hz", "rad/s", "turns or radians");
  rejects("10 kilohertz", "rad/s", "turns or radians");
  rejects("2 foo", "m", "unknown unit");
  rejects("2 m)", "m", "unknown unit");
  rejects("2 1000 m", "m", "unknown unit");
  rejects("2 m m", "m", "wrong unit");
  rejects("2,5 m", "m", "unknown unit");
  rejects("20 degC", "K", "offset");
  rejects("1 s since 2000-01-01", "s", "offset");
  rejects("3 lg(re 1 Pa)", "Pa", "wrong unit");
  rejects("m", "m", "no number");
  rejects("", "m", "no number");
  rejects("nan m", "m", "not finite");
  rejects("inf m", "m", "not finite");
  rejects("-inf m", "m", "not finite");
  rejects("1e999 m", "m", "double precision");
  rejects("1e308 GPa", "Pa", "double precision");
  rejects("0x10 m", "m", "unknown unit");
}

TEST(Units, TellAnglesFromNumbers) {
  // EXACT
  for (const char* angle : {"45 deg", " 45° ", "0.1 rad", "-1e-3 turn", "20 arc_minute"}) EXPECT_TRUE(is_angle(angle));
  for (const char* other : {"", "45", "4.5e1", "30 %", "45 dge", "1 rad/s", "deg", "1 m", "nan rad", "auto"})
    EXPECT_FALSE(is_angle(other)) << other;
}

TEST(Names, EditDistance) {
  // EXACT: textbook values.
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("flaw", "lawn"), 2);
  EXPECT_EQ(edit_distance("verlet", "verlet"), 0);
  EXPECT_EQ(edit_distance("yuong", "young"), 1);
  EXPECT_EQ(edit_distance("ned", "end"), 1);
  EXPECT_EQ(edit_distance("ab", "ba"), 1);
}

TEST(Names, NearestOnlyWhenItResembles) {
  // EXACT
  EXPECT_EQ(nearest_name("densty", {"young", "density", "law"}), "density");
  EXPECT_EQ(nearest_name("xyzzy", {"young", "density", "law"}), "");
  EXPECT_EQ(nearest_name("", {"a"}), "");
  EXPECT_EQ(allowed_names("a", {}), "none is defined");
}

TEST(PolygonRules, FindDefects) {
  const Untrapped untrapped;
  // EXACT
  EXPECT_EQ(polygon_defect({{0, 0}, {1, 0}, {1, 1}, {0, 1}}).text, "");
  EXPECT_EQ(polygon_defect({{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}}).text, "");
  EXPECT_EQ(polygon_defect({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).text, "edges 1 and 3 cross or touch");
  EXPECT_EQ(polygon_defect({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}).text, "edges 1 and 3 cross or touch");
  EXPECT_EQ(polygon_defect({{0, 0}, {0, 0}, {1, 0}, {1, 1}}).text, "points 1 and 2 coincide");
  EXPECT_EQ(polygon_defect({{0, 0}, {1, 0}, {1, 1e-6}, {0, 1e-6}}).text, "");
  for (const double far : {1e14, 5e68, 1e200})
    EXPECT_EQ(polygon_defect({{1, 0}, {0, 0}, {far, 2}}).text, "the points lie on one line, but for rounding");
  EXPECT_EQ(polygon_defect({{0, 0}, {1, 0}, {1, 1}, {0, 0}}).text, "points 4 and 1 coincide");
  EXPECT_EQ(polygon_defect({{0, 0}, {2, 0}, {1, 0}}).text, "edges 1 and 2 fold back");
  EXPECT_EQ(polygon_defect({{0, 0}, {1, 0}, {1, 1}, {1, 2}, {1, 1.5}, {0, 1.5}}).text, "edges 3 and 4 fold back");
}

TEST(PolygonRules, AreaAndExtent) {
  // EXACT, integers
  EXPECT_EQ(signed_area({{5, 5}, {8, 5}, {8, 9}, {5, 9}}), 12);
  EXPECT_EQ(signed_area({{5, 9}, {8, 9}, {8, 5}, {5, 5}}), -12);
  EXPECT_EQ(largest_extent({{5, 5}, {8, 5}, {8, 9}, {5, 9}}), 5);
}

}  // namespace
}  // namespace pliant
