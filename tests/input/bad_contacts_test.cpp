// Refused settings and laws of contact: place and words.
#include <gtest/gtest.h>

#include "input/bad_scenes.hpp"

namespace pliant {
namespace {

using scene_tests::Bad;

class BadContacts : public ::testing::TestWithParam<Bad> {};

// EXACT throughout.
TEST_P(BadContacts, AreRefusedWithPlaceAndReason) { scene_tests::expect_refused(GetParam()); }

const std::vector<Bad> bad_laws{
    {"UnknownSide", "['soft', 'hard']", "['soft', 'flor']", "'flor'", "nearest: floor"},
    {"FrictionOf90Degrees", "friction = 0.3", "friction = '90 deg'", "'90 deg'", "an angle from 0 to below 90 deg"},
    {"NegativeFrictionAngle", "friction = 0.3", "friction = '-1 deg'", "'-1 deg'", "an angle from 0 to below 90 deg"},
    {"FrictionUnit", "friction = 0.3", "friction = '45 dge'", "'45 dge'", "an angle from 0 to below 90 deg"},
    {"NegativeFriction", "friction = 0.3", "friction = -1", "-1\nstiffness", "an angle from 0 to below 90 deg"},
    {"SmoothingAngle", "friction = 0.3", "friction = 0.3\nsmoothing = '1 deg'", "'1 deg'",
     "no number; allowed: a number, >= 0 and <= 1"},
    {"NoRestitution", "friction = 0.3", "friction = 0.3\nrestitution = 0", "0\nstiffness",
     "'restitution' in [[contacts]] 2"},
    {"PullWithoutRestitution", "friction = 0.3", "pull = true\nfriction = 0.3", "pull", "unknown key 'pull'"},
    {"PullOf1", "friction = 0.3", "friction = 0.3\nrestitution = 0.5\npull = 1", "1\nstiffness", "true or false"},
    {"SmoothingAndRestitution", "friction = 0.3", "friction = 0.3\nrestitution = 0.5\nsmoothing = 0.02", "0.02",
     "constant stiffness"},
    {"SmoothingAndTension", "friction = 0.3", "friction = 0.3\ntension = 1e6\nsmoothing = 0.02", "smoothing",
     "unknown key 'smoothing'"},
};
INSTANTIATE_TEST_SUITE_P(Laws, BadContacts, ::testing::ValuesIn(bad_laws), scene_tests::name_of);

const std::vector<Bad> former_laws{{"CohesiveFatigue", "law = 'cohesive'", "law = 'cohesive-fatigue'",
                                    "'cohesive-fatigue'", "is now a rule of its own, [[bonds]]"}};
INSTANTIATE_TEST_SUITE_P(Former, BadContacts, ::testing::ValuesIn(former_laws), scene_tests::name_of);

const std::vector<Bad> bad_settings{
    {"RefreshOf0Steps", "skin = 0.4", "skin = 0.4\nrefresh = 0", "0\n[[probes]]", "an integer from 1"},
    {"RefreshOf0Time", "skin = 0.4", "skin = 0.4\nrefresh = '0 us'", "'0 us'\n[[probes]]", "'refresh' in [contact]"},
    {"RefreshWord", "skin = 0.4", "skin = 0.4\nrefresh = 'saef'", "'saef'", "\"safe\""},
    {"RefreshOfHalfAStep", "skin = 0.4", "skin = 0.4\nrefresh = 0.5", "0.5\n[[probes]]", "a number of steps"},
    {"Length", "skin = 0.4", "skin = 0.4\nlength = 'curent'", "'curent'", "nearest: current"},
    {"SelfContactWord", "skin = 0.4", "skin = 0.4\nself_contact = 'yes'", "'yes'", "true or false"},
};
INSTANTIATE_TEST_SUITE_P(Settings, BadContacts, ::testing::ValuesIn(bad_settings), scene_tests::name_of);

}  // namespace
}  // namespace pliant
