// What `check` foretells of thin shapes: strips that bend, and where a shape is thin.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "cli/thin_parts.hpp"
#include "discretisation/consistent_gradients.hpp"
#include "discretisation/table.hpp"
#include "geometry/shapes.hpp"
#include "setup/build_model.hpp"
#include "support/scenes.hpp"

namespace pliant::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double lambda = 4, mu = 1;  // plane strain, nu = 0.4

ShapeSpec strip(double length, int segments_across) {
  ShapeSpec shape = polygon("strip", {{0, 0}, {length, 0}, {length, 1}, {0, 1}}, 0);
  shape.nodes = {}, shape.spacing = 1.0 / segments_across;
  return shape;
}

// Small-strain stiffness, [2 nodes x 2 nodes], with rigid motions held.
MatrixXd held_stiffness(const Discretisation& d) {
  const auto size = static_cast<Eigen::Index>(2 * d.mesh.nodes.size());
  MatrixXd k = MatrixXd::Zero(size, size), rigid = MatrixXd::Zero(size, 3);
  for (std::size_t g = 0; g < d.table.weight.size(); ++g)
    for (int a = d.table.start[g]; a < d.table.start[g + 1]; ++a)
      for (int b = d.table.start[g]; b < d.table.start[g + 1]; ++b) {
        const Vec2 &p = d.table.gradient[a], &q = d.table.gradient[b];
        k.block<2, 2>(2 * d.table.node[a], 2 * d.table.node[b]) +=
            d.table.weight[g] *
            (lambda * p * q.transpose() + mu * q * p.transpose() + mu * p.dot(q) * Eigen::Matrix2d::Identity());
      }
  for (Eigen::Index i = 0; i < size / 2; ++i) {
    rigid(2 * i, 0) = rigid(2 * i + 1, 1) = 1;
    rigid.block<2, 1>(2 * i, 2) << -d.mesh.nodes[i].y(), d.mesh.nodes[i].x();
  }
  return k + rigid * rigid.transpose();
}

struct Bent {
  double work, moment;  ///< of the end forces over the way that they make; of them at one end
};

// Linear tractions on both ends, as outline nodes stand for them.
Bent bend(double length, int segments_across, DiscretisationMethod method) {
  const Discretisation d = discretise(make_field_mesh(strip(length, segments_across)), {.method = method});
  const Points tributary = tributary_vectors(d.mesh);
  VectorXd force = VectorXd::Zero(static_cast<Eigen::Index>(2 * d.mesh.nodes.size()));
  double moment = 0;
  for (int k = 0; k < d.mesh.outline_count; ++k) {
    const double y = d.mesh.nodes[k].y(), pull = y * tributary[k].x();
    if (pull * d.mesh.nodes[k].y() > 0) moment += pull * y;
    for (int e = d.outline_rows.start[k]; e < d.outline_rows.start[k + 1]; ++e)
      force[2 * d.outline_rows.node[e]] += d.outline_rows.value[e] * pull;
  }
  const Eigen::LDLT<MatrixXd> stiffness(held_stiffness(d));
  return {force.dot(stiffness.solve(force)), moment};
}

// How much too far a strip bends, from strips of 5 and 10 widths: ends, which bend by themselves, are the same.
double measured_error(int segments_across, DiscretisationMethod method) {
  const Bent shorter = bend(5, segments_across, method), longer = bend(10, segments_across, method);
  const double rigidity = 4 * mu * (lambda + mu) / (lambda + 2 * mu) / 12;  // E/(1 - nu^2) times the second moment
  return (longer.work - shorter.work) / (5 * longer.moment * longer.moment / rigidity) - 1;
}

constexpr std::array methods{DiscretisationMethod::mls, DiscretisationMethod::mls_gauss, DiscretisationMethod::t3,
                             DiscretisationMethod::es_t3, DiscretisationMethod::rpim};

// FROZEN: what check knows, to the last of its digits and what another compiler's mesh may change, a fiftieth.
TEST(BendingErrors, are_those_that_check_knows) {
  for (const DiscretisationMethod method : methods)
    for (const int n : {1, 2, 3, 4, 6, 8}) {
      const double found = measured_error(n, method);
      EXPECT_NEAR(*bending_error(method, n), found, 6e-4 + 0.02 * std::abs(found))
          << static_cast<int>(method) << ", " << n << " across";
    }
}

// INDEPENDENT: beam theory, whose moment bends a strip without shear: exact between the ends. Errors of order 1/n^2
// that are of order one with one segment across are below (1/8)^2 times two with eight, but for linear triangles, whose
// coefficient is the shear that a bent triangle cannot but have, 2 (1 - nu)/(1 - 2 nu) = 6 times as much.
TEST(BendingErrors, go_to_nothing) {
  for (const DiscretisationMethod method : methods)
    EXPECT_LT(std::abs(measured_error(8, method)), (method == DiscretisationMethod::t3 ? 6 : 2) / 64.0)
        << static_cast<int>(method);
}

// EXACT: lines in 1/n^2 between what was measured, that power beyond, the coarsest below.
TEST(BendingErrors, between_those_that_were_measured) {
  const double coarse = *bending_error(DiscretisationMethod::mls, 2),
               fine = *bending_error(DiscretisationMethod::mls, 3);
  const double n = 1 / std::sqrt(0.5 * (1.0 / 4 + 1.0 / 9));
  EXPECT_NEAR(*bending_error(DiscretisationMethod::mls, n), 0.5 * (coarse + fine), 1e-12);
  EXPECT_NEAR(*bending_error(DiscretisationMethod::t3, 16), *bending_error(DiscretisationMethod::t3, 8) / 4, 1e-12);
  EXPECT_EQ(*bending_error(DiscretisationMethod::mls, 0.3), *bending_error(DiscretisationMethod::mls, 1));
}

// EXACT: thickness and place of limbs drawn by hand, and bodies that have none.
TEST(ThinParts, are_found) {
  const std::optional<ThinPart> whole = thinnest_part(make_outline(strip(6, 3)));
  ASSERT_TRUE(whole);
  EXPECT_NEAR(whole->thickness, 1, 1e-12);
  EXPECT_NEAR(whole->segments_across, 3, 1e-12);
  ShapeSpec hammer = polygon("hammer", {{0, 0}, {3, 0}, {3, 1.2}, {9, 1.2}, {9, 1.8}, {3, 1.8}, {3, 3}, {0, 3}}, 0);
  hammer.nodes = {}, hammer.spacing = 0.3;
  const std::optional<ThinPart> handle = thinnest_part(make_outline(hammer));
  ASSERT_TRUE(handle);
  EXPECT_NEAR(handle->thickness, 0.6, 1e-12);
  EXPECT_NEAR(handle->segments_across, 2, 1e-12);
  EXPECT_NEAR(handle->position.x() + polygon_properties(hammer.points).centroid.x(), 6, 0.3);
  const Points square = make_outline(testing::square(150)), round = make_outline(disc(60, 1));
  EXPECT_FALSE(thinnest_part(square));
  EXPECT_FALSE(thinnest_part(round)) << "bends nowhere";
  ShapeSpec wedge = polygon("wedge", {{0, 0}, {9, -1.5}, {9, 1.5}}, 0);  // 19 degrees
  wedge.nodes = {}, wedge.spacing = 0.3;
  EXPECT_FALSE(thinnest_part(make_outline(wedge))) << "thick and thin";
}

std::string bending_of(double length, int segments_across, DiscretisationMethod method = DiscretisationMethod::mls) {
  Scene scene = empty_scene(1);
  scene.discretisation.method = method;
  scene.shapes = {strip(length, segments_across)};
  add_grain(scene, "strip", BodyKind::compliant, {0, 0});
  return describe_bending(build_model(scene));
}

// EXACT: words where the error is worth them.
TEST(ThinParts, of_a_scene_are_told) {
  const std::string text = bending_of(6, 2);
  EXPECT_NE(text.find("'strip' is 2 segments across, 1 m"), std::string::npos) << text;
  EXPECT_NE(text.find("bent 20 % too far; from 4 across on, as with spacing = \"0.25 m\", by less than 5 %"),
            std::string::npos)
      << text;
  EXPECT_NE(bending_of(6, 1).find("'strip' is 1 segment across"), std::string::npos);
  EXPECT_NE(bending_of(6, 2, DiscretisationMethod::t3).find("too little"), std::string::npos);
  EXPECT_EQ(bending_of(6, 4), "");
  EXPECT_EQ(bending_of(1.5, 2), "") << "no limb";
}

}  // namespace
}  // namespace pliant::testing
