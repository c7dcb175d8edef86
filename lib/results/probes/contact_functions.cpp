#include <algorithm>
#include <cmath>

#include "results/probes/probe_functions.hpp"

namespace pliant {
namespace {

/// Calls add(point) for the selected bodies' nodes in touch with the partners.
template <class Add>
void for_each_contact(const Snapshot& snapshot, const Selection& selection, Add&& add) {
  for (const TouchingPair& pair : snapshot.contacts())
    for (const ContactPoint& point : pair.points)
      if (selection.chosen[point.slave] && selection.partners[point.master] &&
          (!selection.node || point.node == *selection.node))
        add(point);
}

template <auto value>
Samples by_contact(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(1);
  for_each_contact(snapshot, selection, [&](const ContactPoint& point) { samples.add(point.length, {point.*value}); });
  return samples;
}

/// A body that touches itself is no pair; one that touches its periodic image is.
bool is_selected(const Selection& selection, const TouchingPair& pair) {
  if (pair.of_itself()) return false;
  return (selection.chosen[pair.first] && selection.partners[pair.second]) ||
         (selection.chosen[pair.second] && selection.partners[pair.first]);
}

Samples contacts(const Snapshot& snapshot, const Selection& selection) {
  const auto& all = snapshot.contacts();
  const auto pairs =
      std::count_if(all.begin(), all.end(), [&](const TouchingPair& pair) { return is_selected(selection, pair); });
  int nodes = 0;
  for_each_contact(snapshot, selection, [&](const ContactPoint&) { ++nodes; });
  Samples samples(2);
  samples.add(1, {static_cast<double>(pairs), static_cast<double>(nodes)});
  return samples;
}

Samples contact_length(const Snapshot& snapshot, const Selection& selection) {
  const std::vector<int>& offset = snapshot.model().outline_offset;
  std::vector<double> length(static_cast<std::size_t>(offset.back()),
                             0.0);  // of each outline node in touch, once however many it touches
  for_each_contact(snapshot, selection, [&](const ContactPoint& p) { length[offset[p.slave] + p.node] = p.length; });
  Samples samples(1);
  for (int b : selection.bodies) {
    double sum = 0;
    for (int i = offset[b]; i < offset[b + 1]; ++i) sum += length[i];
    samples.add(1, {sum});
  }
  return samples;
}

/// Mean of n (x) n; the invariants follow from it.
Samples fabric(const Snapshot& snapshot, const Selection& selection) {
  Samples samples(5);
  for (const TouchingPair& pair : snapshot.contacts()) {
    const Vec2 n = pair.normal();
    if (is_selected(selection, pair) && n.squaredNorm() > 0)
      samples.add(1, {n.x() * n.x(), n.x() * n.y(), n.y() * n.y(), 0, 0});
  }
  return samples;
}

void finish_fabric(std::vector<double>& row) {
  row[3] = std::hypot(row[0] - row[2], 2 * row[1]);
  row[4] = 0.5 * std::atan2(2 * row[1], row[0] - row[2]);
}

}  // namespace

std::vector<ProbeFunction> contact_functions() {
  return {{"contact_gap", by_contact<&ContactPoint::gap>},
          {"contact_slip", by_contact<&ContactPoint::slip>},
          {"contact_pressure", by_contact<&ContactPoint::pressure>},
          {"contact_shear", by_contact<&ContactPoint::shear>},
          {"contacts", contacts},
          {"contact_length", contact_length},
          {"fabric", fabric, finish_fabric}};
}

}  // namespace pliant
