#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

using PointLoop = std::vector<int>;     // closed polygon, counter-clockwise, by the numbers of its points
using PointLink = std::pair<int, int>;  // directed edge, by the numbers of its points
using PointLinks = std::vector<PointLink>;
using LinkSides = std::map<PointLink, std::size_t>;  // number of the face on the left of each directed edge

inline PointLink reverse(const PointLink& link) { return {link.second, link.first}; }
inline bool is_within(const LinkSides& sides, const PointLink& link) { return sides.contains(reverse(link)); }

PointLinks links_of(const PointLoop& loop);

/// Closed polygons of edges. An edge and its reverse cancel, so that the edges of adjoining polygons give their union.
/// A polygon that touches itself in a point counts as several.
std::vector<PointLoop> loops_of(PointLinks links);

struct CellFace {
  int generator;
  PointLoop loop;
};

/// Cells with one table of points, so that common points have the same bits. The first are the nodes of the outline.
struct CellFaces {
  Points points;
  std::vector<CellFace> faces;

  Points polygon(const PointLoop& loop) const {
    Points corners;
    for (const int i : loop) corners.push_back(points[i]);
    return corners;
  }
  bool is_polygon(const PointLoop& loop) const;  ///< a simple one, of positive area
  double length(const PointLink& link) const { return (points[link.second] - points[link.first]).norm(); }
  LinkSides sides() const;
};

/// Power diagram within a grain, see power_cells: the points of its outline and inside with least
/// |x - generator|^2 - weight. The outline may be concave.
CellFaces grain_diagram(const Points& outline, const Points& generators, const std::vector<double>& weights);

}  // namespace pliant
