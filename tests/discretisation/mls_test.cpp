#include "discretisation/mls.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "../geometry/shapes.hpp"
#include "discretisation/quadrature.hpp"

namespace pliant {
namespace {

/// Shapes in mean node distances, with their 6-point quadrature as places to look at.
struct Case {
  MlsNodes nodes;
  Points places;
  std::size_t inside;  ///< of the places, which come first: not nodes
};

std::vector<Case> cases(int support) {
  std::vector<Case> result;
  for (const ShapeSpec& shape : testing::all_shapes()) {
    FieldMesh mesh = make_field_mesh(shape);
    const double area = polygon_properties(testing::outline_of(mesh)).area;
    for (Vec2& x : mesh.nodes) x /= std::sqrt(area / static_cast<double>(mesh.nodes.size()));
    result.push_back({make_mls_nodes(mesh, support), mesh_quadrature(mesh, 6).position, 0});
    result.back().inside = result.back().places.size();
    result.back().places.insert(result.back().places.end(), mesh.nodes.begin(), mesh.nodes.end());
  }
  return result;
}

// EXACT: sum phi = 1, sum phi X = x, sum grad phi = 0, sum grad phi (x) X = I. Rounding of a 3 x 3 solve whose
// matrix has a condition of up to 1e3 here: 1e-12.
TEST(Mls, ReproducesLinearFields) {
  for (const int support : {8, 9, 14})
    for (const Case& c : cases(support))
      for (const Vec2& x : c.places) {
        const ShapeFunctions shape = evaluate_mls(c.nodes, x);
        double sum = -1;
        Vec2 position = -x, gradient_sum(0, 0);
        Eigen::Matrix2d gradient = -Eigen::Matrix2d::Identity();
        for (std::size_t a = 0; a < shape.node.size(); ++a) {
          const Vec2& node = c.nodes.position[shape.node[a]];
          sum += shape.value[a];
          position += shape.value[a] * node;
          gradient_sum += shape.gradient[a];
          gradient += shape.gradient[a] * (node - x).transpose();
        }
        EXPECT_LT(std::abs(sum), 1e-12);
        EXPECT_LT(position.norm(), 1e-12);
        EXPECT_LT(gradient_sum.norm(), 1e-12);
        EXPECT_LT(gradient.norm(), 1e-12);
      }
}

double value_of(const ShapeFunctions& shape, int node) {
  for (std::size_t a = 0; a < shape.node.size(); ++a)
    if (shape.node[a] == node) return shape.value[a];
  return 0;
}

// EXACT: central differences of step d have an error of d^2 phi'''/6, phi''' of order 10, and rounding of 1e-16/d: at
// d = 1e-5 both are below 1e-8. Kinks of the third derivative of the spline do not matter. Where the outline is
// concave its nodes have no ways from outside, and corners no gradients.
TEST(Mls, GradientsAgreeWithFiniteDifferences) {
  const double step = 1e-5;
  for (const Case& c : cases(9))
    for (std::size_t place = 0; place < (c.nodes.paths ? c.inside : c.places.size()); place += 7) {
      const Vec2& x = c.places[place];
      const ShapeFunctions shape = evaluate_mls(c.nodes, x);
      for (int axis = 0; axis < 2; ++axis) {
        const Vec2 shift = step * Vec2::Unit(axis);
        const ShapeFunctions after = evaluate_mls(c.nodes, x + shift), before = evaluate_mls(c.nodes, x - shift);
        for (std::size_t a = 0; a < shape.node.size(); ++a) {
          const int node = shape.node[a];
          EXPECT_NEAR(shape.gradient[a][axis], (value_of(after, node) - value_of(before, node)) / (2 * step), 1e-7);
        }
      }
    }
}

// EXACT: the radius is the distance to the s-th nearest other node; on a unit lattice 1, sqrt 2 and 2 for 4, 8, 12.
TEST(Mls, SupportRadii) {
  Points lattice;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) lattice.emplace_back(i, j);
  EXPECT_DOUBLE_EQ(make_mls_nodes(lattice, 4).radius[40], 1);
  EXPECT_DOUBLE_EQ(make_mls_nodes(lattice, 8).radius[40], std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(make_mls_nodes(lattice, 12).radius[40], 2);
}

/// In the left or the right prong of testing::fork, more than a node distance above their root.
enum class Prong { left, right, neither };

Prong prong_of(const Vec2& x, const FieldMesh& mesh) {
  Points outline = testing::outline_of(mesh);
  const auto [low, high] =
      std::minmax_element(outline.begin(), outline.end(), [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
  const double unit = (high->y() - low->y()) / 8;
  if (x.y() - low->y() < 3 * unit) return Prong::neither;
  return x.x() < 0 ? Prong::left : Prong::right;
}

// EXACT: nodes count by their distance through the body. A unit above the root of prongs half a unit apart it is 2.06
// at least from one to the other; the radii there, with 8 neighbours at some 0.46 between nodes, are below 1.5.
TEST(Mls, DoesNotReachAcrossAGap) {
  FieldMesh mesh = make_field_mesh(testing::fork(180));
  const MlsNodes nodes = make_mls_nodes(mesh, 8);
  int straight_neighbours = 0;
  for (const Vec2& x : mesh_quadrature(mesh, 6).position) {
    const Prong own = prong_of(x, mesh);
    if (own == Prong::neither) continue;
    for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
      const Prong other = prong_of(mesh.nodes[i], mesh);
      straight_neighbours += other != own && other != Prong::neither && (mesh.nodes[i] - x).norm() < nodes.radius[i];
    }
    for (const int i : evaluate_mls(nodes, x).node) {
      const Prong other = prong_of(mesh.nodes[i], mesh);
      EXPECT_TRUE(other == own || other == Prong::neither) << x.transpose() << " and " << mesh.nodes[i].transpose();
    }
  }
  EXPECT_GT(straight_neighbours, 100) << "or the test cannot fail";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (prong_of(mesh.nodes[i], mesh) != Prong::neither) EXPECT_LT(nodes.radius[i], 1.5);
}

// FROZEN: in convex bodies nothing bends, and all is bit for bit what straight distances give.
TEST(Mls, ConvexBodiesKnowStraightDistancesAlone) {
  for (const ShapeSpec& shape : {testing::disc(168), testing::square(150),
                                 testing::polygon("kite", {{0, 0}, {3, 1.1}, {3.9, 4.2}, {1, 2.7}}, 150)}) {
    const FieldMesh mesh = make_field_mesh(shape);
    const MlsNodes nodes = make_mls_nodes(mesh, 9);
    EXPECT_EQ(nodes.paths, nullptr) << shape.name;
    EXPECT_EQ(nodes.radius, make_mls_nodes(mesh.nodes, 9).radius) << shape.name;
  }
}

// EXACT: where no way bends within reach, concave bodies have what straight distances give, bit for bit.
TEST(Mls, ConcaveBodiesAreTheSameAwayFromTheirBends) {
  FieldMesh mesh = make_field_mesh(testing::l_shape(250));
  for (Vec2& x : mesh.nodes) x /= std::sqrt(3e-6 / 250);
  const MlsNodes bent = make_mls_nodes(mesh, 9), straight = make_mls_nodes(mesh.nodes, 9);
  Points outline = testing::outline_of(mesh);
  const Vec2 corner = *std::min_element(outline.begin(), outline.end(), [&](const Vec2& a, const Vec2& b) {
    return (a - Vec2(1, 1)).squaredNorm() < (b - Vec2(1, 1)).squaredNorm();
  });
  int far = 0, near = 0;
  for (const Vec2& x : mesh_quadrature(mesh, 6).position) {
    const ShapeFunctions a = evaluate_mls(bent, x), b = evaluate_mls(straight, x);
    if ((x - corner).norm() > straight.reach + bent.reach) {
      EXPECT_EQ(a.value, b.value);
      EXPECT_EQ(a.gradient, b.gradient);
      ++far;
    } else {
      near += a.value != b.value;
    }
  }
  EXPECT_GT(far, 1000);
  EXPECT_GT(near, 10) << "ways do bend at the corner";
}

// EXACT: two neighbours, and neighbours on one line, are refused with the place named.
TEST(Mls, RefusesTooFewOrCollinearNeighbours) {
  const MlsNodes line{{{0, 0}, {1, 0}, {2, 0}, {3, 0}}, {4, 4, 4, 4}};
  EXPECT_NE(testing::error_of([&] { evaluate_mls(line, {1.2, 0.1}); }).find("not three off one line"),
            std::string::npos);
  const MlsNodes pair{{{0, 0}, {1, 0}, {0, 9}}, {2, 2, 2}};
  EXPECT_NE(testing::error_of([&] { evaluate_mls(pair, {0.5, 0}); }).find("2 neighbour nodes"), std::string::npos);
  EXPECT_NE(testing::error_of([&] { make_mls_nodes(pair.position, 9); }).find("the shape has 3"), std::string::npos);
}

}  // namespace
}  // namespace pliant
