#include "discretisation/table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "../geometry/shapes.hpp"

namespace pliant {
namespace {

using testing::all_shapes;
using testing::disc;
using testing::error_of;
using testing::outline_of;

DiscretisationSettings settings(DiscretisationMethod method, int support = 9, int gauss_points = 3) {
  return {.method = method, .support = support, .gauss_points = gauss_points};
}

double length_of(const Discretisation& d) {
  return std::sqrt(polygon_properties(outline_of(d.mesh)).area / static_cast<double>(d.mesh.nodes.size()));
}

// EXACT: linear completeness at every point, (1) of docs/method.md 2; rounding of sums of 12 terms b X, each up to 10:
// 1e-12.
void expect_complete(const Discretisation& d) {
  const double length = length_of(d);
  for (std::size_t g = 0; g < d.table.weight.size(); ++g) {
    Vec2 sum(0, 0);
    Eigen::Matrix2d gradient = -Eigen::Matrix2d::Identity();
    for (int e = d.table.start[g]; e < d.table.start[g + 1]; ++e) {
      sum += length * d.table.gradient[e];
      gradient += d.table.gradient[e] * d.mesh.nodes[d.table.node[e]].transpose();
    }
    EXPECT_LT(sum.norm(), 1e-12);
    EXPECT_LT(gradient.norm(), 1e-12);
  }
}

// Largest defect of (2) of docs/method.md 2 over all nodes, relative to the mean node distance; computed here anew.
double balance_defect(const Discretisation& d) {
  Points defect(d.mesh.nodes.size(), Vec2(0, 0));
  for (std::size_t g = 0; g < d.table.weight.size(); ++g)
    for (int e = d.table.start[g]; e < d.table.start[g + 1]; ++e)
      defect[d.table.node[e]] += d.table.weight[g] * d.table.gradient[e];
  for (int k = 0, n = d.mesh.outline_count; k < n; ++k) {
    const Vec2 before = d.mesh.nodes[k] - d.mesh.nodes[(k + n - 1) % n],
               after = d.mesh.nodes[(k + 1) % n] - d.mesh.nodes[k];
    const Vec2 s = 0.5 * (Vec2(before.y(), -before.x()) + Vec2(after.y(), -after.x()));
    for (int e = d.outline_rows.start[k]; e < d.outline_rows.start[k + 1]; ++e)
      defect[d.outline_rows.node[e]] -= d.outline_rows.value[e] * s;
  }
  double largest = 0;
  for (const Vec2& v : defect) largest = std::max(largest, v.norm());
  return largest / length_of(d);
}

// EXACT, tolerance of docs/method.md 2: conditions (1) and (2) hold to 1e-12 for every support that `mls` takes.
TEST(TableMls, SatisfiesBothConditions) {
  for (const ShapeSpec& shape : all_shapes())
    for (const int support : {7, 8, 9, 10, 12, 14}) {
      SCOPED_TRACE(shape.name + ", support " + std::to_string(support));
      const Discretisation d = discretise(make_field_mesh(shape), settings(DiscretisationMethod::mls, support));
      expect_complete(d);
      EXPECT_LT(balance_defect(d), 1e-12);
      EXPECT_LT(d.completeness_residual, 1e-12);
      EXPECT_EQ(d.table.weight.size(), d.mesh.triangles.size());
    }
}

// EXACT: finite elements satisfy both conditions as they are.
TEST(TableTriangles, SatisfyBothConditions) {
  for (const ShapeSpec& shape : all_shapes())
    for (const DiscretisationMethod method : {DiscretisationMethod::t3, DiscretisationMethod::es_t3}) {
      const Discretisation d = discretise(make_field_mesh(shape), settings(method));
      expect_complete(d);
      EXPECT_LT(balance_defect(d), 1e-12);
      // Euler: a triangulated disc has nodes + triangles - 1 edges.
      EXPECT_EQ(d.table.weight.size(), method == DiscretisationMethod::t3
                                           ? d.mesh.triangles.size()
                                           : d.mesh.nodes.size() + d.mesh.triangles.size() - 1);
      EXPECT_EQ(d.node_rows.node.size(), d.mesh.nodes.size());
      EXPECT_GE(d.min_shape_value, 0);
    }
}

// EXACT: an edge's point stands for the triangles beside it, so every triangle has a share in three.
TEST(TableTriangles, EdgesStandForTheirTriangles) {
  const Discretisation d = discretise(make_field_mesh(disc(84)), settings(DiscretisationMethod::es_t3));
  std::vector<double> shares(d.mesh.triangles.size(), 0);
  for (const auto& [a, b] : d.table.cells) {
    shares[a] += 0.5;
    shares[b] += 0.5;
    if (a == b) continue;
    int common = 0;
    for (int i : d.mesh.triangles[a]) common += std::count(d.mesh.triangles[b].begin(), d.mesh.triangles[b].end(), i);
    EXPECT_EQ(common, 2);
  }
  for (const double share : shares) EXPECT_GE(share, 1.5);
}

// EXACT: radial point interpolation is complete and interpolates.
TEST(TableRpim, IsCompleteAndInterpolates) {
  const Discretisation d = discretise(make_field_mesh(disc(84)), settings(DiscretisationMethod::rpim, 9, 3));
  expect_complete(d);
  EXPECT_EQ(d.node_rows.node.size(), d.mesh.nodes.size());
  for (std::size_t k = 0; k < d.mesh.nodes.size(); ++k) {
    EXPECT_EQ(d.node_rows.node[k], static_cast<int>(k));
    EXPECT_NEAR(d.node_rows.value[k], 1, 1e-12);
  }
}

// EXACT for completeness. Gauss points fail condition (2), which shows that the check above can fail.
TEST(TableMlsGauss, IsCompleteButNotBalanced) {
  for (const int points : {1, 3, 6}) {
    const Discretisation d =
        discretise(make_field_mesh(disc(168)), settings(DiscretisationMethod::mls_gauss, 9, points));
    expect_complete(d);
    EXPECT_GT(balance_defect(d), 1e-4);
    EXPECT_EQ(d.table.weight.size(), points * d.mesh.triangles.size());
  }
}

// EXACT: weights sum to the polygon's area; masses are positive, sum to the area, and keep the centre of mass up to the
// integral of x - sum phi X = 0: linear reproduction makes it exact.
TEST(Table, AreaAndMasses) {
  for (const ShapeSpec& shape : all_shapes())
    for (const DiscretisationMethod method :
         {DiscretisationMethod::mls, DiscretisationMethod::mls_gauss, DiscretisationMethod::t3,
          DiscretisationMethod::es_t3, DiscretisationMethod::rpim}) {
      const Discretisation d = discretise(make_field_mesh(shape), settings(method));
      const double area = polygon_properties(outline_of(d.mesh)).area;
      EXPECT_NEAR(std::accumulate(d.table.weight.begin(), d.table.weight.end(), 0.0) / area, 1, 1e-13);
      EXPECT_NEAR(std::accumulate(d.mass_at_unit_density.begin(), d.mass_at_unit_density.end(), 0.0) / area, 1, 1e-13);
      EXPECT_GT(*std::min_element(d.mass_at_unit_density.begin(), d.mass_at_unit_density.end()), 0);
      Vec2 moment(0, 0);
      for (std::size_t i = 0; i < d.mass_at_unit_density.size(); ++i)
        moment += d.mass_at_unit_density[i] * d.mesh.nodes[i];
      EXPECT_LT(moment.norm(), 1e-13 * std::pow(area, 1.5));
    }
}

// EXACT: rows of values sum to one and reproduce the places they belong to.
TEST(Table, RowsReproducePlaces) {
  const Discretisation d = discretise(make_field_mesh(disc(168)), settings(DiscretisationMethod::mls));
  for (const ShapeRows* rows : {&d.outline_rows, &d.node_rows})
    for (std::size_t k = 0; k + 1 < rows->start.size(); ++k) {
      Vec2 place(0, 0);
      for (int e = rows->start[k]; e < rows->start[k + 1]; ++e) place += rows->value[e] * d.mesh.nodes[rows->node[e]];
      EXPECT_LT((place - d.mesh.nodes[k]).norm(), 1e-12 * length_of(d));
    }
  EXPECT_EQ(d.outline_rows.start.size(), 49U);
  EXPECT_EQ(d.node_rows.start.size(), 169U);
}

// INDEPENDENT: the prototype of docs/method.md 2 met -0.03; ours must be negative and of that size.
TEST(Table, LeastShapeValueIsReported) {
  const Discretisation d = discretise(make_field_mesh(disc(168)), settings(DiscretisationMethod::mls));
  EXPECT_LT(d.min_shape_value, 0);
  EXPECT_GT(d.min_shape_value, -0.1);
}

// EXACT: brute force.
TEST(Table, NodalDistances) {
  const Discretisation d = discretise(make_field_mesh(disc(50)), settings(DiscretisationMethod::mls));
  for (std::size_t i = 0; i < d.mesh.nodes.size(); ++i) {
    double least = 1;
    for (std::size_t j = 0; j < d.mesh.nodes.size(); ++j)
      if (i != j) least = std::min(least, (d.mesh.nodes[i] - d.mesh.nodes[j]).norm());
    EXPECT_DOUBLE_EQ(d.nodal_distance[i], least);
  }
}

// EXACT: a shape 1e9 times larger has the same table but for its unit, to the rounding of the solve.
TEST(Table, DoesNotDependOnUnits) {
  FieldMesh mesh = make_field_mesh(disc(168, 1e-6));
  const Discretisation small = discretise(mesh, settings(DiscretisationMethod::mls));
  for (Vec2& x : mesh.nodes) x *= 1e9;
  const Discretisation large = discretise(mesh, settings(DiscretisationMethod::mls));
  ASSERT_EQ(small.table.node, large.table.node);
  for (std::size_t e = 0; e < small.table.gradient.size(); ++e)
    EXPECT_LT((small.table.gradient[e] - 1e9 * large.table.gradient[e]).norm() * length_of(small), 1e-11);
}

// EXACT: limits of docs/method.md 2 and of the interface.
TEST(Table, RefusesSupportsBeyondTheLimits) {
  const FieldMesh mesh = make_field_mesh(disc(168));
  const auto message = [&](const DiscretisationSettings& s) { return error_of([&] { discretise(mesh, s); }); };
  EXPECT_NE(message(settings(DiscretisationMethod::mls, 15)).find("allowed for this method: 7 to 14"),
            std::string::npos);
  EXPECT_NE(message(settings(DiscretisationMethod::mls, 3)).find("allowed for this method"), std::string::npos);
  EXPECT_NE(message(settings(DiscretisationMethod::mls_gauss, 26)).find("7 to 25"), std::string::npos);
  EXPECT_EQ(message(settings(DiscretisationMethod::mls_gauss, 15)), "");
  EXPECT_NE(message(settings(DiscretisationMethod::mls_gauss, 9, 4)).find("1, 3 or 6"), std::string::npos);
  EXPECT_NE(error_of([] {
              discretise(make_rigid_mesh(disc(9)), settings(DiscretisationMethod::mls, 14));
            }).find("the shape has 11"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
