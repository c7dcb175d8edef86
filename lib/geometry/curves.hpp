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

/// Fourier grain (Mollon and Zhao 2012, doi 10.1007/s10035-012-0356-x): polar radius 1 + sum_n D_n cos(n theta +
/// phase_n), n = 2 on, phases random by seed, scaled to the area of a circle of `diameter`. Empty when the radius is
/// not positive all round.
Points fourier_grain(double diameter, const std::vector<double>& descriptors, std::int64_t seed);

/// The same with given phases, rad, one a descriptor.
Points fourier_grain(double diameter, const std::vector<double>& descriptors, const std::vector<double>& phases);

/// A polygon whose corners are arcs of `radius`, tangent to its edges (inside it at convex corners, outside at concave
/// ones), counter-clockwise as the polygon; points enough for a smooth curve, their area that of the true shape.
/// Empty when the arcs at both ends of some edge are longer than it: the radius exceeds `largest_rounding`.
Points rounded_polygon(const Points& polygon, double radius);

/// Largest radius at which all corners of a polygon can be rounded, m.
double largest_rounding(const Points& polygon);

/// A polygon scaled about the origin to an area, m2; it runs counter-clockwise.
Points scaled_to_area(Points polygon, double area);

}  // namespace pliant
