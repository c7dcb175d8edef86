// The reference solver's discretisation by itself: what its shape functions, gradients and masses must obey.
#include "reference/discretisation/space.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/errors.hpp"
#include "reference/discretisation/consistency.hpp"
#include "reference/discretisation/moving_least_squares.hpp"
#include "reference/discretisation/quadrature.hpp"
#include "reference/shapes.hpp"
#include "support/random.hpp"

namespace pliant::reference {
namespace {

using namespace pliant::testing;

/// Rounding of sums of some twenty products of order one, in mean node distances.
constexpr double space_rounding = 1e-13;

FieldMesh in_node_distances(FieldMesh mesh) {
  const double unit = mean_node_distance(mesh);
  for (Vec2& x : mesh.nodes) x /= unit;
  return mesh;
}

Vec2 random_place(Random& random, const FieldMesh& mesh) {
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(random.below(static_cast<int>(mesh.triangles.size())))];
  const double a = random.uniform(0.05, 0.45), b = random.uniform(0.05, 0.45);
  return a * mesh.nodes[t[0]] + b * mesh.nodes[t[1]] + (1 - a - b) * mesh.nodes[t[2]];
}

TEST(ReferenceShapeFunctions, reproduce_linear_functions) {
  Random random(1);
  for (const ShapeSpec& shape : reference_shapes())
    for (const int support : {8, 10, 14}) {
      const FieldMesh mesh = in_node_distances(make_field_mesh(shape));
      const MovingLeastSquares mls(mesh.nodes, mesh.outline_count, support);
      for (int sample = 0; sample < 50; ++sample) {
        const Vec2 x = random_place(random, mesh);
        const Row row = mls.values(x);
        const Point point = mls.gradients(x);
        ASSERT_EQ(row.node, point.node);
        double one = 0;
        Vec2 place(0, 0), zero(0, 0);
        Eigen::Matrix2d identity = Eigen::Matrix2d::Zero();
        for (std::size_t i = 0; i < row.node.size(); ++i) {
          const Vec2 from = mesh.nodes[row.node[i]] - x;
          one += row.value[i], place += row.value[i] * from;
          zero += point.gradient[i], identity += from * point.gradient[i].transpose();
        }
        EXPECT_NEAR(one, 1, space_rounding) << "EXACT";
        EXPECT_LT(place.norm(), space_rounding) << "EXACT";
        EXPECT_LT(zero.norm(), 10 * space_rounding) << "EXACT";
        EXPECT_LT((identity - Eigen::Matrix2d::Identity()).norm(), 10 * space_rounding) << "EXACT";
      }
    }
}

/// The fit's value at x by the normal equations of a centred basis, solved by Cramer's rule: another algorithm.
double fit_at(const Points& nodes, const std::vector<double>& radius, const Vec2& x, int wanted) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double q = (nodes[i] - x).norm() / radius[i];
    const double w = q >= 1     ? 0
                     : q <= 0.5 ? 2.0 / 3 - 4 * q * q + 4 * q * q * q
                                : 4.0 / 3 - 4 * q + 4 * q * q - 4.0 / 3 * q * q * q;
    const Eigen::Vector3d p(1, nodes[i].x() - x.x(), nodes[i].y() - x.y());
    A += w * p * p.transpose();
    if (static_cast<int>(i) == wanted) right = w * p;
  }
  return (A.inverse() * right)[0];
}

TEST(ReferenceShapeFunctions, solve_the_normal_equations) {
  Random random(2);
  const FieldMesh mesh = in_node_distances(make_field_mesh(disc(60)));
  const int support = 8;
  std::vector<double> radius;
  for (const Vec2& a : mesh.nodes) {
    std::vector<double> distance;
    for (const Vec2& b : mesh.nodes) distance.push_back((a - b).norm());
    std::sort(distance.begin(), distance.end());
    radius.push_back(distance[support]);
  }
  const MovingLeastSquares mls(mesh.nodes, mesh.outline_count, support);
  for (int sample = 0; sample < 100; ++sample) {
    const Vec2 x = random_place(random, mesh);
    const Row row = mls.values(x);
    std::vector<double> value(mesh.nodes.size(), 0.0);
    for (std::size_t i = 0; i < row.node.size(); ++i) value[static_cast<std::size_t>(row.node[i])] = row.value[i];
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      EXPECT_NEAR(value[i], fit_at(mesh.nodes, radius, x, static_cast<int>(i)), 1e-12)
          << "EXACT: conditioning of the normal equations, 10, times rounding";
  }
}

TEST(ReferenceShapeFunctions, gradients_are_the_limit_of_differences) {
  Random random(3);
  const FieldMesh mesh = in_node_distances(make_field_mesh(reference_shapes().back()));
  const MovingLeastSquares mls(mesh.nodes, mesh.outline_count, 9);
  for (int sample = 0; sample < 200; ++sample) {
    const Vec2 x = random_place(random, mesh);
    const Point point = mls.gradients(x);
    for (int c = 0; c < 2; ++c) {
      const double h = 1e-5;
      const Row above = mls.values(x + h * Vec2::Unit(c)), below = mls.values(x - h * Vec2::Unit(c));
      if (above.node != point.node || below.node != point.node) continue;
      for (std::size_t i = 0; i < point.node.size(); ++i)
        EXPECT_NEAR(point.gradient[i][c], (above.value[i] - below.value[i]) / (2 * h), 1e-8)
            << "EXACT: h^2/6 of third derivatives of up to 1e2, and rounding 1e-15/h";
    }
  }
}

TEST(ReferenceSpace, gradients_of_mls_are_consistent) {
  for (const ShapeSpec& shape : reference_shapes()) {
    const FieldMesh mesh = make_field_mesh(shape);
    const double unit = mean_node_distance(mesh);
    Space space = make_space(mesh, settings_of(DiscretisationMethod::mls));
    for (Point& point : space.points) {
      point.weight /= unit * unit;
      for (Vec2& b : point.gradient) b *= unit;
    }
    EXPECT_LT(consistency_error(space.points, in_node_distances(mesh).nodes, space.outline), 1e-12)
        << "EXACT: " << shape.name;
  }
}

/// The least change is normal to all changes that the conditions allow: d.(w v) = 0 for all v with A v = 0. Such v: the
/// differences of other gradients that obey the conditions, here of plain gradients with something added first.
TEST(ReferenceSpace, change_of_mls_is_the_least) {
  const FieldMesh mesh = in_node_distances(make_field_mesh(disc(60, 1)));
  const MovingLeastSquares mls(mesh.nodes, mesh.outline_count, 8);
  const Space space = make_space(mesh, settings_of(DiscretisationMethod::mls));
  std::vector<Point> other = space.points;
  Random random(4);
  for (Point& point : other)
    for (Vec2& b : point.gradient) b += Vec2{random.uniform(-1, 1), random.uniform(-1, 1)};
  make_consistent(other, mesh.nodes, space.outline);
  double product = 0, norm = 0;
  for (std::size_t g = 0; g < other.size(); ++g) {
    const Triangle& t = mesh.triangles[g];
    const Point plain = mls.gradients((mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3);
    for (std::size_t i = 0; i < plain.node.size(); ++i) {
      const Vec2 change = space.points[g].gradient[i] - plain.gradient[i];
      const Vec2 allowed = other[g].gradient[i] - space.points[g].gradient[i];
      product += space.points[g].weight * change.dot(allowed);
      norm += space.points[g].weight * std::abs(change.dot(allowed));
    }
  }
  EXPECT_GT(norm, 0.1);
  EXPECT_NEAR(product / norm, 0, 1e-12) << "EXACT";
}

TEST(ReferenceSpace, weights_and_masses_sum_to_area_and_moments) {
  for (const ShapeSpec& shape : reference_shapes())
    for (const DiscretisationSettings& settings : reference_methods()) {
      SCOPED_TRACE(described(shape, settings));
      const FieldMesh mesh = make_field_mesh(shape);
      const Space space = make_space(mesh, settings);
      const PolygonProperties polygon = polygon_properties(outline_of(mesh));
      double area = 0, moment = 0;
      for (const Point& point : space.points) area += point.weight;
      EXPECT_NEAR(area / polygon.area, 1, space_rounding) << "EXACT";
      EXPECT_NEAR(space.lumped.sum() / polygon.area, 1, space_rounding) << "EXACT";
      const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.lumped.size());
      EXPECT_LT((space.consistent * ones - space.lumped).cwiseAbs().maxCoeff(),
                space_rounding * space.lumped.maxCoeff())
          << "EXACT: row sums";
      for (int c = 0; c < 2; ++c) {
        Eigen::VectorXd x(space.lumped.size());
        for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = mesh.nodes[static_cast<std::size_t>(i)][c];
        moment += x.dot(space.consistent * x);
        EXPECT_LT(std::abs(x.dot(space.lumped)), space_rounding * polygon.area * x.cwiseAbs().maxCoeff()) << "EXACT";
      }
      EXPECT_NEAR(moment / polygon.polar_moment, 1, space_rounding) << "EXACT: linear functions and a rule of degree 4";
    }
}

TEST(ReferenceSpace, lists_nodes_in_growing_order) {
  for (const DiscretisationSettings& settings : reference_methods()) {
    const Space space = make_space(make_field_mesh(disc(60)), settings);
    const auto grows = [](const std::vector<int>& nodes) {
      return std::adjacent_find(nodes.begin(), nodes.end(), std::greater_equal<>()) == nodes.end();
    };
    for (const Point& point : space.points) EXPECT_TRUE(grows(point.node)) << "EXACT";
    for (const Row& row : space.nodes) EXPECT_TRUE(grows(row.node)) << "EXACT";
    EXPECT_EQ(space.outline.size(), static_cast<std::size_t>(space.mesh.outline_count)) << "EXACT";
  }
}

TEST(ReferenceSpace, quadrature_is_exact_to_its_degree) {
  const int degree[] = {1, 2, 4}, points[] = {1, 3, 6};
  for (int rule = 0; rule < 3; ++rule)
    for (int a = 0; a <= degree[rule]; ++a)
      for (int b = 0; a + b <= degree[rule]; ++b) {
        double sum = 0;
        for (const QuadraturePoint& at : triangle_rule(points[rule]))
          sum += at.share / 2 * std::pow(at.place[0], a) * std::pow(at.place[1], b);
        EXPECT_NEAR(sum, std::tgamma(a + 1) * std::tgamma(b + 1) / std::tgamma(a + b + 3), 1e-16 * 4) << "EXACT";
      }
}

TEST(ReferenceSpace, refuses_what_it_has_not) {
  const FieldMesh mesh = make_field_mesh(disc(60));
  EXPECT_NE(error_of([&] { make_space(mesh, settings_of(DiscretisationMethod::rpim)); }).find("no method \"rpim\""),
            std::string::npos);
  EXPECT_NE(error_of([&] { make_space(mesh, settings_of(DiscretisationMethod::mls, 1, 60)); }).find("support = 60"),
            std::string::npos);
  EXPECT_THROW(make_space(mesh, settings_of(DiscretisationMethod::mls_gauss, 4)), InputError);
}

}  // namespace
}  // namespace pliant::reference
