#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.hpp"
#include "geometry/mesh.hpp"

namespace pliant {
namespace {

// Number of segments of at most `spacing`; the margin keeps rounding from adding one to an exact multiple.
int segment_count(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
}

// Appends points from a to b, without b.
void append_line(Points& chain, const Vec2& a, const Vec2& b, double spacing) {
  const int n = segment_count((b - a).norm(), spacing);
  for (int k = 0; k < n; ++k) chain.push_back(a + static_cast<double>(k) / n * (b - a));
}

// Arc of one asperity, from left to right.
struct Arc {
  Vec2 centre;
  double radius, half_angle, side;  // side: +1 when the grains are above the wall, -1 below
  Vec2 at(double angle) const { return centre + radius * Vec2(std::sin(angle), side * std::cos(angle)); }
  Vec2 left() const { return at(-half_angle); }
  Vec2 right() const { return at(half_angle); }
};

void append_arc(Points& chain, const Arc& arc, double spacing) {
  const int n = segment_count(2 * arc.half_angle * arc.radius, spacing);
  for (int k = 0; k < n; ++k) chain.push_back(arc.at((2.0 * k / n - 1) * arc.half_angle));
}

void require_valid_asperities(const Wall& wall) {
  const Asperities& asperities = *wall.asperities;
  if (asperities.count < 1 || !(asperities.diameter > 0))
    throw InputError(fmt::format("wall '{}': {} asperities of diameter {:.6g} m; both must be positive", wall.name,
                                 asperities.count, asperities.diameter));
  if (asperities.heights.empty() || asperities.half_angles.empty())
    throw InputError(fmt::format("wall '{}': asperities need at least one height and one half angle", wall.name));
  for (const double angle : asperities.half_angles)
    if (!(angle > 0 && angle < std::numbers::pi / 2))
      throw InputError(
          fmt::format("wall '{}': asperity half angle {:.6g} rad; allowed: above 0, below pi/2", wall.name, angle));
}

// Arcs of one period, followed by the first one, shifted.
std::vector<Arc> asperity_arcs(const Wall& wall, double period) {
  const Asperities& asperities = *wall.asperities;
  const double side = wall.solid == Wall::Solid::below ? 1 : -1;
  std::vector<Arc> arcs;
  for (int j = 0; j < asperities.count; ++j) {
    const double height = asperities.heights[j % asperities.heights.size()];
    arcs.push_back({Vec2(asperities.first + j * period / asperities.count, wall.level + side * height),
                    asperities.diameter / 2, asperities.half_angles[j % asperities.half_angles.size()], side});
  }
  arcs.push_back(arcs.front());
  arcs.back().centre.x() += period;
  return arcs;
}

Points capped_chain(const Wall& wall, double period, double spacing) {
  require_valid_asperities(wall);
  const std::vector<Arc> arcs = asperity_arcs(wall, period);
  Points chain;
  for (std::size_t j = 0; j + 1 < arcs.size(); ++j) {
    const Vec2 from = arcs[j].right(), to = arcs[j + 1].left();
    if (!(from.x() < to.x()))
      throw InputError(
          fmt::format("wall '{}': asperity {} ends at x = {:.6g} m, beyond the start of the next at {:.6g} m; take "
                      "fewer asperities or smaller half angles",
                      wall.name, j, from.x(), to.x()));
    append_arc(chain, arcs[j], spacing);
    append_line(chain, from, to, spacing);
  }
  return chain;
}

// The same periodic line, starting at its first point in [0, period).
Points wrapped(Points chain, double period) {
  for (Vec2& p : chain) {
    p.x() -= std::floor(p.x() / period) * period;
    if (p.x() >= period) p.x() = 0;  // from a tiny negative number
  }
  const auto leftmost = std::min_element(chain.begin(), chain.end(), [](auto& a, auto& b) { return a.x() < b.x(); });
  std::rotate(chain.begin(), leftmost, chain.end());
  return chain;
}

}  // namespace

Points wall_outline(const Wall& wall, double period, double spacing) {
  if (!(period > 0) || !(spacing > 0))
    throw InputError(fmt::format("wall '{}': period {:.6g} m, outline spacing {:.6g} m; both must be positive",
                                 wall.name, period, spacing));
  Points chain;
  if (wall.asperities)
    chain = wrapped(capped_chain(wall, period, spacing), period);
  else
    append_line(chain, Vec2(0, wall.level), Vec2(period, wall.level), spacing);
  if (wall.solid == Wall::Solid::below) std::reverse(chain.begin(), chain.end());
  return chain;
}

}  // namespace pliant
