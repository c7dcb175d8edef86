#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// Sizes of `count` grains, [count]: the quantiles (i + 1/2)/count of the distribution in random order, so that any
/// number of grains has its moments; of a list, exact shares.
std::vector<double> draw_sizes(const SizeDistribution& distribution, int count, std::uint64_t seed);

/// Mean of size^2: what a grain's area is on average, over that of its shape.
double mean_square_size(const SizeDistribution& distribution);

double largest_size(const SizeDistribution& distribution);

double equivalent_diameter(const ShapeSpec& shape);  ///< of the circle of its area, m

}  // namespace pliant
