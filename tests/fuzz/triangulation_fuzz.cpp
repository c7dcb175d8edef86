// Random and degenerate polygons with points inside: triangles that cover them, or refused with a message.

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "fuzz/fuzz_input.hpp"
#include "geometry/mesh.hpp"
#include "geometry/polygon.hpp"
#include "geometry/triangulate.hpp"

namespace {

using namespace pliant;

/// Corners on a grid of 16 x 16: lines that cross, points that coincide, corners on sides.
Points any_polygon(fuzz::Input& input) {
  Points points;
  for (int corners = 3 + input.byte() % 20; corners > 0; --corners) {
    const int place = input.byte();
    points.push_back({place % 16 / 16.0, static_cast<double>(place / 16) / 16});
  }
  return points;
}

double area(const Points& points, const Triangle& triangle) {
  const auto at = [&](int i) { return points[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])]; };
  const Vec2 a = at(1) - at(0), b = at(2) - at(0);
  return 0.5 * (a.x() * b.y() - a.y() * b.x());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  fuzz::Input input(bytes, count);
  Points points = input.byte() % 2 == 0 ? fuzz::star_polygon(input) : any_polygon(input);
  if (polygon_properties(points).area < 0) std::reverse(points.begin(), points.end());
  const double whole = polygon_properties(points).area;
  const Points polygon = points;
  while (!input.empty()) {
    const double x = (input.byte() - 128) / 128.0, y = (input.byte() - 128) / 128.0;
    if (is_inside(polygon, {x, y})) points.push_back({x, y});
  }
  try {
    double covered = 0;
    for (const Triangle& triangle : triangulate_inside(points, static_cast<int>(polygon.size()))) {
      fuzz::require(area(points, triangle) > 0, "triangles are counter-clockwise and have an area");
      covered += area(points, triangle);
    }
    fuzz::require(std::abs(covered - whole) < 1e-12, "triangles cover the polygon");
  } catch (const InputError&) {
  }
  return 0;
}
