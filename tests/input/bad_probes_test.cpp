#include <gtest/gtest.h>

#include "input/bad_scenes.hpp"
#include "input/read_scene.hpp"

namespace pliant {
namespace {

using scene_tests::Bad;

class BadProbes : public ::testing::TestWithParam<Bad> {};

// EXACT: place and words of the message.
TEST_P(BadProbes, AreRefusedWithPlaceAndReason) { scene_tests::expect_refused(GetParam()); }

const std::vector<Bad> bad_probes{
    {"UnknownQuantity", "'friction_factor'", "'frictionfactor'", "'frictionfactor'", "nearest: friction_factor"},
    {"ReduceOfAWhole", "of = 'floor'", "of = 'floor'\nreduce = 'max'", "reduce", "unknown key 'reduce'"},
    {"SumOfPositions", "'friction_factor'", "'position'\nreduce = 'sum'", "'sum'", "allowed: mean, min, max"},
    {"GrainBeyondTheLast", "'friction_factor'\nof = 'floor'", "'position'\nof = 'boxes 2'", "'boxes 2'",
     "allowed: \"boxes 0\" to \"boxes 1\""},
    {"GrainWithoutANumber", "'friction_factor'\nof = 'floor'", "'position'\nof = 'boxes one'", "'boxes one'",
     "\"boxes 0\" to \"boxes 1\""},
    {"StressOfRigidGrains", "'friction_factor'\nof = 'floor'", "'stress'\nof = 'rigid'", "'rigid'\nperiod = '10",
     "unknown wall or grains ... compliant, all"},
    {"NodeOfSeveral", "'friction_factor'\nof = 'floor'", "'position'\nof = 'boxes'\nnode = 3", "3\nperiod",
     "a node is one of one body"},
    {"NodeAndReduce", "'friction_factor'\nof = 'floor'", "'position'\nof = 'boxes 0'\nnode = 3\nreduce = 'max'",
     "'max'", "nothing to reduce"},
    {"SolidFractionOfNoRegion", "'friction_factor'\nof = 'floor'", "'solid_fraction'\nof = 'all'", "[[probes]]",
     "needs a region ... between"},
    {"RegionBetweenOneWall", "'friction_factor'\nof = 'floor'",
     "'solid_fraction'\nof = 'all'\nbetween = ['floor', 'floor']", "['floor', 'floor']",
     "one wall below and one above"},
    {"BoxUpsideDown", "'friction_factor'\nof = 'floor'", "'solid_fraction'\nof = 'all'\nbox = [[0, 1], [1, 0]]",
     "[[0, 1], [1, 0]]", "left < right and bottom < top"},
    {"TwoRegions", "'friction_factor'\nof = 'floor'",
     "'solid_fraction'\nof = 'all'\nbetween = ['floor', 'lid']\nbox = [[0, 0], [1, 1]]", "[[0, 0], [1, 1]]",
     "not by both"},
    {"PartnersOfAPosition", "'friction_factor'\nof = 'floor'", "'position'\nof = 'boxes'\nwith = 'floor'",
     "with =", "unknown key 'with'"},
    {"UnknownField", "['velocity', 'von_mises']", "['von_mise']", "'von_mise'", "nearest: von_mises"},
    {"GrainsCalledAll", "name = 'boxes'", "name = 'all'", "[[grains]]\nname", "'all' ... taken"},
};
INSTANTIATE_TEST_SUITE_P(Outputs, BadProbes, ::testing::ValuesIn(bad_probes), scene_tests::name_of);

/// The good scene with a single box, and a probe of it.
std::string single_box(const std::string& of) {
  return scene_tests::edited({{", [\"5 um\", \"8 um\"]]", "]"},
                              {"\"friction_factor\"\nof = \"floor\"", "\"position\"\nnode = 1\nof = \"" + of + "\""}});
}

// EXACT: the only grain of a set is number 0 as well.
TEST(OnlyGrain, HasTheNumber0) {
  for (const char* of : {"boxes", "boxes 0"}) {
    const scene_tests::SceneFile file(single_box(of));
    EXPECT_EQ(read_scene(file.path()).probes[0].of, "boxes") << "what the body is called";
  }
  EXPECT_NE(scene_tests::error_of(single_box("boxes 1")).find("\"boxes\" or \"boxes 0\""), std::string::npos);
}

}  // namespace
}  // namespace pliant
