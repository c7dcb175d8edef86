#pragma once

#include <cstdint>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Number of points that stand for a smooth closed curve: outlines are taken from them.
inline constexpr int curve_points = 1440;

/// Corners of a regular polygon on a circle, counter-clockwise, m.
Points regular_polygon(int sides, double diameter);

/// Ellipse of the given axes, counter-clockwise, its polygon of the ellipse's area.
Points ellipse(double width, double height);

/// Fourier grain (Mollon and Zhao 2012, doi 10.1007/s10035-012-0356-x): polar radius 1 + sum_n D_n cos(n theta + phase_n), n = 2 on, phases
/// random by seed, scaled to the area of a circle of `diameter`. Empty when the radius is not positive all round.
Points fourier_grain(double diameter, const std::vector<double>& descriptors, std::int64_t seed);

}  // namespace pliant
