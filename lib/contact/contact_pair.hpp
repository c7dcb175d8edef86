#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bodies/model.hpp"
#include "bodies/outline.hpp"
#include "contact/broad_phase.hpp"
#include "contact/contact_law.hpp"
#include "core/lanes.hpp"

namespace pliant {

class MasterWindow;

/// A run of consecutive outline nodes or segments (a segment bears its first node's number). Numbers beyond [0, count)
/// of the outline continue cyclically; on a wall they reach into the next periods.
struct Arc {
  int begin = 0, count = 0;
  int end() const { return begin + count; }
  bool operator==(const Arc&) const = default;
};

/// The shortest arc with both.
inline Arc hull(const Arc& a, const Arc& b) {
  const int begin = a.begin < b.begin ? a.begin : b.begin, end = a.end() > b.end() ? a.end() : b.end();
  return {begin, end - begin};
}

/// Two bodies, or a body and its own periodic image, that come close, and the parts of their outlines that may touch
/// before they are searched again. Of a body that may touch itself, see of_itself(), some nodes, as those of the first,
/// and segments far from them along the outline, as those of the second.
struct ContactPair {
  int first = 0, second = 0;  ///< bodies, first <= second
  int images = 0;             ///< periods to add to x of the second to see it from the first
  int part = 0;               ///< of a body that touches itself: which of its nodes; 0 for two bodies
  bool integrated = false;    ///< over segments; else collocated at nodes
  ContactLaw law;
  Arc nodes[2];     ///< that may touch the other body; no node twice, but images of a wall's
  Arc segments[2];  ///< that the other's nodes may touch
  /// Of contact integrated over segments: how many of each side, from nodes[side].begin on; 0: nodes touch.
  int slave_segments[2] = {0, 0};
  Arc window[2];           ///< `segments`, and of those integrated the ones across the medial axis, which may be nearer
  int record[2] = {0, 0};  ///< first history record of each side's nodes (padded to whole lanes)
  int entry[2] = {0, 0};   ///< first entry of each side in buffers of forces; that of node forces(side).begin
  std::int64_t found = 0;  ///< at which refresh

  BodyPair pair() const { return {first, second, images}; }
  /// Nothing of it can touch for now.
  bool is_empty() const { return nodes[0].count + nodes[1].count == 0; }
  /// Parts of one outline, not of two or of two images.
  bool of_itself() const { return first == second && images == 0; }

  /// All but the law, which follows from the bodies.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("first", first), visitor("second", second), visitor("images", images), visitor("part", part),
        visitor("integrated", integrated);
    visitor("nodes", nodes), visitor("segments", segments), visitor("slave_segments", slave_segments),
        visitor("window", window);
    visitor("record", record), visitor("entry", entry), visitor("found", found);
  }

  /// Outline nodes that this contact pair puts forces on.
  Arc forces(int side) const {
    const Arc n = nodes[side], s{segments[side].begin, segments[side].count == 0 ? 0 : segments[side].count + 1};
    return n.count == 0 ? s : s.count == 0 ? n : hull(n, s);
  }
};

/// The order in which contact pairs stand.
inline bool comes_before(const ContactPair& a, const ContactPair& b) {
  return std::pair(a.pair(), a.part) < std::pair(b.pair(), b.part);
}

/// A contact pair with all that work on it looks at.
struct PairView {
  const Model& model;
  const Outlines& outlines;  ///< in motion
  const ContactPair& contact_pair;
  double skin;                          ///< m
  MasterWindow& window;                 ///< scratch: of the pass at hand
  double elapsed = 0;                   ///< in the step that led here, s; 0: not known
  const OutlineField* moved = nullptr;  ///< ways of outline nodes in that step, m; null: none
  int body(int side) const { return side == 0 ? contact_pair.first : contact_pair.second; }
  /// Periods to add to x of one side's body, m.
  double shift(int side) const { return side == 0 ? 0.0 : contact_pair.images * model.scene.period.value_or(0); }
};

/// What the two passes of a contact pair add up to.
struct PairTotals {
  double stored = 0;         ///< normal and elastic tangential energy, J/m
  double dissipated = 0;     ///< work of slip and damage since the last accepted step, J/m
  double damping_power = 0;  ///< of dashpots, W/m
  double deepest = 0;        ///< largest penetration over the longest segment near; contacts can be lost beyond 1
  int contacts = 0;          ///< nodes in touch
  // See energy_debt.hpp; 0 without:
  double work_before = 0;  ///< of the forces before over the way between them and these, J/m
  double work = 0;         ///< of these forces over the same way
  double pull = 0;         ///< of the forces before on rigid bodies, times the accelerations then, W/(m s)
  double squares = 0;      ///< of pressures over kn, times lengths, J/m

  /// Another contact pair's, but for what belongs to one alone.
  void add(const PairTotals& other) {
    stored += other.stored, dissipated += other.dissipated, damping_power += other.damping_power;
    deepest = deepest > other.deepest ? deepest : other.deepest;
    contacts += other.contacts;
  }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("stored", stored), visitor("dissipated", dissipated), visitor("damping_power", damping_power);
    visitor("deepest", deepest), visitor("contacts", contacts);
    visitor("work_before", work_before), visitor("work", work), visitor("pull", pull), visitor("squares", squares);
  }
};

/// Where the forces of all contact pairs go: each arc has its own stretch, in whole lanes, 0 beyond its last node,
/// gathered later by its body in a fixed order.
struct PairForceBuffer {
  LinedNumbers x, y;  ///< N/m

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("x", x), visitor("y", y);
  }
};

}  // namespace pliant
