#pragma once

#include "results/probes/selection.hpp"
#include "results/snapshot.hpp"

namespace pliant {

/// Area inside the current outline of a grain, m2.
double outline_area(const Snapshot& snapshot, int body);

bool has_region(const Selection& selection);
/// Area of a selection's box, or between the current outlines of its two walls over one period, m2.
double region_area(const Snapshot& snapshot, const Selection& selection);
/// Whether a grain's centre of mass, or an image of it a whole number of periods away, is in the box. Between walls,
/// and without a region, all are.
bool centre_is_in_region(const Snapshot& snapshot, const Selection& selection, int body);
/// Area of a grain's outline, with its periodic images, inside the region, m2.
double area_in_region(const Snapshot& snapshot, const Selection& selection, int body);

}  // namespace pliant
