#include "geometry/grain_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "geometry/polygon.hpp"
#include "shapes.hpp"
#include "support/scenes.hpp"

namespace pliant {
namespace {

using namespace testing;
using std::numbers::pi;

constexpr double spacing = 0.1;

Points disc_of(int nodes) {
  ShapeSpec shape = disc(0, nodes * spacing / pi);
  shape.nodes.reset();
  shape.outline_nodes = nodes;
  return make_outline(shape);
}

/// Five lobes with deep bays between them, which divide cells.
Points lobes() {
  Points points;
  for (int k = 0; k < 4000; ++k) {
    const double t = 2 * pi * k / 4000, radius = 1.3 * (1 + 0.45 * std::cos(5 * t) + 0.1 * std::sin(3 * t));
    points.emplace_back(radius * std::cos(t), radius * std::sin(t));
  }
  ShapeSpec shape = curve("lobes", points, 0);
  shape.nodes.reset();
  shape.spacing = spacing;
  return make_outline(shape);
}

/// Grains that hold 60 cells at this spacing.
std::map<std::string, Points> grain_outlines() {
  return {{"square", refined({{0, 0}, {2.4, 0}, {2.4, 2.4}, {0, 2.4}}, spacing)},
          {"square of four nodes, far from the origin", {{500, 500}, {502.4, 500}, {502.4, 502.4}, {500, 502.4}}},
          {"disc", disc_of(120)},
          {"L", refined({{0, 0}, {2.4, 0}, {2.4, 1}, {1, 1}, {1, 2.4}, {0, 2.4}}, spacing)},
          {"lobes", lobes()}};
}

using Edge = std::array<double, 4>;
Edge edge(const Vec2& a, const Vec2& b) { return {a.x(), a.y(), b.x(), b.y()}; }

/// How often each directed edge occurs. Edges are equal if their ends have the same bits.
std::map<Edge, int> edges_of(const std::vector<Points>& polygons) {
  std::map<Edge, int> edges;
  for (const Points& p : polygons)
    for (std::size_t i = 0; i < p.size(); ++i) ++edges[edge(p[i], p[(i + 1) % p.size()])];
  return edges;
}

Vec2 start(const Edge& e) { return {e[0], e[1]}; }
Vec2 end(const Edge& e) { return {e[2], e[3]}; }
double length(const Edge& e) { return (end(e) - start(e)).norm(); }

bool lies_on(const Points& outline, const Edge& e) {
  // Rounding at coordinates of 500: 1e-13.
  return distance_to_outline(outline, (start(e) + end(e)) / 2) < 1e-12 &&
         distance_to_outline(outline, start(e)) < 1e-12;
}

void check_polygons(const Points& outline, const std::vector<Points>& cells) {
  double area = 0;
  for (const Points& cell : cells) {
    EXPECT_EQ(polygon_defect(cell).text, "");
    EXPECT_GT(signed_area(cell), 0) << "counter-clockwise";
    area += signed_area(cell);
  }
  EXPECT_NEAR(area, signed_area(outline), 1e-12 * signed_area(outline));
}

void check_edges(const Points& outline, const std::vector<Points>& cells) {
  const std::map<Edge, int> edges = edges_of(cells), given = edges_of({outline});
  double length_outside = 0;
  for (const auto& [e, count] : edges) {
    EXPECT_EQ(count, 1);
    const bool within = edges.contains(edge(end(e), start(e)));
    if (!within) length_outside += length(e);
    EXPECT_TRUE(within || lies_on(outline, e));
    if (!given.contains(e)) EXPECT_GT(length(e), 0.4 * spacing);
    if (within) EXPECT_LE(length(e), spacing * (1 + 1e-8));
  }
  EXPECT_NEAR(length_outside, perimeter(outline), 1e-12 * perimeter(outline));
  std::map<Edge, int> nodes;
  for (const Points& cell : cells)
    for (const Vec2& p : cell) nodes[edge(p, p)] = 1;
  for (const Vec2& p : outline) EXPECT_TRUE(nodes.contains(edge(p, p))) << "a node of the outline is lost";
}

// EXACT: cells are simple polygons with the area of the grain in sum. Each edge is one of the outline, or occurs once
// more, reversed, in another cell, with the same bits. Both together exclude overlaps and gaps.
TEST(GrainCells, CoverTheGrainWithCommonNodes) {
  for (const auto& [name, outline] : grain_outlines())
    for (const int count : {2, 5, 20, 60})
      for (const std::uint64_t seed : {1, 2, 3}) {
        SCOPED_TRACE(name + ", " + std::to_string(count) + " cells, seed " + std::to_string(seed));
        const std::vector<Points> cells = cut_into_cells(outline, std::vector<double>(count, 7.0), spacing, seed);
        check_polygons(outline, cells);
        check_edges(outline, cells);
        EXPECT_NEAR(static_cast<double>(cells.size()), count, 0.1 * count) << "some are divided by a bay, or too small";
      }
}

// EXACT: on outlines of about the spacing all cuts end at nodes, so that the edges outside are those of the outline.
TEST(GrainCells, CutsEndAtNodesOfTheOutline) {
  const Points outline = disc_of(60);
  const std::map<Edge, int> given = edges_of({outline});
  const std::map<Edge, int> edges = edges_of(cut_into_cells(outline, std::vector<double>(20, 1.0), spacing, 4));
  for (const auto& [e, count] : edges) EXPECT_TRUE(given.contains(e) || edges.contains(edge(end(e), start(e))));
  for (const auto& [e, count] : given) EXPECT_TRUE(edges.contains(e));
}

// EXACT up to sweeps and collapsed edges. Sweeps leave some 2 % (PowerDiagram.CellsTakeTheirAreas). A collapse moves a
// corner by up to half a spacing, and so changes a cell by a quarter spacing times a side at most. The smallest cell
// here has 5 spacings squared, so three such corners are 15 %.
TEST(GrainCells, AreasAreThoseWanted) {
  const Points outline = disc_of(120);
  std::vector<double> many, few;
  for (int i = 0; i < 20; ++i) many.push_back(1 + i % 3);
  for (int i = 0; i < 8; ++i) few.push_back(1 + i);
  for (const std::vector<double>& areas : {many, few})
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const std::vector<Points> cells = cut_into_cells(outline, areas, spacing, seed);
      ASSERT_EQ(cells.size(), areas.size());
      const double unit = signed_area(outline) / std::accumulate(areas.begin(), areas.end(), 0.0);
      for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_NEAR(signed_area(cells[i]) / (areas[i] * unit), 1, 0.25);
    }
}

// EXACT: bit for bit.
TEST(GrainCells, FollowTheSeedAlone) {
  const Points outline = lobes();
  const std::vector<double> areas(20, 1.0);
  EXPECT_EQ(cut_into_cells(outline, areas, spacing, 5), cut_into_cells(outline, areas, spacing, 5));
  EXPECT_NE(cut_into_cells(outline, areas, spacing, 5), cut_into_cells(outline, areas, spacing, 6));
}

// EXACT: bit for bit, and however small the grain is.
TEST(GrainCells, OneCellIsTheGrain) {
  const Points outline = disc_of(6);
  EXPECT_EQ(cut_into_cells(outline, {3.0}, spacing, 1), std::vector<Points>{outline});
}

// EXACT: a cell needs 6.25 square spacings, and the square has 576, so 92 cells fit. With one cell of half the area of
// 99 others it has 576/199 of them; 46 such cells fit.
TEST(GrainCells, TooManyAreRefused) {
  const Points outline = grain_outlines().at("square");
  const auto refusal = [&](const std::vector<double>& areas) {
    return error_of([&] { cut_into_cells(outline, areas, spacing, 1); });
  };
  const std::string message = refusal(std::vector<double>(93, 1.0));
  EXPECT_NE(message.find("ask for at most 92 cells"), std::string::npos) << message;
  EXPECT_EQ(refusal(std::vector<double>(92, 1.0)), "");
  std::vector<double> unequal(100, 2.0);
  unequal[7] = 1;
  EXPECT_NE(refusal(unequal).find("ask for at most 46 cells"), std::string::npos) << refusal(unequal);
  EXPECT_NE(refusal({}).find("at least one area"), std::string::npos);
  EXPECT_NE(refusal({1, -1}).find("positive"), std::string::npos);
}

}  // namespace
}  // namespace pliant
