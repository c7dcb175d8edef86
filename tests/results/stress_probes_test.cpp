// Stresses and strains of probes and frames: uniform deformations in closed form, and the virial of the forces.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "bodies/initial_state.hpp"
#include "results/body_motion.hpp"
#include "results/point_states.hpp"
#include "setup/build_model.hpp"
#include "support/probing.hpp"

namespace pliant::dynamics_tests {
namespace {

using Matrix = Eigen::Matrix2d;

const Matrix deformation = (Matrix() << 1.2, 0.3, -0.1, 0.85).finished();

/// A disc of mu = 1, lambda = 4, put in with a turn of 0.7 and then deformed by `deformation`.
class DeformedDisc : public ::testing::Test {
 protected:
  DeformedDisc() : model_(build_model(scene())), position_(initial_positions(model_)) {
    for (std::size_t i = 0; i < position_.compliant.size(); i += 2)
      for (int lane = 0; lane < lane_count; ++lane) {
        const Vec2 x = deformation * Vec2(position_.compliant[i][lane], position_.compliant[i + 1][lane]);
        position_.compliant[i][lane] = x.x(), position_.compliant[i + 1][lane] = x.y();
      }
    states_ = point_states(model_, model_.bodies[0], position_, initial_memory(model_));
  }
  static Scene scene() {
    Scene scene = free_disc(60, 1);
    scene.grains[0].angle = 0.7;
    return scene;
  }

  Model model_;
  Dofs position_;
  std::vector<PointState> states_;
};

constexpr double gradient_rounding =
    1e-11;  ///< of table gradients that reproduce linear fields to 1e-12, on a radius of 1

TEST_F(DeformedDisc, stress_is_that_of_the_law) {
  // EXACT: s = mu/J (F F^T - 1) + lambda ln J/J; the initial turn drops out.
  const double J = deformation.determinant();
  const Matrix s =
      (deformation * deformation.transpose() - Matrix::Identity() + 4 * std::log(J) * Matrix::Identity()) / J;
  for (const PointState& p : states_) {
    EXPECT_NEAR(p.jacobian, J, gradient_rounding);
    EXPECT_NEAR(p.stress.xx, s(0, 0), gradient_rounding);
    EXPECT_NEAR(p.stress.yy, s(1, 1), gradient_rounding);
    EXPECT_NEAR(p.stress.xy, s(0, 1), gradient_rounding);
    EXPECT_NEAR(p.stress.zz, 4 * std::log(J) / J, gradient_rounding);
    EXPECT_NEAR(p.energy, 0.0872207960699283, gradient_rounding) << "EXACT: psi/mu of an independent evaluation";
  }
}

TEST_F(DeformedDisc, strain_is_turned_back) {
  // EXACT: (F^T F - 1)/2 with F from the placed grain on.
  const Matrix E = 0.5 * (deformation.transpose() * deformation - Matrix::Identity());
  for (const PointState& p : states_) {
    EXPECT_NEAR(p.strain[0], E(0, 0), gradient_rounding);
    EXPECT_NEAR(p.strain[1], E(1, 1), gradient_rounding);
    EXPECT_NEAR(p.strain[2], E(0, 1), gradient_rounding);
  }
}

TEST_F(DeformedDisc, weights_are_the_area) {
  double area = 0;
  for (const PointState& p : states_) area += p.weight;
  EXPECT_NEAR(area, model_.bodies[0].area, gradient_rounding) << "EXACT";
}

TEST(StressInvariants, are_those_of_the_tensor) {
  // EXACT, with Eigen's eigenvalues of the tensor in space.
  const Stress s{0.3, -1.1, 0.7, 0.2};
  Eigen::Matrix3d tensor;
  tensor << s.xx, s.xy, 0, s.xy, s.yy, 0, 0, 0, s.zz;
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvalues();
  const Eigen::Matrix3d deviator = tensor - tensor.trace() / 3 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(von_mises(s), std::sqrt(1.5) * deviator.norm(), 1e-14);
  EXPECT_NEAR(tresca(s), values.maxCoeff() - values.minCoeff(), 1e-14);
  EXPECT_NEAR(pressure(s), -tensor.trace() / 3, 1e-14);
  EXPECT_NEAR(tresca({1, 0.9, 0, -2}), 3, 1e-14) << "EXACT: the stress out of the plane counts";
  const Principal p = principal(s.xx, s.yy, s.xy);
  EXPECT_NEAR(p.first + p.second, s.xx + s.yy, 1e-14);
  EXPECT_NEAR(p.first * p.second, s.xx * s.yy - s.xy * s.xy, 1e-14);
  EXPECT_GT(p.first, p.second);
}

/// A compliant and a rigid disc squeezed together between two walls.
Scene squeezed_pair() {
  Scene scene = empty_scene(3);
  scene.period = 4;
  scene.shapes = {disc_shape("disc", 2, 60)};
  scene.grains = {grains("soft", "disc", BodyKind::compliant, {{2, 0}}),
                  grains("hard", "disc", BodyKind::rigid, {{2.1, 2.01}})};
  scene.walls = {flat_wall("lower", Wall::Solid::below, -1.01, 0.2), flat_wall("upper", Wall::Solid::above, 3.02, 0.2)};
  scene.walls[1].y = {AxisCondition::Mode::velocity, {{0}, {-0.05}}};
  scene.contacts = {mohr_coulomb(100, 0.3)};
  return scene;
}

/// sum f (x) (x - centre) over outline nodes.
Matrix contact_moment(const Simulation& simulation, int b) {
  const State& state = simulation.state();
  const Vec2 centre = centre_of(simulation.model(), simulation.model().bodies[b], simulation.state().position);
  Matrix moment = Matrix::Zero();
  for (int i = simulation.model().outline_offset[b]; i < simulation.model().outline_end(b); ++i)
    moment += state.contact_force.at(i) * (state.outlines.position.at(i) - centre).transpose();
  return moment;
}

TEST(StressProbes, mean_stress_is_the_virial_of_the_forces) {
  const Model model = build_model(squeezed_pair());
  Simulation simulation(model);
  advance(simulation, 3);
  const State& state = simulation.state();
  const Body& body = model.bodies[0];
  // EXACT: area x mean stress = contact forces (x) x - total nodal forces (x) x, nodes' own inertia.
  Matrix virial = contact_moment(simulation, 0);
  const Vec2 centre = mass_mean(model, body, state.position);
  for (int i = 0; i < model.shape_of(body).nodes(); ++i)
    virial -=
        node_value(model, body, state.force, i) * (node_value(model, body, state.position, i) - centre).transpose();
  double area = 0;
  for (const PointState& p : point_states(model, body, state.position, state.memory)) area += p.weight * p.jacobian;
  const std::vector<double> s = measured(simulation, probe_of("stress", "soft"));
  EXPECT_LT(s[1], -0.05) << "it is pressed";
  EXPECT_NEAR(s[0], virial(0, 0) / area, gradient_rounding);
  EXPECT_NEAR(s[1], virial(1, 1) / area, gradient_rounding);
  EXPECT_NEAR(s[2], virial(0, 1) / area, gradient_rounding);
  EXPECT_NEAR(s[2], virial(1, 0) / area, gradient_rounding);
  // EXACT: invariants of the mean.
  EXPECT_NEAR(s[4] + s[5], s[0] + s[1], gradient_rounding);
  EXPECT_NEAR(s[6], von_mises({s[0], s[1], s[2], s[3]}), gradient_rounding);
  EXPECT_NEAR(s[8], -(s[0] + s[1] + s[3]) / 3, gradient_rounding);
}

TEST(StressProbes, extremes_and_nodes_are_local) {
  const Model model = build_model(squeezed_pair());
  Simulation simulation(model);
  advance(simulation, 3);
  const Probe jacobian = probe_of("jacobian", "all");
  const double mean = measured(simulation, jacobian)[0],
               least = measured(simulation, reduced_by(Reduction::min, jacobian))[0],
               largest = measured(simulation, reduced_by(Reduction::max, jacobian))[0];
  EXPECT_LT(least, mean);
  EXPECT_GT(largest, mean);
  double expected = 1e300;
  for (const PointState& p :
       point_states(model, model.bodies[0], simulation.state().position, simulation.state().memory))
    expected = std::min(expected, p.jacobian);
  EXPECT_EQ(least, expected) << "EXACT";
  // The local mean lies between the extremes; nodes at the pressed pole and at the side differ.
  const FieldMesh& mesh = model.shape_of(model.bodies[0]).space.mesh;
  int top = 0, side = 0;
  for (int k = 0; k < mesh.outline_count; ++k) {
    if (mesh.nodes[k].y() > mesh.nodes[top].y()) top = k;
    if (mesh.nodes[k].x() > mesh.nodes[side].x()) side = k;
  }
  const auto yy_at = [&](int k) { return measured(simulation, at_node(k, probe_of("stress", "soft")))[1]; };
  EXPECT_LT(yy_at(top), 3 * yy_at(side)) << "the pole is pressed, the side is free";
  EXPECT_LT(yy_at(top), 0);
  EXPECT_GT(measured(simulation, probe_of("von_mises", "soft"))[0], measured(simulation, probe_of("stress", "soft"))[6])
      << "EXACT: a norm is convex, so the mean of norms is not less than that of the mean";
}

TEST(StressProbes, contact_stress_is_love_and_weber) {
  const Model model = build_model(squeezed_pair());
  Simulation simulation(model);
  advance(simulation, 3);
  const auto rows_of = [&](const Probe& probe) { return measured(simulation, probe); };
  const Matrix expected = contact_moment(simulation, 0) + contact_moment(simulation, 1);
  const double area = rows_of(probe_of("area", "all"))[0];
  const std::vector<double> all = rows_of(probe_of("contact_stress", "all"));
  EXPECT_NEAR(all[0], expected(0, 0) / area, gradient_rounding) << "EXACT";
  EXPECT_NEAR(all[1], expected(0, 1) / area, gradient_rounding) << "EXACT";
  EXPECT_NEAR(all[2], expected(1, 0) / area, gradient_rounding) << "EXACT";
  EXPECT_NEAR(all[3], expected(1, 1) / area, gradient_rounding) << "EXACT";
  EXPECT_NEAR(all[6], -0.5 * (all[0] + all[3]), gradient_rounding) << "EXACT";
  EXPECT_LT(all[3], 0) << "pressed";
  // EXACT: over the gap between the walls, 4 wide and 3.02 + 1.01 - 0.15 high.
  Probe layer = probe_of("contact_stress", "all");
  layer.between = {"upper", "lower"};
  EXPECT_NEAR(rows_of(layer)[3], expected(1, 1) / (4 * 3.88), gradient_rounding);
  // EXACT: the box holds the centre of the rigid disc alone, one period off.
  Probe boxed = probe_of("contact_stress", "all");
  boxed.box = ProbeBox{{5, 1}, {7, 3}};
  EXPECT_NEAR(rows_of(boxed)[3], contact_moment(simulation, 1)(1, 1) / 4, gradient_rounding);
}

}  // namespace
}  // namespace pliant::dynamics_tests
