#include <algorithm>

#include "bonds/fragments.hpp"
#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

Samples bonds(const Snapshot& snapshot, const Selection&) {
  const BondCounts counts = count_bonds(snapshot.bonds(), snapshot.state().memory.bonds);
  Samples samples(3);
  samples.add(
      1, {static_cast<double>(counts.whole), static_cast<double>(counts.softening), static_cast<double>(counts.torn)});
  return samples;
}

Samples fragments(const Snapshot& snapshot, const Selection&) {
  const std::vector<Fragment>& all = snapshot.fragments();
  double largest = 0, total = 0, elongation = 0;
  for (const Fragment& fragment : all) {
    largest = std::max(largest, fragment.mass), total += fragment.mass;
    elongation += fragment.mass * aspect_ratio(snapshot.model(), snapshot.outlines(), fragment);
  }
  Samples samples(6);
  samples.add(1, {static_cast<double>(all.size()), largest, grading_diameter(all, 0.1), grading_diameter(all, 0.5),
                  grading_diameter(all, 0.9), elongation / total});
  return samples;
}

}  // namespace

std::vector<ProbeFunction> bond_functions() { return {{"bonds", bonds}, {"fragments", fragments}}; }

}  // namespace pliant
