#include <limits>

#include "results/probes/probe_functions.hpp"
#include "results/probes/regions.hpp"

namespace pliant {
namespace {

Samples area(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for (int b : selection.bodies) samples.add(1, {outline_area(snapshot, b)});
  return samples;
}

Samples solid_fraction(const Snapshot& snapshot, const Selection& selection) {
  double solid = 0;
  for (int b : selection.bodies) solid += area_in_region(snapshot, selection, b);
  Samples samples(1);
  samples.add(1, {solid / region_area(snapshot, selection)});
  return samples;
}

/// Not a number where nothing counts.
double mean(double sum, double count) { return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN(); }

/// A rattler touches less than two bodies; contacts with rattlers count for the others (Thornton 2000, doi
/// 10.1680/geot.2000.50.1.43).
Samples coordination(const Snapshot& snapshot, const Selection& selection) {
  double contacts = 0, held_contacts = 0, held = 0;
  for (int b : selection.bodies) {
    const int count = snapshot.contact_counts()[b];
    contacts += count;
    if (count >= 2) held_contacts += count, ++held;
  }
  const auto bodies = static_cast<double>(selection.bodies.size());
  Samples samples(3);
  samples.add(1, {mean(contacts, bodies), mean(held_contacts, held), 1 - mean(held, bodies)});
  return samples;
}

}  // namespace

std::vector<ProbeFunction> packing_functions() {
  return {{"area", area}, {"solid_fraction", solid_fraction}, {"coordination", coordination}};
}

}  // namespace pliant
