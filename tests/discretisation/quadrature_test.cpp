#include "discretisation/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../geometry/shapes.hpp"

namespace pliant {
namespace {

double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

// EXACT: integral of x^a y^b over the unit triangle is a! b!/(a + b + 2)!, up to the rule's degree; one degree
// higher the rule fails, so that the check can.
TEST(Quadrature, IntegratesPolynomialsUpToItsDegree) {
  for (const auto& [points, degree] : {std::pair(1, 1), std::pair(3, 2), std::pair(6, 4)}) {
    double worst_above = 0;
    for (int a = 0; a <= degree + 1; ++a)
      for (int b = 0; a + b <= degree + 1; ++b) {
        double sum = 0;
        for (const QuadraturePoint& p : triangle_rule(points))
          sum += p.share / 2 * std::pow(p.barycentric[1], a) * std::pow(p.barycentric[2], b);
        const double error = std::abs(sum - factorial(a) * factorial(b) / factorial(a + b + 2));
        if (a + b > degree) {
          worst_above = std::max(worst_above, error);
        } else {
          EXPECT_LT(error, 1e-15) << points << " points, x^" << a << " y^" << b;
        }
      }
    EXPECT_GT(worst_above, 1e-5);
  }
}

// EXACT: weights sum to the area, first moments about the centroid vanish, all to rounding.
TEST(Quadrature, MeshAreaAndFirstMoments) {
  for (const ShapeSpec& shape : testing::all_shapes())
    for (const int points : {1, 3, 6}) {
      const FieldMesh mesh = make_field_mesh(shape);
      const double area = polygon_properties(testing::outline_of(mesh)).area;
      const MeshQuadrature q = mesh_quadrature(mesh, points);
      double sum = 0;
      Vec2 moment(0, 0);
      for (std::size_t g = 0; g < q.weight.size(); ++g) sum += q.weight[g], moment += q.weight[g] * q.position[g];
      EXPECT_NEAR(sum / area, 1, 1e-13);
      EXPECT_LT(moment.norm(), 1e-13 * std::pow(area, 1.5));
    }
}

TEST(Quadrature, RefusesOtherRules) {
  EXPECT_NE(testing::error_of([] { triangle_rule(4); }).find("1, 3 or 6"), std::string::npos);
}

}  // namespace
}  // namespace pliant
