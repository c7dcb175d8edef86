#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline_fields.hpp"
#include "contact/broad_phase.hpp"
#include "contact/contact_law.hpp"
#include "core/lanes.hpp"

namespace pliant {

class MasterWindow;

/// Range of consecutive outline nodes or segments; a segment has the number of its first node. Numbers beyond
/// [0, count) of the outline continue cyclically; on a wall they are in neighbouring periods.
struct Arc {
  int begin = 0, count = 0;
  int end() const { return begin + count; }
  bool operator==(const Arc&) const = default;
};

/// Shortest arc that contains both.
inline Arc hull(const Arc& a, const Arc& b) {
  const int begin = a.begin < b.begin ? a.begin : b.begin, end = a.end() > b.end() ? a.end() : b.end();
  return {begin, end - begin};
}

/// Two bodies, or a body and its own periodic image, that come close, with the parts of their outlines that may touch
/// before the next search. For self-contact, see of_itself(), some nodes are stored as those of the first body, and the
/// segments far from them along the outline as those of the second.
struct ContactPair {
  int first = 0, second = 0;  ///< bodies, first <= second
  Images images;              ///< of the second body as seen from the first
  int part = 0;               ///< first node of a part in self-contact; 0 for two bodies
  bool integrated = false;    ///< integrated over segments; else collocated at nodes
  ContactLaw law;
  Arc nodes[2];     ///< that may touch the other body; each node once, except images of a wall's nodes
  Arc segments[2];  ///< that the other body's nodes may touch
  /// Integrated contact: number of slave segments of each side, from nodes[side].begin on; 0 for collocation at nodes.
  int slave_segments[2] = {0, 0};
  Arc window[2];           ///< `segments`; with integration also their medial neighbours, which may be nearer
  int record[2] = {0, 0};  ///< first history record of each side's nodes (padded to whole lanes)
  int entry[2] = {0, 0};   ///< first force buffer entry of each side, for node forces(side).begin
  std::int64_t found = 0;  ///< number of the rebuild that found it

  BodyPair pair() const { return {first, second, images}; }
  /// Whether it has no candidates.
  bool is_empty() const { return nodes[0].count + nodes[1].count == 0; }
  /// Self-contact: both sides are parts of one outline, not of two bodies or two images.
  bool of_itself() const { return first == second && images == Images{}; }

  /// All members except the law, which follows from the bodies.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("first", first), visitor("second", second), visitor("images", images), visitor("part", part),
        visitor("integrated", integrated);
    visitor("nodes", nodes), visitor("segments", segments), visitor("slave_segments", slave_segments),
        visitor("window", window);
    visitor("record", record), visitor("entry", entry), visitor("found", found);
  }

  /// Outline nodes that receive forces from this contact pair.
  Arc forces(int side) const {
    const Arc n = nodes[side], s{segments[side].begin, segments[side].count == 0 ? 0 : segments[side].count + 1};
    return n.count == 0 ? s : s.count == 0 ? n : hull(n, s);
  }
};

/// Storage order of contact pairs.
inline bool comes_before(const ContactPair& a, const ContactPair& b) {
  return std::pair(a.pair(), a.part) < std::pair(b.pair(), b.part);
}

/// Contact pair with the data that its evaluation needs.
struct PairView {
  const Model& model;
  const Outlines& outlines;  ///< current outlines
  const ContactPair& contact_pair;
  double skin;                           ///< m
  MasterWindow& window;                  ///< scratch: master segments of the current half pass
  double dt = 0;                         ///< size of the step that led here, s; 0: unknown
  const OutlineField* before = nullptr;  ///< outlines at the start of that step; null: none
  int body(int side) const { return side == 0 ? contact_pair.first : contact_pair.second; }
  /// Shift of one side's body to its image, m.
  Vec2 shift(int side) const { return image_of(outlines.position, side); }
  /// Difference of a field between the image of one side's body and the body itself.
  Vec2 image_of(const OutlineField& field, int side) const {
    return side == 0 ? Vec2(0, 0) : field.lattice.shift(contact_pair.images);
  }
};

/// Sums over both half passes of a contact pair.
struct PairTotals {
  double stored = 0;         ///< normal and elastic tangential energy, J/m
  double dissipated = 0;     ///< work of slip and damage since the last accepted step, J/m
  double damping_power = 0;  ///< power of dashpots, W/m
  double deepest =
      0;  ///< largest penetration over the longest segment of the master window; contacts can be lost beyond 1
  int contacts = 0;  ///< active slave nodes; slave segments if integrated
  // For energy_correction.hpp; work and step_change are 0 without a step:
  double work_before = 0;    ///< work of the forces at the step's start over its displacements, J/m
  double work = 0;           ///< work of the present forces over the same displacements, J/m
  double step_change = 0;    ///< energy that rigid bodies keep where the step changes or forces jump, J/m
  double traction_norm = 0;  ///< S: p^2/kn + tau^2/kt, integrated over length, J/m

  /// Adds the sums of another contact pair, except those of the energy correction, which belong to one pair alone.
  void add(const PairTotals& other) {
    stored += other.stored, dissipated += other.dissipated, damping_power += other.damping_power;
    deepest = deepest > other.deepest ? deepest : other.deepest;
    contacts += other.contacts;
  }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("stored", stored), visitor("dissipated", dissipated), visitor("damping_power", damping_power);
    visitor("deepest", deepest), visitor("contacts", contacts);
    visitor("work_before", work_before), visitor("work", work), visitor("step_change", step_change),
        visitor("traction_norm", traction_norm);
  }
};

/// Force buffer of all contact pairs. Each arc has its own range in whole lanes, zero beyond its last node. Bodies
/// gather their forces from it later in a fixed order.
struct PairForceBuffer {
  LinedNumbers x, y;  ///< N/m

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("x", x), visitor("y", y);
  }
};

}  // namespace pliant
