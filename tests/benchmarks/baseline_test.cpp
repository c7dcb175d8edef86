// The plain loops that benchmarks time beside the engine compute what the engine computes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "benchmarks/baseline/from_model.hpp"
#include "bodies/body_view.hpp"
#include "bodies/internal_forces.hpp"
#include "dynamics/simulation.hpp"
#include "setup/build_model.hpp"
#include "support/contact_rig.hpp"

namespace pliant {
namespace {

using namespace testing;

/// Hexagonal packing of 6 x 4 discs, compliant and rigid ones, squeezed: neighbours nearer than a diameter. Smooth
/// outlines, so that no corner has a say.
Scene squeezed(const ContactRule& rule) {
  Scene scene = bare_scene();
  scene.period = 6 * 0.86;
  scene.shapes = {disc_shape("disc", 1, 168)};
  Grains layer = grains("layer", "disc", BodyKind::compliant, {});
  layer.packing = {PackingKind::hexagonal, 6, 4, 0.86, 0.99, {0.43, 0}, {}};
  layer.species = {{BodyKind::compliant, "soft", 0.5}, {BodyKind::rigid, "hard", 0.5}};
  layer.seed = 3;
  layer.angle.reset();
  scene.grains = {layer};
  scene.contacts = {rule};
  return scene;
}

/// All bodies sheared and each turned a little, as in a step; centres of compliant bodies stay where they are.
void shear(ContactRig& rig, double size) {
  for (const Body& body : rig.model.bodies) {
    const double y = body.centre.y();
    if (body.kind == BodyKind::rigid) {
      double* q = &rig.q.rigid[3 * static_cast<std::size_t>(body.rigid)];
      q[0] += size * y, q[1] += 0.2 * size * std::sin(3 * q[0]), q[2] += 0.3 * size;
      continue;
    }
    const BodyOffsets offsets(rig.model, body);
    for (int i = 0; i < rig.model.shape_of(body).nodes(); ++i) {
      const auto node = static_cast<std::size_t>(i);
      const Vec2 x = BodyView(rig.model, body, rig.q)[node];
      set_node(offsets, node, x + size * Vec2(y + 0.5 * x.y(), 0.4 * x.x()), rig.q);
    }
  }
}

double largest(const OutlineField& field) {
  double result = 0;
  for (const double f : field.x) result = std::max(result, std::abs(f));
  for (const double f : field.y) result = std::max(result, std::abs(f));
  return result;
}

/// Largest difference of forces on outline nodes.
double difference(const ContactRig& rig, const std::vector<baseline::Body>& bodies) {
  double result = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t k = 0; k < bodies[b].outline.size(); ++k) {
      const Vec2 f = rig.force(static_cast<int>(b), static_cast<int>(k));
      result = std::max({result, std::abs(f.x() - bodies[b].outline[k].fx), std::abs(f.y() - bodies[b].outline[k].fy)});
    }
  return result;
}

/// EXACT: the same nodes touch, and forces are the same but for rounding, also after three small steps, in which nodes
/// change segments. Tolerance: slips are differences of places on an outline, whose rounding, 1e-16 of an outline's 100
/// numbers, is small against a segment and not against a step of a thousandth of one.
void expect_same_contact(const ContactRule& rule) {
  ContactRig rig(squeezed(rule));
  std::vector<baseline::Body> bodies = baseline::bodies_of(rig.model, rig.q);
  baseline::place_outlines(bodies);
  baseline::Contact contact = baseline::contact_of(rig.model, rig.contact, bodies);
  contact.find_candidates(bodies);
  for (int step = 0; step < 4; ++step) {
    if (step > 0) {
      shear(rig, 2e-3);
      baseline::move_to(rig.model, rig.q, bodies);
      baseline::place_outlines(bodies);
    }
    rig.step();
    contact.forces(bodies);
    EXPECT_EQ(contact.contacts(), rig.totals.contacts) << "step " << step;
    EXPECT_GT(contact.contacts(), 200);
    EXPECT_LT(difference(rig, bodies), 1e-11 * largest(rig.forces)) << "step " << step;
  }
  baseline::gather_outline_forces(bodies);
  const Dofs f = rig.dof_forces();
  const double scale = largest(rig.forces);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = rig.model.bodies[b];
    if (body.kind == BodyKind::rigid) {
      const double* resultant = &f.rigid[3 * static_cast<std::size_t>(body.rigid)];
      EXPECT_NEAR(bodies[b].fx, resultant[0], 1e-10 * scale);
      EXPECT_NEAR(bodies[b].fy, resultant[1], 1e-10 * scale);
      EXPECT_NEAR(bodies[b].moment, resultant[2], 1e-10 * scale);
      continue;
    }
    const BodyView of_engine(rig.model, body, f);
    for (std::size_t i = 0; i < bodies[b].nodes.size(); ++i) {
      EXPECT_NEAR(bodies[b].nodes[i].fx, of_engine[i].x(), 1e-11 * scale);
      EXPECT_NEAR(bodies[b].nodes[i].fy, of_engine[i].y(), 1e-11 * scale);
    }
  }
}

TEST(Baseline, FrictionlessContactIsTheEngines) { expect_same_contact(frictionless(100)); }
TEST(Baseline, MohrCoulombContactIsTheEngines) { expect_same_contact(mohr_coulomb(100, 0.3, 0.01, 0.02)); }
TEST(Baseline, CohesiveContactIsTheEngines) { expect_same_contact(cohesive(100, 0.3, 0.01, 0.2)); }
TEST(Baseline, RigidPairsAreStifferAsTheEngines) {
  ContactRule rule = mohr_coulomb(0, 0.3);
  rule.stiffness.reset();
  expect_same_contact(rule);
}

/// EXACT: internal forces, outlines and a step of the update to 1e-12 of the largest.
TEST(Baseline, InternalForcesAndOutlinesAreTheEngines) {
  for (const DiscretisationMethod method : {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss,
                                            DiscretisationMethod::t3, DiscretisationMethod::es_t3}) {
    Scene scene = squeezed(frictionless(100));
    scene.discretisation.method = method;
    ContactRig rig(scene);
    shear(rig, 0.1);
    rig.show();
    std::vector<baseline::Body> bodies = baseline::bodies_of(rig.model, rig.q);
    baseline::place_outlines(bodies);
    baseline::internal_forces(bodies);
    Dofs f = zero_dofs(rig.model);
    double scale = 0;
    for (const Batch& batch : rig.model.batches)
      add_internal_forces(rig.model, batch, {.position = &rig.q.compliant[batch.offset]}, &f.compliant[batch.offset]);
    for (const Lanes& lanes : f.compliant) scale = std::max(scale, pliant::largest(abs(lanes)));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Body& body = rig.model.bodies[b];
      for (std::size_t k = 0; k < bodies[b].outline.size(); ++k) {
        const Vec2 x = rig.node(static_cast<int>(b), static_cast<int>(k));
        EXPECT_NEAR(bodies[b].outline[k].x, x.x(), 1e-14);
        EXPECT_NEAR(bodies[b].outline[k].y, x.y(), 1e-14);
      }
      if (body.kind == BodyKind::rigid) continue;
      const BodyView of_engine(rig.model, body, f);
      for (std::size_t i = 0; i < bodies[b].nodes.size(); ++i) {
        EXPECT_NEAR(bodies[b].nodes[i].fx, of_engine[i].x(), 1e-12 * scale);
        EXPECT_NEAR(bodies[b].nodes[i].fy, of_engine[i].y(), 1e-12 * scale);
      }
    }
  }
}

/// EXACT: a step of discs that ring and touch nothing, by the engine's scheme: the same places after it.
TEST(Baseline, AStepIsTheEngines) {
  Scene scene = free_disc(60, 1, stretching(0.1));
  const Model model = build_model(scene);
  Simulation simulation(model);
  std::vector<baseline::Body> bodies = baseline::bodies_of(model, simulation.state().position);
  const BodyView velocity(model, model.bodies[0], simulation.state().reduced_momentum);
  const BodyView force(model, model.bodies[0], simulation.state().force);
  for (std::size_t i = 0; i < bodies[0].nodes.size(); ++i) {
    baseline::Node& node = bodies[0].nodes[i];
    node.vx = velocity[i].x(), node.vy = velocity[i].y();
    node.fx = force[i].x(), node.fy = force[i].y();
  }
  for (int step = 0; step < 20; ++step) {
    const double before = simulation.state().time;
    simulation.step(1);
    for (baseline::OutlineNode& node : bodies[0].outline) node.fx = node.fy = 0;
    baseline::compliant_step(bodies, simulation.state().time - before);
  }
  const BodyView x(model, model.bodies[0], simulation.state().position),
      v(model, model.bodies[0], simulation.state().reduced_momentum);
  for (std::size_t i = 0; i < bodies[0].nodes.size(); ++i) {
    EXPECT_NEAR(bodies[0].nodes[i].x, x[i].x(), 1e-13);
    EXPECT_NEAR(bodies[0].nodes[i].vy, v[i].y(), 1e-12);
  }
}

}  // namespace
}  // namespace pliant
