// Which rule a pair of bodies gets, and which rules are refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "bodies/model.hpp"
#include "contact/law_table.hpp"
#include "core/errors.hpp"
#include "input/read_scene.hpp"
#include "scene/contact_rules.hpp"
#include "scene_files.hpp"
#include "setup/build_model.hpp"

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

std::string rule_error(const std::string& text) {
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
    const auto group = [&](const char* m, const std::string& n) {
      return contact_group(scene, m, n, n == "floor" || n == "lid");
    };
    const RuleMatch match = match_rule(scene, group(material, name), group(other, other_name));
    const RuleMatch mirrored = match_rule(scene, group(other, other_name), group(material, name));
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

// EXACT: only what rules name tells groups apart.
TEST(ContactRules, PartiesAreFew) {
  EXPECT_EQ(contact_parties(read_scene(SceneFile(good_scene).path())).size(), 2u);
  const SceneFile file(with_rules(rule("\"all\"", 1) + rule("[\"floor\", \"grains\"]", 2)));
  const std::vector<ContactGroup> groups = contact_parties(read_scene(file.path()));
  ASSERT_EQ(groups.size(), 5u);  // lid, floor, hard and soft grains, soft boxes
  EXPECT_EQ(groups[0], (ContactGroup{"hard", "", false}));
  EXPECT_EQ(groups[1], (ContactGroup{"hard", "floor", true}));
}

// EXACT: place and words.
TEST(ContactRules, RefusesWhatIsAmbiguous) {
  const std::string two_sums =
      with_rules(rule("\"all\"", 1) + rule("[\"floor\", \"hard\"]", 2) + rule("[\"grains\", \"hard\"]", 3));
  const std::string message = rule_error(two_sums);
  EXPECT_NE(message.find("'between' in [[contacts]] 3"), std::string::npos) << message;
  EXPECT_NE(message.find("'floor' of 'hard'"), std::string::npos) << message;
  EXPECT_NE(message.find("as the rule between [floor, hard] does"), std::string::npos) << message;
  EXPECT_EQ(rule_error(two_sums + rule("[\"floor\", \"grains\"]", 4)), "no error");
  std::string same_name = with_rules(rule("[\"hard\", \"all\"]", 1) + rule("\"all\"", 2));
  EXPECT_EQ(rule_error(same_name), "no error");
  same_name.replace(same_name.find("\"boxes\""), 7, "\"hard\"");
  EXPECT_NE(rule_error(same_name).find("'hard' is a material and also grains or a wall"), std::string::npos);
}

// EXACT: each pair that can meet needs a rule; a wall does not meet itself.
TEST(ContactRules, EveryPairNeedsOne) {
  const std::string floor_only = rule("[\"soft\", \"soft\"]", 1) + rule("[\"soft\", \"hard\"]", 1) +
                                 rule("[\"lid\", \"all\"]", 1) + rule("[\"hard\", \"hard\"]", 1);
  EXPECT_NE(rule_error(with_rules(floor_only)).find("says as much of"), std::string::npos);
  const std::string complete = floor_only + rule("[\"lid\", \"soft\"]", 1) + rule("[\"lid\", \"hard\"]", 1);
  EXPECT_EQ(rule_error(with_rules(complete)), "no error");
  EXPECT_NE(rule_error(with_rules(rule("[\"soft\", \"all\"]", 1))).find("'hard' and 'hard'"), std::string::npos);
}

/// Compliant and rigid discs apart from each other, and walls, which need a period.
std::string few_bodies(const std::string& top, int soft, int hard, int walls, const std::string& contacts) {
  std::string text = top + "[time]\nend = 1\n" + R"([materials.soft]
law = "neo-hookean"
density = 1
young = 1
poisson = 0.3
[materials.hard]
law = "rigid"
density = 1
[shapes.disc]
kind = "disc"
diameter = 1
nodes = 60
)";
  const auto add_disc = [&](const std::string& kind, double x, int row) {
    text += "[[grains]]\nshape = \"disc\"\n" + kind + "packing = { kind = \"positions\", positions = [[" +
            std::to_string(x) + ", " + std::to_string(2 * row + 2) + "]] }\n";
  };
  for (int i = 0; i < soft; ++i) add_disc("body = \"compliant\"\nmaterial = \"soft\"\n", 1, i);
  for (int i = 0; i < hard; ++i) add_disc("body = \"rigid\"\nmaterial = \"hard\"\n", 4, i);
  for (int i = 0; i < walls; ++i)
    text += "[[walls]]\nname = \"wall" + std::to_string(i) + "\"\nmaterial = \"hard\"\n" +
            (i == 0 ? "solid = \"below\"\nlevel = 0\n" : "solid = \"above\"\nlevel = 9\n");
  return text + contacts;
}

// EXACT: a lone body meets itself only by its image or its folds; the scene and the engine agree on it.
TEST(ContactRules, ALoneBodyNeedsNoneWithItself) {
  const std::string between = rule("[\"soft\", \"hard\"]", 1), period = "[domain]\nperiod = 8\n";
  const auto refused = [](const std::string& text) {
    try {
      const LawTable laws(build_model(read_scene(SceneFile(text).path())));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const std::string soft = "no contact rule for the materials 'soft' and 'soft'", own = rule("[\"soft\", \"soft\"]", 1);
  EXPECT_EQ(refused(few_bodies("", 1, 1, 0, between)), "no error");
  EXPECT_NE(refused(few_bodies(period, 1, 1, 0, between + rule("[\"hard\", \"hard\"]", 1))).find(soft),
            std::string::npos);
  EXPECT_NE(refused(few_bodies("[contact]\nself_contact = true\n", 1, 1, 0, between)).find(soft), std::string::npos);
  EXPECT_NE(refused(few_bodies("", 2, 1, 0, between)).find(soft), std::string::npos);
  EXPECT_EQ(refused(few_bodies(period, 1, 0, 1, between + own)), "no error") << "one wall, period or not";
  const std::string hard = "'hard' and 'hard'";
  EXPECT_NE(refused(few_bodies(period, 1, 0, 2, between + own)).find(hard), std::string::npos);
  EXPECT_NE(refused(few_bodies(period, 1, 1, 1, between + own)).find(hard), std::string::npos);
}

// EXACT: restitution of compliant bodies, at its key and with what to write; a pair that never meets has any.
TEST(ContactRules, RestitutionIsOfRigidPairs) {
  const std::string between = rule("[\"soft\", \"hard\"]", 1), own = rule("[\"soft\", \"soft\"]", 1);
  const std::string bounces = "restitution = 0.5\n";
  EXPECT_EQ(rule_error(few_bodies("", 1, 1, 0, between + own + bounces)), "no error");
  const std::string text = few_bodies("", 2, 1, 0, between + own + bounces), message = rule_error(text);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(bounces)), '\n');
  EXPECT_NE(message.find(".toml:" + std::to_string(line) + ":15: 'restitution' in [[contacts]] 2"), std::string::npos)
      << message;
  EXPECT_NE(message.find("take 'restitution' out of this rule"), std::string::npos) << message;
  EXPECT_NE(message.find("between = [\"hard\", \"hard\"]"), std::string::npos) << message;
  EXPECT_EQ(rule_error(few_bodies("", 2, 1, 0, between + own + "restitution = 1\n")), "no error");
}

}  // namespace
}  // namespace pliant
