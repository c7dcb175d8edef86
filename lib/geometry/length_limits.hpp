#pragma once

namespace pliant {

/// Coordinates and sizes from input, m, are at most that, and sizes at least its inverse: beyond, areas and their
/// products leave double precision. So are sizes over that of a shape.
inline constexpr double largest_length = 1e12;

}  // namespace pliant
