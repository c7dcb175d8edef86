#include <gtest/gtest.h>

#include "scene/bad_scenes.hpp"

namespace pliant {
namespace {

using scene_tests::Bad;

class BadProbes : public ::testing::TestWithParam<Bad> {};

// EXACT: place and words of the message.
TEST_P(BadProbes, AreRefusedWithPlaceAndReason) { scene_tests::expect_refused(GetParam()); }

const std::vector<Bad> bad_probes{
    {"UnknownQuantity",
     "\"friction_factor\"",
     "\"frictionfactor\"",
     "\"frictionfactor\"",
     {"nearest: friction_factor"}},
    {"ReduceOfAWhole", "of = \"floor\"", "of = \"floor\"\nreduce = \"max\"", "reduce", {"unknown key 'reduce'"}},
    {"SumOfPositions", "\"friction_factor\"", "\"position\"\nreduce = \"sum\"", "\"sum\"", {"allowed: mean, min, max"}},
    {"GrainBeyondTheLast",
     "\"friction_factor\"\nof = \"floor\"",
     "\"position\"\nof = \"boxes 2\"",
     "\"boxes 2\"",
     {"allowed: \"boxes 0\" to \"boxes 1\""}},
    {"GrainWithoutANumber",
     "\"friction_factor\"\nof = \"floor\"",
     "\"position\"\nof = \"boxes one\"",
     "\"boxes one\"",
     {"\"boxes 0\" to \"boxes 1\""}},
    {"StressOfRigidGrains",
     "\"friction_factor\"\nof = \"floor\"",
     "\"stress\"\nof = \"rigid\"",
     "\"rigid\"\nperiod = \"10",
     {"unknown wall or grains", "compliant, all"}},
    {"NodeOfSeveral",
     "\"friction_factor\"\nof = \"floor\"",
     "\"position\"\nof = \"boxes\"\nnode = 3",
     "3\nperiod",
     {"a node is one of one body"}},
    {"NodeAndReduce",
     "\"friction_factor\"\nof = \"floor\"",
     "\"position\"\nof = \"boxes 0\"\nnode = 3\nreduce = \"max\"",
     "\"max\"",
     {"nothing to reduce"}},
    {"SolidFractionOfNoRegion",
     "\"friction_factor\"\nof = \"floor\"",
     "\"solid_fraction\"\nof = \"all\"",
     "[[probes]]",
     {"needs a region", "between"}},
    {"RegionBetweenOneWall",
     "\"friction_factor\"\nof = \"floor\"",
     "\"solid_fraction\"\nof = \"all\"\nbetween = [\"floor\", \"floor\"]",
     "[\"floor\", \"floor\"]",
     {"one wall below and one above"}},
    {"BoxUpsideDown",
     "\"friction_factor\"\nof = \"floor\"",
     "\"solid_fraction\"\nof = \"all\"\nbox = [[0, 1], [1, 0]]",
     "[[0, 1], [1, 0]]",
     {"the lower left and the upper right corner"}},
    {"TwoRegions",
     "\"friction_factor\"\nof = \"floor\"",
     "\"solid_fraction\"\nof = \"all\"\nbetween = [\"floor\", \"lid\"]\nbox = [[0, 0], [1, 1]]",
     "[[0, 0], [1, 1]]",
     {"not by both"}},
    {"PartnersOfAPosition",
     "\"friction_factor\"\nof = \"floor\"",
     "\"position\"\nof = \"boxes\"\nwith = \"floor\"",
     "with =",
     {"unknown key 'with'"}},
    {"UnknownField", "[\"velocity\", \"von_mises\"]", "[\"von_mise\"]", "\"von_mise\"", {"nearest: von_mises"}},
    {"GrainsCalledAll", "name = \"boxes\"", "name = \"all\"", "[[grains]]\nname", {"'all'", "taken"}},
};
INSTANTIATE_TEST_SUITE_P(Outputs, BadProbes, ::testing::ValuesIn(bad_probes), scene_tests::name_of);

}  // namespace
}  // namespace pliant
