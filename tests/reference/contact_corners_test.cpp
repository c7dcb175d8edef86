// Contact of the reference solver at sharp corners: lengths that change with the places of nodes, and their
// derivatives.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "reference/contact/contacts.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;
using reference::ContactOutline;
using reference::ContactResult;
using reference::Contacts;

constexpr double kn = 100;

/// Two blocks face to face, one shifted along the other so that both faces end within a segment of a node, every node
/// shaken.
struct Blocks {
  Blocks(const ContactRule& rule, double shift, double gap, double tilt, int sample) {
    Scene scene = bare_scene();
    scene.contacts = {rule};
    const Points lower = rectangle(1, 0.5, 0.1), upper = rectangle(0.7, 0.5, 0.13);
    const int n = static_cast<int>(lower.size()), m = static_cast<int>(upper.size());
    contacts = std::make_unique<Contacts>(
        scene, std::vector<ContactOutline>{{0, n, 0, lower, "hard", "lower", false, BodyKind::rigid},
                                           {n, m, 0, upper, "hard", "upper", false, BodyKind::rigid}});
    x = lower;
    Random random(sample);
    for (const Vec2& p : upper) x.push_back(Eigen::Rotation2Dd(tilt) * p + Vec2(shift, 0.5 + gap));
    for (Vec2& p : x) p += Vec2{random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
    contacts->evaluate(x);
    contacts->accept();
    for (Vec2& p : x) p += Vec2{random.uniform(-1e-4, 1e-4), random.uniform(-1e-4, 1e-4)};
  }

  Eigen::VectorXd residual() {
    const Points force = forces_on_nodes(contacts->evaluate(x), x.size());
    Eigen::VectorXd result(2 * static_cast<Eigen::Index>(force.size()));
    for (std::size_t i = 0; i < force.size(); ++i) result.segment<2>(2 * static_cast<Eigen::Index>(i)) = -force[i];
    return result;
  }
  double stored() { return contacts->evaluate(x).stored; }
  Eigen::MatrixXd tangent() {
    const ContactResult result = contacts->evaluate(x);
    const Eigen::Index size = 2 * static_cast<Eigen::Index>(x.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
    const auto add = [&](const auto& nodes, const auto& part) {
      for (Eigen::Index i = 0; i < part.rows(); ++i)
        for (Eigen::Index j = 0; j < part.cols(); ++j)
          K(2 * nodes[static_cast<std::size_t>(i / 2)] + i % 2, 2 * nodes[static_cast<std::size_t>(j / 2)] + j % 2) +=
              part(i, j);
    };
    for (const auto& element : result.elements) add(element.node, element.tangent);
    for (const auto& element : result.lengths) add(element.node, element.tangent);
    varying += static_cast<int>(result.lengths.size());
    return K;
  }
  /// Column of central differences by one coordinate.
  template <class Function>
  auto derivative(Eigen::Index coordinate, Function&& function) {
    double& at = x[static_cast<std::size_t>(coordinate / 2)][coordinate % 2];
    const double before = at;
    at = before + step;
    const auto above = function();
    at = before - step;
    const auto below = function();
    at = before;
    return std::pair(above, below);
  }

  static constexpr double step = 1e-6;
  std::unique_ptr<Contacts> contacts;
  Points x;
  int varying = 0;
};

template <class Check>
int on_blocks(Check&& check) {
  int varying = 0, sample = 0;
  for (const ContactRule& rule : {frictionless(kn), cohesive(kn, 0.5, 0.05, 0)})
    for (const double shift : {0.0, 0.183, 0.52, -0.61})
      for (const double gap : {-0.004, 0.006})
        for (const double tilt : {0.0, 0.03, -0.6}) {
          if (gap > 0 && rule.law == ContactLawKind::frictionless) continue;
          SCOPED_TRACE(std::to_string(shift) + " " + std::to_string(gap) + " " + std::to_string(tilt));
          const double lift = tilt < -0.1 ? 0.35 * std::abs(std::sin(tilt)) - 0.25 * (1 - std::cos(tilt)) : 0;
          Blocks blocks(rule, shift, gap + lift, tilt, ++sample);
          check(blocks);
          varying += blocks.varying;
        }
  return varying;
}

// INDEPENDENT: forces are minus the differences of the stored energy. Energies of order 0.01 round to 1e-18: 1e-12 over
// the step; third derivatives, of shares of a quarter of a segment, 0.025: 1e-12 x 0.01 / 1.6e-5, tenfold by powers.
TEST(ReferenceContactCorners, ForceIsMinusTheEnergyGradient) {
  on_blocks([](Blocks& blocks) {
    const Eigen::VectorXd residual = blocks.residual();
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
      const auto [above, below] = blocks.derivative(i, [&] { return blocks.stored(); });
      EXPECT_NEAR((above - below) / (2 * Blocks::step), residual[i], 1e-8) << i;
    }
  });
}

// EXACT up to the central difference: forces of order 1 change by third derivatives of 1e3: 1e-9 of kn.
TEST(ReferenceContactCorners, TangentIsTheDerivativeOfTheForce) {
  const int varying = on_blocks([](Blocks& blocks) {
    const Eigen::MatrixXd K = blocks.tangent();
    for (Eigen::Index i = 0; i < K.cols(); ++i) {
      const auto [above, below] = blocks.derivative(i, [&] { return blocks.residual(); });
      EXPECT_LE(((above - below) / (2 * Blocks::step) - K.col(i)).norm(), 1e-6 * K.norm()) << i;
    }
  });
  EXPECT_GT(varying, 20) << "or lengths did not change";
}

}  // namespace
}  // namespace pliant
