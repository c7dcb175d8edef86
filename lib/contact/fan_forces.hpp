#pragma once

#include <cmath>

#include "contact/segment_parts.hpp"

namespace pliant {

/// Parts of eight slave segments in the vertex region outside a node, each in a range of gaps.
struct FanParts {
  LaneBits hit;
  Span8 span;
  Lanes low, high;       ///< range of gaps, m
  Lanes x0, y0, dx, dy;  ///< first end of the slave segment relative to the node, and its vector, m
  Lanes counted_length;  ///< of the whole slave segment, reference or current, m
};

/// Calls visit.in_fan(FanPoint) and, where present, visit.in_fan_of(FanShape) for such parts.
///
/// Normals rotate from one side of a corner to the other, over almost no length if a segment passes close by. Therefore
/// the integrals of tractions a + b r times hat functions are evaluated in closed form, from the tractions at two
/// distances r. With u along the segment from the foot of the node and m the node's distance, r^2 = m^2 + u^2.
template <class Visit>
void visit_fan_forces(const FanParts& of, Visit& visit) {
  const Lanes length = sqrt(of.dx * of.dx + of.dy * of.dy), ex = of.dx / length, ey = of.dy / length;
  const Lanes u0 = of.x0 * ex + of.y0 * ey;
  const Lanes mx = of.x0 - u0 * ex, my = of.y0 - u0 * ey, m2 = mx * mx + my * my;
  const Lanes a = u0 + select(of.hit, of.span.low, Lanes{}) * length,
              b = u0 + select(of.hit, of.span.high, Lanes{}) * length;
  const Lanes ra = sqrt(m2 + a * a), rb = sqrt(m2 + b * b);
  // Integrals of 1/r, u/r and u^2/r. a and b are on the same side of the foot.
  const LaneBits before = a + b < 0.0;
  const Lanes near_end = select(before, rb - b, ra + a), far_end = select(before, ra - a, rb + b);
  const LaneBits apart = of.hit & (near_end > 0.0);
  const Lanes ratio = far_end / select(apart, near_end, broadcast(1));
  Lanes q0{};
  for (int lane = 0; lane < lane_count; ++lane)
    if (apart[lane]) q0[lane] = std::log(ratio[lane]);
  const Lanes q1 = rb - ra, q2 = 0.5 * (b * rb - a * ra - m2 * q0);
  const Lanes p0 = b - a, p1 = 0.5 * (b * b - a * a), p2 = (b * b * b - a * a * a) * (1.0 / 3);
  // Integrals of n and r n, alone and times u.
  const Lanes n_x = mx * q0 + ex * q1, n_y = my * q0 + ey * q1, un_x = mx * q1 + ex * q2, un_y = my * q1 + ey * q2;
  const Lanes rn_x = mx * p0 + ex * p1, rn_y = my * p0 + ey * p1, urn_x = mx * p1 + ex * p2, urn_y = my * p1 + ey * p2;
  const Lanes scale = select(of.hit, 0.5 * of.counted_length / length, Lanes{}), inverse = 1.0 / length;
  const Lanes r_integral = 0.5 * (b * rb - a * ra + m2 * q0), r2_integral = m2 * p0 + p2;
  // Integrals times s and s^2, where s = (u - u0)/length.
  const Lanes ru = (rb * rb * rb - ra * ra * ra) * (1.0 / 3), r_times_s = (ru - u0 * r_integral) * inverse,
              times_s = (p1 - u0 * p0) * inverse;
  if constexpr (WantsFans<Visit>) {
    const Lanes q3 = b * b * rb - a * a * ra - 2.0 * ru, twice = 2.0 * u0, square = u0 * u0,
                inverse2 = inverse * inverse;
    FanShape shape{of.hit};
    shape.weight[0] = scale * p0, shape.weight[1] = scale * times_s;
    shape.weight[2] = scale * (p2 - twice * p1 + square * p0) * inverse2;
    const auto times = [&](Lanes* to, Lanes n, Lanes un, Lanes uun) {
      to[0] = scale * n, to[1] = scale * (un - u0 * n) * inverse;
      to[2] = scale * (uun - twice * un + square * n) * inverse2;
    };
    times(shape.normal_x, n_x, un_x, mx * q2 + ex * q3);
    times(shape.normal_y, n_y, un_y, my * q2 + ey * q3);
    shape.gap = {scale * r_integral, scale * r_times_s};
    visit.in_fan_of(shape);
  }
  // Tractions are interpolated from the first and the last of three distances, energies from all three.
  const Lanes middle = 0.5 * (of.low + of.high), half = select(of.hit, 0.25 * (of.high - of.low), broadcast(1));
  for (const int k : {-1, 0, 1}) {
    const double to_p = k == 0 ? -1 : -k, to_q = k == 0 ? 1 : -2 * k;  // offsets of the other two
    const Lanes own = middle + k * half, p = own + to_p * half, q = own + to_q * half;
    FanPoint point{of.hit, {}, own, {}, {}, {}, {}, {}, {}, {}};
    point.energy_weight = scale / ((to_p * to_q) * half * half) * (r2_integral - (p + q) * r_integral + p * q * p0);
    if (k != 0) {
      const Lanes factor = scale / (to_q * half);
      const Lanes x = factor * (q * n_x - rn_x), y = factor * (q * n_y - rn_y), ux = factor * (q * un_x - urn_x),
                  uy = factor * (q * un_y - urn_y);
      point.force_x[1] = (ux - u0 * x) * inverse, point.force_y[1] = (uy - u0 * y) * inverse;
      point.force_x[0] = x - point.force_x[1], point.force_y[0] = y - point.force_y[1];
      point.of_limit = {factor * (q * p0 - r_integral), factor * (q * times_s - r_times_s)};
    }
    visit.in_fan(point);
  }
}

}  // namespace pliant
