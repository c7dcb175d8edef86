#include "reference/clusters.hpp"

#include "setup/build_model.hpp"

#include <gtest/gtest.h>

namespace pliant::reference_tests {
namespace {

using namespace dynamics_tests;
using reference::SolverOptions;
using reference::Vector;

/// Forces of contacts and bonds on all outline nodes, N/m, [2 outline nodes].
Vector engine_contact_forces(const Simulation& simulation) {
  const OutlineField& force = simulation.state().contact_force;
  const Model& model = simulation.model();
  std::vector<double> values;
  for (std::size_t b = 0; b < simulation.model().bodies.size(); ++b)
    for (int i = model.outline_offset[b]; i < model.outline_end(b); ++i)
      values.insert(values.end(), {force.x[i], force.y[i]});
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Vector reference_contact_forces(const ReferenceRun& run) {
  Vector forces = Vector::Zero(2 * run.system.bodies().outline_nodes());
  for (const reference::ContactElement& element : run.stepping.forces().contacts.elements)
    for (int i = 0; i < 6; ++i) forces[2 * element.node[i / 2] + i % 2] -= element.force[i];
  for (const reference::BondElement& element : run.stepping.forces().bonds.elements)
    for (int i = 0; i < 12; ++i) forces[2 * element.node[i / 2] + i % 2] -= element.force[i];
  return forces;
}

struct Differences {
  double centres = 0;    ///< largest, over the diameter
  double positions = 0;  ///< of all degrees of freedom
  double forces = 0;     ///< of outline nodes, over the largest
  double kinetic = 0;    ///< of the engine at the end, over its strain energy
};

/// The damped engine at rest, and the static reference solver.
Differences compare_at_rest(const Scene& scene, int load_steps) {
  const Model model = build_model(scene);
  Simulation simulation(model);
  advance(simulation, scene.time.end);
  SolverOptions options;
  options.statics = true;
  ReferenceRun run(scene, options);
  run.run(load_steps);
  Differences result;
  const Vector engine = engine_positions(simulation), difference = engine - run.stepping.motion().q;
  for (const reference::Body& body : run.system.bodies().all()) {
    Vec2 mean(0, 0);
    const Vector mass = run.system.bodies().lumped_mass();
    double whole = 0;
    for (int i = 0; i < (body.compliant() ? body.dofs : 2); i += 2) {
      mean += mass[body.first_dof + i] * difference.segment<2>(body.first_dof + i);
      whole += mass[body.first_dof + i];
    }
    result.centres = std::max(result.centres, mean.norm() / whole / 2);
  }
  result.positions = difference.cwiseAbs().maxCoeff() / 2;
  const Vector forces = reference_contact_forces(run);
  result.forces = (engine_contact_forces(simulation) - forces).cwiseAbs().maxCoeff() / forces.cwiseAbs().maxCoeff();
  const Energies energy = simulation.energy_balance().energy;
  result.kinetic = energy.kinetic / energy.strain;
  return result;
}

struct ClusterCase {
  const char* name;
  int rings, nodes;
  bool mixed;
};

class ReferenceClusters : public ::testing::TestWithParam<ClusterCase> {};

// INDEPENDENT: equilibrium does not depend on the way to it when nothing rubs; what is left is the engine's motion that
// damping has not taken out yet (exp(-t) of its slowest modes) and Newton's tolerance.
TEST_P(ReferenceClusters, frictionless_equilibrium_agrees_with_the_damped_engine) {
  const Scene scene = pushed_cluster(GetParam().rings, GetParam().nodes, GetParam().mixed, frictionless(60), 0.04, 40);
  const Differences difference = compare_at_rest(scene, 20);
  RecordProperty("centres", std::to_string(difference.centres));
  std::printf("%s: centres %.2e, positions %.2e of the diameter, forces %.2e, kinetic/strain %.1e\n", GetParam().name,
              difference.centres, difference.positions, difference.forces, difference.kinetic);
  EXPECT_LT(difference.centres, 1e-6);
  EXPECT_LT(difference.forces, 1e-4);
}

/// Bonds that hold whatever comes: they open by 1 before they soften.
Scene glued(Scene scene) {
  BondRule rule;
  rule.first = rule.second = "all";
  rule.gap = 0.05;
  rule.strength = 60, rule.fracture_energy = 60;
  scene.bonds = {rule};
  return scene;
}

// INDEPENDENT: grains that are bonded. Bonds store energy and nothing slips, so equilibrium does not depend on the way
// to it. Tolerances as without bonds.
TEST(ReferenceClusters, bonded_equilibrium_agrees_with_the_damped_engine) {
  for (const bool mixed : {false, true}) {
    const Differences difference = compare_at_rest(glued(pushed_cluster(1, 60, mixed, frictionless(60), 0.02, 40)), 20);
    std::printf("7 bonded, %s: centres %.2e, positions %.2e of the diameter, forces %.2e\n",
                mixed ? "mixed" : "compliant", difference.centres, difference.positions, difference.forces);
    EXPECT_LT(difference.centres, 1e-6);
    EXPECT_LT(difference.positions, 1e-6);
    EXPECT_LT(difference.forces, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Clusters, ReferenceClusters,
                         ::testing::Values(ClusterCase{"7 compliant", 1, 60, false},
                                           ClusterCase{"7 mixed", 1, 60, true},
                                           ClusterCase{"19 compliant", 2, 60, false},
                                           ClusterCase{"19 mixed", 2, 60, true}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace pliant::reference_tests
