#pragma once

#include <vector>

#include "geometry/placement.hpp"

namespace pliant {

/// Cells of a power (weighted Voronoi) diagram of a region that is periodic in x, or in x and y: the points x of the
/// region with least |x - generator|^2 - weight. [cells], convex polygons, counter-clockwise, around their generator
/// whatever the periods; empty for a generator without a cell. Weights are in m2; equal ones give the Voronoi diagram.
std::vector<Points> power_cells(const Points& generators, const std::vector<double>& weights, const Strip& region);

/// Moves generators from random positions until each cell has about its wanted area (m2, their sum the region's) and
/// its generator is near its centroid. The method is Lloyd's iteration, with weights that follow the areas as in a
/// capacity-constrained diagram (F. de Goes, K. Breeden, V. Ostromoukhov, M. Desbrun, ACM Trans. Graph. 31(6), 171,
/// 2012). Returns the cells.
std::vector<Points> cells_of_areas(const std::vector<double>& areas, const Strip& region, std::uint64_t seed);

}  // namespace pliant
