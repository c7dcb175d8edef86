#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bodies/model.hpp"
#include "contact/contact_pair.hpp"
#include "contact/history.hpp"
#include "core/parallel.hpp"
#include "core/sorted_search.hpp"

namespace pliant {

/// Range of outline nodes and the corresponding entries of a contact pair.
struct ArcEntries {
  int begin = 0, count = 0;  ///< outline node of the first entry (not reduced), number of entries
  int at = 0;                ///< index of the first entry in the buffers
};

/// Calls copy(from, to, count) for nodes of one side of a pair that two arcs share: positions in both arcs, number of
/// nodes.
template <class Copy>
void for_each_shared(const Model& model, const ContactPair& contact_pair, int side, const Arc& old, const Arc& now,
                     Copy&& copy) {
  if (now == old) return copy(0, 0, now.count);
  const bool two_walls = model.bodies[contact_pair.first].wall && model.bodies[contact_pair.second].wall;
  const OutlineShape& shape = model.outline_of(side == 0 ? contact_pair.first : contact_pair.second);
  const bool images_apart =
      shape.turn_shift != 0 && !two_walls;  // images of wall nodes under a body are distinct: see find_arcs
  for (int i = 0; i < now.count; ++i) {
    int at = now.begin + i - old.begin;
    if (!images_apart) at -= turn_of(at, shape.count) * shape.count;
    if (at >= 0 && at < old.count) copy(at, i, 1);
  }
}

/// Index in ordered contact pairs of the one with the bodies and the part of `wanted`; -1: none.
inline int find_pair(const std::vector<ContactPair>& pairs, const ContactPair& wanted, int near) {
  return find_near(pairs, wanted, near, comes_before);
}

/// Contact pairs with the positions of their nodes' records and forces in memory. A pair that is found again takes the
/// place of the old one, or moves behind all others while there is room, so that the rest stays in place.
class PairTable {
 public:
  explicit PairTable(const Model& model) : model_(model) { index(); }

  const std::vector<ContactPair>& contact_pairs() const { return contact_pairs_; }
  int count() const { return static_cast<int>(contact_pairs_.size()); }
  /// [contact pairs + 1] sums of the cost of their forces, in lanes of slave nodes and master segments.
  const std::vector<int>& cost() const { return cost_; }

  /// Replaces all contact pairs by these, in the order of their keys. The history follows. Returns those before.
  std::vector<ContactPair> lay_out(std::vector<ContactPair> contact_pairs, ContactHistory& history);
  /// Takes the contact pairs of another run, whose history has this many records; the next layout transfers them.
  /// Throws ArchiveError for pairs of other bodies.
  void take(std::vector<ContactPair> contact_pairs, int records);
  /// Replaces the contact pairs at these places of the table by new ones of the same bodies; the history follows. Calls
  /// also(old, now) for each, by several threads at once. Returns false and does nothing if there is no room.
  template <class Also>
  bool replace(const std::vector<int>& at, const std::vector<ContactPair>& found, ContactHistory& history,
               Also&& also) {
    if (at.empty()) return true;
    std::vector<ContactPair> now = found;
    if (!take_room(at, now, history)) return false;
    note_moves(at, now);
    parallel_for(static_cast<int>(at.size()), [&](int i) {
      const ContactPair old = contact_pairs_[at[i]];
      move_history(old, now[i], history);
      contact_pairs_[at[i]] = now[i];
      for (int side = 0; side < 2; ++side) arcs_[slot_[at[i]][side]] = arc_of(now[i], side);
      also(old, now[i]);
    });
    return true;
  }

  /// Brings a history to this layout, so that it differs from `from` only in records that contact pairs write.
  void follow(const ContactHistory& from, ContactHistory& to) const;

  int entries() const { return entry_room_; }  ///< size of force buffers
  /// Number of the last full layout; since then contact pairs have kept their places, unless they were replaced.
  std::int64_t laid_out() const { return laid_out_; }
  /// Calls add(node, entry, count) for ranges of consecutive nodes of a body and their entries in the buffers: all of
  /// its arcs, in the order of the contact pairs.
  template <class Add>
  void for_each_run(int body, Add&& add) const {
    const int nodes = model_.outline_of(body).count;
    for (int i = arc_begin_[body]; i < arc_begin_[body + 1]; ++i) {
      const ArcEntries& arc = arcs_[i];
      for (int done = 0; done < arc.count;) {
        const int from = arc.begin + done, node = from - turn_of(from, nodes) * nodes;
        const int run = std::min(arc.count - done, nodes - node);
        add(node, arc.at + done, run);
        done += run;
      }
    }
  }

  /// Positions in memory are included because they depend on the sequence of searches.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact_pairs", contact_pairs_);
    visitor("records", records_), visitor("record_room", record_room_);
    visitor("entries", entries_), visitor("entry_room", entry_room_);
    visitor("layout", layout_), visitor("laid_out", laid_out_);
  }
  void loaded() {
    refuse_others();
    index();
    moved_from_ = none;
  }
  /// Sets the laws, which a checkpoint omits because they follow from the bodies.
  template <class LawOf>
  void set_laws(LawOf&& law_of) {
    for (ContactPair& contact_pair : contact_pairs_) contact_pair.law = law_of(contact_pair);
  }

 private:
  void refuse_others() const;
  void assign_places(std::vector<ContactPair>& contact_pairs);
  void sum_cost();
  void index();
  bool take_room(const std::vector<int>& at, std::vector<ContactPair>& now, ContactHistory& history);
  void note_moves(const std::vector<int>& at, const std::vector<ContactPair>& now);
  void move_history(const ContactPair& old, const ContactPair& now, ContactHistory& history) const;
  ArcEntries arc_of(const ContactPair& contact_pair, int side) const;

  static constexpr std::int64_t none = -2;  ///< layout of no history

  const Model& model_;
  std::vector<ContactPair> contact_pairs_;
  int records_ = 0, record_room_ = 0;       ///< in use or abandoned; capacity
  int entries_ = 0, entry_room_ = 0;        ///< of the force buffers, likewise
  std::int64_t layout_ = 0, laid_out_ = 0;  ///< ContactHistory::layout: now, and at the last full layout
  /// Records that the last replacement changed, and the layout before it.
  std::vector<std::array<int, 2>> moved_;  ///< first, count
  std::int64_t moved_from_ = none;
  ContactHistory spare_;                                   ///< memory for the next layout
  std::vector<int> cost_;                                  ///< [contact pairs + 1] at the last full layout
  std::vector<std::array<std::array<int, 2>, 2>> places_;  ///< scratch, [contact pairs][sides]: record, entry
  std::vector<int> arc_begin_;                             ///< [bodies + 1]
  std::vector<ArcEntries> arcs_;                           ///< of each body's contact pairs, in their order
  std::vector<std::array<int, 2>> slot_;                   ///< [contact pairs][sides] index in arcs_
};

}  // namespace pliant
