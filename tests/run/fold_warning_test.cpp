// Bodies whose outlines cross themselves are found and named.
#include "run/fold_warning.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "setup/build_model.hpp"
#include "support/simulations.hpp"

namespace pliant::dynamics_tests {
namespace {

Scene three_discs(bool self_contact) {
  Scene scene = empty_scene(1);
  scene.shapes = {disc_shape("disc", 1, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{0, 0}, {3, 0}}),
                  grains("hard", "disc", BodyKind::rigid, {{6, 0}})};
  scene.contacts = {frictionless(1)};
  scene.contact.self_contact = self_contact;
  return scene;
}

/// Moves a node of a body through its centre, just beyond the other side.
void push_through(const Model& model, int body, OutlineField& position) {
  const int node = model.outline_offset[body], n = model.outline_of(body).count;
  const Vec2 to = 1.01 * position.at(node + n / 2) - 0.01 * position.at(node);
  position.x[node] = to.x(), position.y[node] = to.y();
}

// EXACT: a disc is simple, one whose node is beyond the other side is not. Rigid bodies and self-contact are not asked.
TEST(FoldWarning, finds_bodies_whose_outline_crosses_itself) {
  for (const bool self_contact : {false, true}) {
    const Model model = build_model(three_discs(self_contact));
    OutlineField position = Simulation(model).state().outlines.position;
    EXPECT_TRUE(find_folds(model, position).empty());
    push_through(model, 1, position);
    push_through(model, 2, position);
    const std::vector<Fold> folds = find_folds(model, position);
    ASSERT_EQ(folds.size(), self_contact ? 0 : 1);
    if (self_contact) continue;
    EXPECT_EQ(folds[0].body, 1);
    EXPECT_LT((folds[0].place - Vec2(3, 0)).norm(), 0.52);
  }
}

TEST(FoldWarning, names_the_body_and_the_remedy) {
  const Model model = build_model(three_discs(false));
  const std::string one = fold_warning(model, {{0, {1, 2}}}, 5);
  EXPECT_TRUE(one.starts_with("soft 0 has folded through itself near (1, 2) m by t = 5 s: ")) << one;
  EXPECT_NE(one.find("self_contact = true may help"), std::string::npos) << one;
  const std::string two = fold_warning(model, {{0, {1, 2}}, {1, {3, 4}}}, 5);
  EXPECT_NE(two.find("soft 0 has folded through itself near (1, 2) m by t = 5 s, and another body has: "),
            std::string::npos);
}

}  // namespace
}  // namespace pliant::dynamics_tests
