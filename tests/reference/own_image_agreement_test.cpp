// A body and its own periodic image: the engine against the reference solver.
#include <gtest/gtest.h>

#include "reference/both.hpp"
#include "reference/contact_crowd.hpp"
#include "setup/build_model.hpp"
#include "support/figures.hpp"
#include "support/simulations.hpp"

namespace pliant {
namespace {

using namespace testing;

void stir_lone(ContactRig& rig, Random& random) {
  const auto by = [&] { return random.uniform(-0.01, 0.01); };
  rig.move(0, {by(), by()});
  if (rig.model.bodies[0].kind == BodyKind::rigid) rig.turn(0, by());
  for (const Batch& batch : rig.model.batches)
    for (int i = 0; i < 2 * rig.model.shape_of(batch).nodes(); ++i) rig.q.compliant[batch.offset + i][0] += by() / 4;
}

struct ComparedImages {
  double difference = 0, sheared = 0;
  int contacts = 0, own = 0;
};

/// INDEPENDENT: two programs. Tolerance: that of verify/frozen_states; energies, of order 0.1, the same.
void compare_images(ContactRig& rig, reference::Contacts& contacts, ComparedImages& all) {
  EXPECT_FALSE(rig.evaluate());
  const reference::ContactResult result = contacts.evaluate(outline_points(rig));
  const Points forces = forces_on_nodes(result, outline_points(rig).size());
  double largest = 0, worst = 0;
  std::size_t node = 0;
  for (int body = 0; body < 2; ++body)
    for (int k = 0; k < rig.count(body); ++k, ++node) {
      largest = std::max(largest, forces[node].norm());
      worst = std::max(worst, (rig.force(body, k) - forces[node]).norm());
    }
  EXPECT_LE(worst, 1e-11 * largest);
  EXPECT_EQ(rig.totals.contacts, static_cast<int>(result.elements.size()));
  EXPECT_NEAR(rig.totals.stored, result.stored, 1e-12);
  EXPECT_NEAR(rig.totals.dissipated, result.dissipated, 1e-12);
  if (largest > 0) all.difference = std::max(all.difference, worst / largest);
  for (const reference::ContactElement& element : result.elements) {
    all.own += element.body[0] == element.body[1];
    all.sheared += std::abs(element.shear);
  }
  rig.commit();
  rig.refresh();
  contacts.accept();
}

TEST(OwnImageAgreement, forces_of_all_laws) {
  LargestFigures figures;
  ComparedImages all;
  for (const ContactRule& rule : {frictionless(100), mohr_coulomb(100, 0.3, 0.05, 0.2), cohesive(100, 0.5, 0.02, 0.4)})
    for (int sample = 0; sample < 20 && !HasFailure(); ++sample) {
      SCOPED_TRACE(sample);
      Random random(sample + 60);
      const Scene scene = lone_body(random, sample % 2 == 0 ? BodyKind::compliant : BodyKind::rigid, rule);
      ContactRig rig(scene);
      reference::Contacts contacts(scene, reference_outlines(rig.model));
      rig.refresh();
      compare_images(rig, contacts, all);
      for (int state = 0; state < 4; ++state) {
        stir_lone(rig, random);
        compare_images(rig, contacts, all);
      }
    }
  EXPECT_GT(all.own, 500);
  EXPECT_GT(all.sheared, 1);
  figures.note("contact forces: a body and its own image", all.difference);
}

}  // namespace
}  // namespace pliant

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;

/// Discs that just overlap around the period, floated in turning.
Scene row(BodyKind kind, int copies) {
  Scene scene = empty_scene(0.5);
  scene.period = 1.99 * copies;
  scene.shapes = {disc_shape("disc", 2, 40)};
  scene.grains = {grains("row", "disc", kind, {}, moving({0, 0.1}, 0.2))};
  for (int i = 0; i < copies; ++i) scene.grains[0].packing.positions.emplace_back(0.3 + 1.99 * i, 0);
  scene.grains[0].angle = 0.1;
  scene.contacts = {mohr_coulomb(100, 0.3)};
  return scene;
}

/// EXACT: Newton's iterations end at 1e-10 of the forces, twenty times.
TEST(OwnImageAgreement, the_reference_in_twice_the_period) {
  for (const BodyKind kind : {BodyKind::compliant, BodyKind::rigid}) {
    const Eigen::VectorXd one = run_reference(row(kind, 1), 20), two = run_reference(row(kind, 2), 20);
    const Eigen::VectorXd first = two.head(one.size());
    EXPECT_LT((one - first).cwiseAbs().maxCoeff(), 1e-8);
    const Model model = build_model(row(kind, 1));
    const Eigen::VectorXd engine = run_engine(row(kind, 1), 0.05);
    const Eigen::VectorXd start = engine_values(model, initial_positions(model), true);
    EXPECT_LT((one - engine).cwiseAbs().maxCoeff(), 0.02 * (engine - start).cwiseAbs().maxCoeff())
        << "RATE: the reference's 20 steps";
  }
}

}  // namespace
}  // namespace pliant::reference_tests
