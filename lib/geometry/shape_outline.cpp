#include "geometry/shape_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.hpp"
#include "geometry/mesh.hpp"
#include "geometry/polygon.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {
namespace {

using std::numbers::pi;
using Segments = std::vector<int>;  // number of segments of each edge of a polygon

// Euler's formula with equilateral triangles of side `spacing`: 2 nodes - 2 - outline triangles cover the area.
double isotropic_node_count(double area, int outline_count, double spacing) {
  return 1 + outline_count / 2.0 + area / (std::sqrt(3.0) / 2 * spacing * spacing);
}

/// Number of outline nodes of a smooth shape; `roundness`: its perimeter over that of the circle of its area.
int smooth_outline_count(const ShapeSpec& shape, double perimeter, double roundness) {
  int n = 0;
  if (shape.outline_nodes)
    n = *shape.outline_nodes;
  else if (shape.nodes)
    // 3.7 sqrt(N): the outline is 0.82 times finer than the interior, for contact resolution (168 nodes: 48).
    n = static_cast<int>(std::lround(3.7 * roundness * std::sqrt(*shape.nodes)));
  else
    n = static_cast<int>(std::lround(perimeter / *shape.spacing));
  if (n < 6)
    throw InputError(
        fmt::format("shape '{}': a smooth shape of {} outline nodes; it needs at least 6: ask for more nodes or a "
                    "finer spacing",
                    shape.name, n));
  return n;
}

Points disc_outline(const ShapeSpec& shape) {
  if (!(shape.diameter > 0))
    throw InputError(fmt::format("shape '{}': diameter {} m; it must be positive", shape.name, shape.diameter));
  const int n = smooth_outline_count(shape, pi * shape.diameter, 1);
  const double turn = 2 * pi / n;
  const double radius = shape.diameter / 2 * std::sqrt(turn / std::sin(turn));
  Points outline;
  for (int k = 0; k < n; ++k) outline.emplace_back(radius * std::cos(k * turn), radius * std::sin(k * turn));
  return outline;
}

std::vector<double> edge_lengths(const Points& polygon) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    lengths.push_back((polygon[(i + 1) % polygon.size()] - polygon[i]).norm());
  return lengths;
}

Segments segments_by_spacing(const std::vector<double>& lengths, double spacing) {
  Segments segments;
  // The margin keeps rounding from adding a segment to an edge of exactly a multiple of the spacing.
  for (double length : lengths) segments.push_back(std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9))));
  return segments;
}

int total(const Segments& segments) {
  int sum = 0;
  for (int s : segments) sum += s;
  return sum;
}

// Exactly `count` segments: each additional one goes to the edge with the longest segments.
Segments segments_by_count(const std::vector<double>& lengths, int count) {
  Segments segments(lengths.size(), 1);
  for (int k = static_cast<int>(lengths.size()); k < count; ++k) {
    std::size_t longest = 0;
    for (std::size_t e = 1; e < lengths.size(); ++e)
      if (lengths[e] / segments[e] > lengths[longest] / segments[longest] * (1 + 1e-9)) longest = e;
    ++segments[longest];
  }
  return segments;
}

// Largest spacing at which an isotropic mesh has at least the requested nodes (bisection: the number falls with it).
double spacing_for_nodes(const Points& polygon, const std::vector<double>& lengths, int nodes) {
  const double area = polygon_properties(polygon).area;
  double fine = std::sqrt(area / nodes) / 10, coarse = perimeter(polygon);
  for (int step = 0; step < 60; ++step) {
    const double middle = std::sqrt(fine * coarse);
    const int outline_count = total(segments_by_spacing(lengths, middle));
    (isotropic_node_count(area, outline_count, middle) >= nodes ? fine : coarse) = middle;
  }
  return fine;
}

Segments polygon_segments(const ShapeSpec& shape) {
  const std::vector<double> lengths = edge_lengths(shape.points);
  if (shape.outline_nodes) {
    if (*shape.outline_nodes < static_cast<int>(lengths.size()))
      throw InputError(fmt::format("shape '{}': outline_nodes = {}; its polygon alone has {} corners", shape.name,
                                   *shape.outline_nodes, lengths.size()));
    return segments_by_count(lengths, *shape.outline_nodes);
  }
  return segments_by_spacing(lengths,
                             shape.spacing ? *shape.spacing : spacing_for_nodes(shape.points, lengths, *shape.nodes));
}

void require_valid_polygon(const ShapeSpec& shape) {
  if (shape.points.size() < 3)
    throw InputError(
        fmt::format("shape '{}': a polygon of {} points; it needs at least 3", shape.name, shape.points.size()));
  if (const std::string defect = polygon_defect(shape.points).text; !defect.empty())
    throw InputError(fmt::format("shape '{}': {}; give each corner once, in order", shape.name, defect));
  const double area = polygon_properties(shape.points).area;
  if (!(area > 0))
    throw InputError(fmt::format("shape '{}': the polygon's points run clockwise (area {:.6g} m2); reverse their order",
                                 shape.name, area));
}

Points polygon_outline(const ShapeSpec& shape) {
  require_valid_polygon(shape);
  const Segments segments = polygon_segments(shape);
  const Vec2 centroid = polygon_properties(shape.points).centroid;
  Points outline;
  for (std::size_t e = 0; e < segments.size(); ++e) {
    const Vec2 a = shape.points[e] - centroid, b = shape.points[(e + 1) % segments.size()] - centroid;
    for (int k = 0; k < segments[e]; ++k) outline.push_back(a + static_cast<double>(k) / segments[e] * (b - a));
  }
  return outline;
}

/// Nodes at equal distances along a smooth curve, moved outward a little so that their polygon has the curve's area.
Points curve_outline(const ShapeSpec& shape) {
  const PolygonProperties curve = polygon_properties(shape.points);
  const double length = perimeter(shape.points);
  const int n = smooth_outline_count(shape, length, length / (2 * std::sqrt(pi * curve.area)));
  Points outline;
  double passed = 0;
  for (std::size_t i = 0; i < shape.points.size(); ++i) {
    const Vec2 a = shape.points[i], b = shape.points[(i + 1) % shape.points.size()];
    const double edge = (b - a).norm();
    for (double at; static_cast<int>(outline.size()) < n && (at = length * outline.size() / n) < passed + edge;)
      outline.push_back(a + (at - passed) / edge * (b - a));
    passed += edge;
  }
  const PolygonProperties polygon = polygon_properties(outline);
  const double scale = std::sqrt(curve.area / polygon.area);
  for (Vec2& p : outline) p = scale * (p - polygon.centroid);
  return outline;
}

void require_resolution(const ShapeSpec& shape) {
  if (!shape.nodes && !shape.spacing && !shape.outline_nodes)
    throw InputError(fmt::format("shape '{}': give nodes, spacing or outline_nodes", shape.name));
  if (shape.spacing && !(*shape.spacing > 0))
    throw InputError(fmt::format("shape '{}': spacing {} m; it must be positive", shape.name, *shape.spacing));
  if (shape.nodes && *shape.nodes < 7)
    throw InputError(fmt::format("shape '{}': nodes = {}; at least 7 are needed", shape.name, *shape.nodes));
}

}  // namespace

int field_node_count(const ShapeSpec& shape, const Points& outline) {
  const int outline_count = static_cast<int>(outline.size());
  if (!shape.nodes && !shape.spacing)
    throw InputError(fmt::format("shape '{}': a compliant body needs nodes or spacing", shape.name));
  const int count = shape.nodes ? *shape.nodes
                                : static_cast<int>(std::lround(isotropic_node_count(polygon_properties(outline).area,
                                                                                    outline_count, *shape.spacing)));
  if (count <= outline_count)
    throw InputError(
        fmt::format("shape '{}': {} field nodes, {} of them on the outline, leave none for the interior; ask "
                    "for more nodes, a finer spacing or fewer outline_nodes",
                    shape.name, count, outline_count));
  return count;
}

Points make_outline(const ShapeSpec& shape) {
  require_resolution(shape);
  switch (shape.kind) {
    case ShapeKind::disc:
      return disc_outline(shape);
    case ShapeKind::polygon:
      return polygon_outline(shape);
    default:
      return curve_outline(shape);
  }
}

}  // namespace pliant
