#pragma once

#include <cstdint>
#include <vector>

#include "core/vec2.hpp"

namespace pliant {

/// Cuts a grain into cells of a power (weighted Voronoi) diagram. Generators are random at first. Lloyd's iteration
/// then moves them to the centroids of their cells within the grain, with weights that follow the areas, as in
/// cells_of_areas.
///
/// Returns [cells], closed polygons, counter-clockwise, in the order of their generators. They cover the grain without
/// overlap or gap. All nodes of the outline are nodes of cells, with the same bits. Two cells have the same nodes, with
/// the same bits, along a common edge. Edges within the grain are divided into equal segments of at most `spacing`. A
/// cut that ends near a node of the outline is moved there. Edges shorter than half a spacing are collapsed, and
/// narrower necks between a cut and another node of a cell are closed, where the cells stay simple polygons.
///
/// A cell that the outline of a concave grain divides becomes several cells. Small parts join a neighbour. The number
/// of cells may therefore differ from that of `areas`.
///
/// `outline`: simple closed polygon, counter-clockwise, of nodes about `spacing` apart. `areas`: of the cells relative
/// to each other. `spacing`: m. One call uses one thread. Throws InputError for arguments that are not positive, for
/// cells that are too small for the spacing, with the largest number that fits, and if the result is not valid.
std::vector<Points> cut_into_cells(const Points& outline, const std::vector<double>& areas, double spacing,
                                   std::uint64_t seed);

}  // namespace pliant
