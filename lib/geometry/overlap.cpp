#include "geometry/overlap.hpp"

#include "geometry/polygon.hpp"
#include "geometry/polygon_rules.hpp"

namespace pliant {

bool polygons_overlap(const Points& a, const Points& b) {
  Vec2 low = b[0], high = b[0];
  for (const Vec2& p : b) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2 &from = a[i], &to = a[(i + 1) % a.size()];
    const bool apart =
        (from.cwiseMax(to).array() < low.array()).any() || (from.cwiseMin(to).array() > high.array()).any();
    if (apart) continue;
    for (std::size_t j = 0; j < b.size(); ++j)
      if (segments_meet(from, to, b[j], b[(j + 1) % b.size()])) return true;
  }
  return is_inside(a, b[0]) || is_inside(b, a[0]);
}

}  // namespace pliant
