// Which rule a pair of bodies gets, and which rules are refused.
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "scene/contact_rules.hpp"
#include "scene_files.hpp"

namespace pliant {
namespace {

using scene_tests::good_scene;
using scene_tests::SceneFile;

/// The good scene with other rules.
std::string with_rules(const std::string& rules) {
  std::string text = good_scene;
  const auto from = text.find("[[contacts]]"), to = text.find("[contact]");
  return text.replace(from, to - from, rules);
}

std::string rule(const std::string& between, double stiffness) {
  return "[[contacts]]\nbetween = " + between + "\nlaw = \"frictionless\"\nstiffness = " + std::to_string(stiffness) +
         "\n";
}

std::string error_of(const std::string& text) {
  try {
    read_scene(SceneFile(text).path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// EXACT: grains and walls by name before materials before all, whatever the order in the file and in the rule.
TEST(ContactRules, TheMostSpecificHolds) {
  const SceneFile file(with_rules(rule("\"all\"", 1) + rule("[\"hard\", \"soft\"]", 2) +
                                  rule("[\"floor\", \"all\"]", 3) + rule("[\"floor\", \"soft\"]", 4) +
                                  rule("[\"boxes\", \"floor\"]", 5) + rule("[\"lid\", \"floor\"]", 6) +
                                  rule("[\"hard\", \"floor\"]", 7)));
  const Scene scene = read_scene(file.path());
  const auto stiffness = [&](const char* material, const char* name, const char* other, const char* other_name) {
    const auto party = [&](const char* m, const std::string& n) {
      return contact_party(scene, m, n, n == "floor" || n == "lid");
    };
    const RuleMatch match = match_rule(scene, party(material, name), party(other, other_name));
    const RuleMatch mirrored = match_rule(scene, party(other, other_name), party(material, name));
    EXPECT_EQ(match.rule, mirrored.rule);
    EXPECT_EQ(match.rival, nullptr);
    return *match.rule->stiffness;
  };
  EXPECT_EQ(stiffness("soft", "grains", "soft", "grains"), 1);
  EXPECT_EQ(stiffness("soft", "grains", "hard", "grains"), 2);
  EXPECT_EQ(stiffness("soft", "boxes", "hard", "lid"), 2);
  EXPECT_EQ(stiffness("soft", "grains", "hard", "floor"), 4);
  EXPECT_EQ(stiffness("hard", "grains", "hard", "floor"), 7);
  EXPECT_EQ(stiffness("soft", "boxes", "hard", "floor"), 5);
  EXPECT_EQ(stiffness("hard", "lid", "hard", "floor"), 6);
}

// EXACT: only what rules name tells parties apart.
TEST(ContactRules, PartiesAreFew) {
  EXPECT_EQ(contact_parties(read_scene(SceneFile(good_scene).path())).size(), 2u);
  const SceneFile file(with_rules(rule("\"all\"", 1) + rule("[\"floor\", \"grains\"]", 2)));
  const std::vector<ContactParty> parties = contact_parties(read_scene(file.path()));
  ASSERT_EQ(parties.size(), 5u);  // lid, floor, hard and soft grains, soft boxes
  EXPECT_EQ(parties[0], (ContactParty{"hard", "", false}));
  EXPECT_EQ(parties[1], (ContactParty{"hard", "floor", true}));
}

// EXACT: place and words.
TEST(ContactRules, RefusesWhatIsAmbiguous) {
  const std::string two_sums =
      with_rules(rule("\"all\"", 1) + rule("[\"floor\", \"hard\"]", 2) + rule("[\"grains\", \"hard\"]", 3));
  const std::string message = error_of(two_sums);
  EXPECT_NE(message.find("'between' in [[contacts]] 3"), std::string::npos) << message;
  EXPECT_NE(message.find("'floor' of 'hard'"), std::string::npos) << message;
  EXPECT_NE(message.find("as the rule between [floor, hard] does"), std::string::npos) << message;
  EXPECT_EQ(error_of(two_sums + rule("[\"floor\", \"grains\"]", 4)), "no error");
  std::string same_name = with_rules(rule("[\"hard\", \"all\"]", 1) + rule("\"all\"", 2));
  EXPECT_EQ(error_of(same_name), "no error");
  same_name.replace(same_name.find("\"boxes\""), 7, "\"hard\"");
  EXPECT_NE(error_of(same_name).find("'hard' is a material and also grains or a wall"), std::string::npos);
}

// EXACT: each pair that can meet needs a rule; a wall does not meet itself.
TEST(ContactRules, EveryPairNeedsOne) {
  const std::string floor_only = rule("[\"soft\", \"soft\"]", 1) + rule("[\"soft\", \"hard\"]", 1) +
                                 rule("[\"lid\", \"all\"]", 1) + rule("[\"hard\", \"hard\"]", 1);
  EXPECT_NE(error_of(with_rules(floor_only)).find("says as much of"), std::string::npos);
  const std::string complete = floor_only + rule("[\"lid\", \"soft\"]", 1) + rule("[\"lid\", \"hard\"]", 1);
  EXPECT_EQ(error_of(with_rules(complete)), "no error");
  EXPECT_NE(error_of(with_rules(rule("[\"soft\", \"all\"]", 1))).find("'hard' and 'hard'"), std::string::npos);
}

}  // namespace
}  // namespace pliant
