#include "geometry/grain_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "core/errors.hpp"
#include "core/random.hpp"
#include "geometry/grain_diagram.hpp"
#include "geometry/polygon.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {
namespace {

// The same number as for packings (power_diagram.cpp), for the same reason: areas agree, and cells stay irregular.
constexpr int grain_sweeps = 60;
// A square cell of this side, in spacings, has some 10 nodes on its outline and two or three within, which is little
// for a deformable body.
constexpr double least_side = 2.5;
// A part of a divided cell becomes a cell of its own if it has half of the area that a whole cell needs.
constexpr double least_part = 0.5;
// Shorter edges collapse, in spacings. Division into segments of at most a spacing makes none shorter than that.
constexpr double least_edge = 0.5;

Points random_points_inside(const Points& outline, std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random = random_stream(seed, 8);
  Vec2 low = outline[0], high = outline[0];
  for (const Vec2& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  Points found;
  while (found.size() < count) {
    const double x = uniform_number(random), y = uniform_number(random);
    const Vec2 p = low + Vec2(x, y).cwiseProduct(high - low);
    if (is_inside(outline, p)) found.push_back(p);
  }
  return found;
}

CellFaces faces_of_areas(const Points& outline, const std::vector<double>& areas, std::uint64_t seed) {
  Points generators = random_points_inside(outline, areas.size(), seed);
  std::vector<double> weights(areas.size(), 0.0);
  for (int sweep = 0; sweep < grain_sweeps; ++sweep) {
    const CellFaces cells = grain_diagram(outline, generators, weights);
    std::vector<double> covered(areas.size(), 0.0);
    Points moment(areas.size(), Vec2(0, 0));
    for (const CellFace& face : cells.faces) {
      const PolygonProperties part = polygon_properties(cells.polygon(face.loop));
      covered[face.generator] += part.area;
      moment[face.generator] += part.area * part.centroid;
    }
    for (std::size_t i = 0; i < areas.size(); ++i) {
      if (covered[i] > 0) generators[i] = moment[i] / covered[i];
      weights[i] += (areas[i] - covered[i]) / std::numbers::pi;  // the step of cells_of_areas
    }
  }
  return grain_diagram(outline, generators, weights);
}

/// Joins a face with the neighbour with which it has most in common, of those with which it encloses no other face.
bool join_neighbour(CellFaces& all, std::size_t face) {
  const LinkSides sides = all.sides();
  std::map<std::size_t, double> common;
  for (const auto& [link, side] : sides)
    if (side == face && is_within(sides, link)) common[sides.at(reverse(link))] += all.length(link);
  std::vector<std::pair<double, std::size_t>> neighbours;
  for (const auto& [other, length] : common) neighbours.emplace_back(-length, other);
  std::sort(neighbours.begin(), neighbours.end());
  for (const auto& [length, other] : neighbours) {
    PointLinks both = links_of(all.faces[face].loop);
    for (const PointLink& link : links_of(all.faces[other].loop)) both.push_back(link);
    std::vector<PointLoop> loops = loops_of(both);
    if (loops.size() != 1) continue;
    all.faces[other].loop = std::move(loops[0]);
    all.faces.erase(all.faces.begin() + static_cast<std::ptrdiff_t>(face));
    return true;
  }
  return false;
}

/// Joins small faces to others, and removes points on the outline where no cut ends any more.
void join_small_faces(CellFaces& all, std::size_t outline_count, double least_area) {
  for (std::size_t f = 0; f < all.faces.size();)
    f = signed_area(all.polygon(all.faces[f].loop)) < least_area && join_neighbour(all, f) ? 0 : f + 1;
  std::vector<int> count(all.points.size(), 0);
  for (const CellFace& face : all.faces)
    for (const int i : face.loop) ++count[i];
  for (CellFace& face : all.faces)
    std::erase_if(face.loop, [&](int i) { return i >= static_cast<int>(outline_count) && count[i] == 1; });
}

/// Replaces two points by one at `place`. Returns false, and changes nothing, if a face would not stay a polygon.
bool merge(CellFaces& all, int kept, int gone, const Vec2& place) {
  const Vec2 before = all.points[kept];
  std::vector<CellFace> changed = all.faces;
  all.points[kept] = place;
  for (CellFace& face : changed) {
    std::replace(face.loop.begin(), face.loop.end(), gone, kept);
    if (std::find(face.loop.begin(), face.loop.end(), kept) == face.loop.end()) continue;
    face.loop.erase(std::unique(face.loop.begin(), face.loop.end()), face.loop.end());
    if (face.loop.front() == face.loop.back()) face.loop.pop_back();
    if (!all.is_polygon(face.loop)) {
      all.points[kept] = before;
      return false;
    }
  }
  all.faces = std::move(changed);
  return true;
}

/// Merges the ends of an edge. Nodes of the outline stay, and points on the outline stay on it.
bool collapse(CellFaces& all, const PointLink& link, bool within, const std::vector<int>& rank) {
  auto [kept, gone] = link;
  if (rank[kept] < rank[gone]) std::swap(kept, gone);
  if (rank[gone] == 2 || (within && rank[gone] == 1)) return false;
  const Vec2 a = all.points[kept], b = all.points[gone];
  if (rank[kept] > rank[gone]) return merge(all, kept, gone, a);
  return merge(all, kept, gone, (a + b) / 2) || merge(all, kept, gone, a) || merge(all, kept, gone, b);
}

/// Collapses the shortest edge that can be collapsed. Returns false if none of those below `least` can.
bool collapse_one_edge(CellFaces& all, std::size_t outline_count, double least) {
  const LinkSides sides = all.sides();
  std::vector<int> rank(all.points.size(), 0);  // 2: node of the outline, 1: where a cut meets it, 0: within
  for (const auto& [link, face] : sides)
    if (!is_within(sides, link))
      for (const int i : {link.first, link.second}) rank[i] = i < static_cast<int>(outline_count) ? 2 : 1;
  std::vector<std::pair<double, PointLink>> edges;
  for (const auto& [link, face] : sides)
    if (all.length(link) < least && (link.first < link.second || !is_within(sides, link)))
      edges.emplace_back(all.length(link), link);
  std::sort(edges.begin(), edges.end());
  return std::any_of(edges.begin(), edges.end(),
                     [&](const auto& edge) { return collapse(all, edge.second, is_within(sides, edge.second), rank); });
}

/// Leads an edge between two faces over another point of one of them, which divides that face at the point. Returns
/// false, and changes nothing, if a face would not stay a polygon, or if the new edge came as near to another point.
bool lead_over(CellFaces& all, const PointLink& link, int point, std::size_t face, std::size_t beyond) {
  const auto [a, b] = link;
  PointLoop loop = all.faces[face].loop, larger = all.faces[beyond].loop;
  std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), b), loop.end());
  const auto at = std::find(loop.begin(), loop.end(), point);
  std::vector<PointLoop> parts{{loop.begin(), at + 1}, {at, loop.end()}};
  std::erase_if(parts, [](const PointLoop& part) { return part.size() == 2; });
  if (parts.empty()) return false;
  if (parts.size() == 1) {  // the face loses a triangle, which would be as narrow a part of the one beyond
    const bool loses_b = at == loop.begin() + 1;
    const Vec2 &p = all.points[point], &lost = all.points[loses_b ? b : a], &kept = all.points[loses_b ? a : b];
    if (square_distance_to_edge(p, kept, lost) <= square_distance_to_edge(lost, kept, p)) return false;
  }
  larger.insert(std::find(larger.begin(), larger.end(), a), point);
  if (!all.is_polygon(larger) || !all.is_polygon(parts.front()) || !all.is_polygon(parts.back())) return false;
  all.faces[beyond].loop = larger;
  all.faces[face].loop = parts.front();
  if (parts.size() == 2) all.faces.push_back({all.faces[face].generator, parts.back()});
  return true;
}

/// Closes the narrowest neck of a face, between an edge within the grain and another point. Returns false if none of
/// those below `least` can be closed.
bool close_one_neck(CellFaces& all, double least) {
  const LinkSides sides = all.sides();
  std::vector<std::tuple<double, PointLink, int>> necks;
  for (const auto& [link, face] : sides) {
    if (!is_within(sides, link)) continue;
    for (const int i : all.faces[face].loop) {
      const double squared = square_distance_to_edge(all.points[link.first], all.points[link.second], all.points[i]);
      if (i != link.first && i != link.second && squared < least * least) necks.emplace_back(squared, link, i);
    }
  }
  std::sort(necks.begin(), necks.end());
  return std::any_of(necks.begin(), necks.end(), [&](const auto& neck) {
    const auto& [squared, link, point] = neck;
    return lead_over(all, link, point, sides.at(link), sides.at(reverse(link)));
  });
}

/// Divides the edges within the grain, each once for both of its cells.
void divide_edges(CellFaces& all, double spacing) {
  const LinkSides sides = all.sides();
  std::map<PointLink, PointLoop> between;  // new points of each directed edge
  for (const auto& [link, face] : sides) {
    if (link.first > link.second || !is_within(sides, link)) continue;
    const Vec2 a = all.points[link.first], b = all.points[link.second];
    // The margin keeps rounding from adding a segment to an edge of exactly a multiple of the spacing.
    const int n = std::max(1, static_cast<int>(std::ceil(all.length(link) / spacing - 1e-9)));
    PointLoop& added = between[link];
    for (int k = 1; k < n; ++k) {
      added.push_back(static_cast<int>(all.points.size()));
      all.points.push_back(a + static_cast<double>(k) / n * (b - a));
    }
    between[reverse(link)] = PointLoop(added.rbegin(), added.rend());
  }
  for (CellFace& face : all.faces) {
    PointLoop divided;
    for (const PointLink& link : links_of(face.loop)) {
      const PointLoop& added = between[link];
      divided.push_back(link.first);
      divided.insert(divided.end(), added.begin(), added.end());
    }
    face.loop = std::move(divided);
  }
}

/// Wanted areas of the cells, m2.
std::vector<double> areas_within(double grain, std::vector<double> areas, double spacing) {
  if (!(spacing > 0) || areas.empty() || !(*std::min_element(areas.begin(), areas.end()) > 0))
    throw InputError(
        fmt::format("cells of a grain: {} areas, spacing {} m; give at least one area, all of them "
                    "positive, and a positive spacing",
                    areas.size(), spacing));
  const double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (double& area : areas) area *= grain / sum;
  const double smallest = *std::min_element(areas.begin(), areas.end());
  const double least = least_side * least_side * spacing * spacing;
  if (areas.size() > 1 && smallest < least)
    throw InputError(fmt::format(
        "cells of a grain: {} cells, the smallest of {:.4g} m2; with a spacing of {:.4g} m a cell needs ({} "
        "spacings)^2 = {:.4g} m2: ask for at most {} cells of such relative areas, or a finer spacing",
        areas.size(), smallest, spacing, least_side, least,
        std::max(1, static_cast<int>(static_cast<double>(areas.size()) * (smallest / least)))));
  return areas;
}

}  // namespace

std::vector<Points> cut_into_cells(const Points& outline, const std::vector<double>& areas, double spacing,
                                   std::uint64_t seed) {
  const std::vector<double> wanted = areas_within(signed_area(outline), areas, spacing);
  if (areas.size() == 1) return {outline};
  CellFaces all = faces_of_areas(outline, wanted, seed);
  // Each turn closes one neck. Grains of some 300 points have at most 20; the bound makes the loop end for certain.
  for (std::size_t turn = 0; turn < all.points.size(); ++turn) {
    join_small_faces(all, outline.size(), least_part * std::pow(least_side * spacing, 2));
    while (collapse_one_edge(all, outline.size(), least_edge * spacing)) {
    }
    if (!close_one_neck(all, least_edge * spacing)) break;
  }
  divide_edges(all, spacing);
  std::stable_sort(all.faces.begin(), all.faces.end(),
                   [](const CellFace& a, const CellFace& b) { return a.generator < b.generator; });
  std::vector<Points> cells;
  for (const CellFace& face : all.faces) {
    cells.push_back(all.polygon(face.loop));
    if (const std::string defect = polygon_defect(cells.back()).text; !defect.empty())
      throw InputError(fmt::format("cells of a grain: in cell {} {}; choose another seed", cells.size(), defect));
  }
  return cells;
}

}  // namespace pliant
