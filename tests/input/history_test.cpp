#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.hpp"
#include "scene/scene.hpp"

namespace pliant {
namespace {

// All EXACT; tolerances are a few roundings of numbers of order one.
constexpr double rounding = 1e-15;

const History ramp{{1, 3, 4}, {0, 10, 4}};

TEST(History, InterpolatesAndStaysConstantBeyondItsEnds) {
  EXPECT_EQ(ramp.at(-5), 0);
  EXPECT_EQ(ramp.at(1), 0);
  EXPECT_EQ(ramp.at(2), 5);
  EXPECT_EQ(ramp.at(3), 10);
  EXPECT_EQ(ramp.at(3.5), 7);
  EXPECT_EQ(ramp.at(4), 4);
  EXPECT_EQ(ramp.at(100), 4);
}

TEST(History, OneEntryIsAConstant) {
  const History constant{{0}, {3}};
  EXPECT_EQ(constant.at(-1), 3);
  EXPECT_EQ(constant.at(7), 3);
  EXPECT_EQ(constant.integral(-1, 7), 24);
}

TEST(History, IntegralIsExact) {
  EXPECT_EQ(ramp.integral(-2, 1), 0);
  EXPECT_EQ(ramp.integral(1, 3), 10);
  EXPECT_EQ(ramp.integral(3, 4), 7);
  EXPECT_EQ(ramp.integral(0, 6), 10 + 7 + 8);
  EXPECT_EQ(ramp.integral(1, 2), 2.5);
  EXPECT_EQ(ramp.integral(5, 6), 4);
  EXPECT_EQ(ramp.integral(2, 2), 0);
}

TEST(History, IntegralIsAdditiveAndOdd) {
  for (double middle = -1; middle < 6; middle += 0.37) {
    EXPECT_NEAR(ramp.integral(-1, middle) + ramp.integral(middle, 6), ramp.integral(-1, 6), 32 * rounding);
    EXPECT_EQ(ramp.integral(middle, 0.5), -ramp.integral(0.5, middle));
  }
}

TEST(History, ShortStepsKeepTheirPrecision) {
  // A step of 1e-6 late in a long history: rounding relative to its own integral, not to that of the whole history.
  const History late{{0, 1000}, {0, 1000}};
  const double t = 999.5, step = 1e-6;
  EXPECT_NEAR(late.integral(t, t + step), late.at(t + step / 2) * ((t + step) - t), 4 * rounding * t * step);
}

TEST(Scene, FindsMaterialsAndShapesOrNamesTheNearest) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].name = "soft";
  scene.materials[1].name = "hard";
  scene.shapes.resize(1);
  scene.shapes[0].name = "disc";
  EXPECT_EQ(&scene.material("hard"), &scene.materials[1]);
  EXPECT_EQ(&scene.shape("disc"), &scene.shapes[0]);
  try {
    scene.material("sofd");
    FAIL() << "an unknown material was found";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "unknown material 'sofd'; allowed: soft, hard; nearest: soft");
    EXPECT_EQ(error.code(), ExitCode::bad_input);
  }
  EXPECT_THROW(scene.shape(""), InputError);
}

}  // namespace
}  // namespace pliant
