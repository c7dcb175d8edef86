#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "bodies/model.hpp"
#include "contact/contact_pair.hpp"
#include "contact/history.hpp"
#include "core/parallel.hpp"

namespace pliant {

/// A run of outline nodes and the entries of a contact pair that go with them.
struct ArcEntries {
  int begin = 0, count = 0;  ///< outline node of the first entry (not reduced), entries
  int at = 0;                ///< of the first entry in the buffers
};

/// Calls copy(from, to, count) for nodes of one side of a pair that two arcs share: positions in them, and how many.
template <class Copy>
void for_each_shared(const Model& model, const ContactPair& contact_pair, int side, const Arc& old, const Arc& now,
                     Copy&& copy) {
  if (now == old) return copy(0, 0, now.count);
  const bool two_walls = model.bodies[contact_pair.first].wall && model.bodies[contact_pair.second].wall;
  const OutlineShape& shape = model.outline_of(side == 0 ? contact_pair.first : contact_pair.second);
  const bool images_apart = shape.turn_shift != 0 && !two_walls;  // nodes of a wall under a body: see find_arcs
  for (int i = 0; i < now.count; ++i) {
    int at = now.begin + i - old.begin;
    if (!images_apart) at -= turn_of(at, shape.count) * shape.count;
    if (at >= 0 && at < old.count) copy(at, i, 1);
  }
}

/// The contact pairs, and where the records of their nodes and the forces on them stand. One that is found anew takes
/// the old one's place, or goes behind all others as long as there is room, so that the rest stays where it is.
class PairTable {
 public:
  explicit PairTable(const Model& model) : model_(model) { index(); }

  const std::vector<ContactPair>& contact_pairs() const { return contact_pairs_; }
  int count() const { return static_cast<int>(contact_pairs_.size()); }
  /// Null if there is none.
  const ContactPair* find(const BodyPair& pair, int part = 0) const;

  /// Takes these, in the order of their keys, for those before. The history follows, with so many fields of laws.
  void lay_out(std::vector<ContactPair> contact_pairs, std::size_t fields, ContactHistory& history);
  /// Takes those of another run, with so many records in a history of its own: the next layout carries them over.
  /// Throws ArchiveError for those of other bodies.
  void take(std::vector<ContactPair> contact_pairs, int records);
  /// Takes contact pairs for those of the same bodies that have these places in the table; the history follows. Calls
  /// also(old, now) for each, by several threads at once. False, and nothing done, where there is no room.
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

  /// Makes a history one of this layout that differs from another one in the records of contact pairs alone.
  void follow(const ContactHistory& from, ContactHistory& to) const;

  int entries() const { return entry_room_; }  ///< that buffers of forces must have
  /// Since this layout contact pairs have kept their places, but for those that were replaced.
  std::int64_t laid_out() const { return laid_out_; }
  /// Calls add(node, entry, count) for runs of consecutive nodes of a body with their entries in the buffers: all of
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

  /// Where things stand is kept as well: it depends on what was found when.
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
  /// What a checkpoint leaves out: it follows from the bodies.
  template <class LawOf>
  void set_laws(LawOf&& law_of) {
    for (ContactPair& contact_pair : contact_pairs_) contact_pair.law = law_of(contact_pair);
  }

 private:
  void refuse_others() const;
  void index();
  bool take_room(const std::vector<int>& at, std::vector<ContactPair>& now, ContactHistory& history);
  void note_moves(const std::vector<int>& at, const std::vector<ContactPair>& now);
  void move_history(const ContactPair& old, const ContactPair& now, ContactHistory& history) const;
  ArcEntries arc_of(const ContactPair& contact_pair, int side) const;

  static constexpr std::int64_t none = -2;  ///< no history's layout

  const Model& model_;
  std::vector<ContactPair> contact_pairs_;
  int records_ = 0, record_room_ = 0;       ///< in use or left behind; in all
  int entries_ = 0, entry_room_ = 0;        ///< of the buffers of forces, likewise
  std::int64_t layout_ = 0, laid_out_ = 0;  ///< ContactHistory::layout: now, and of the last layout of all
  /// Records of which the last replacement made others, and the layout before it.
  std::vector<std::array<int, 2>> moved_;  ///< first, count
  std::int64_t moved_from_ = none;
  std::vector<int> arc_begin_;            ///< [bodies + 1]
  std::vector<ArcEntries> arcs_;          ///< of each body's contact pairs, in their order
  std::vector<std::array<int, 2>> slot_;  ///< [contact pairs][sides] of arcs_
};

}  // namespace pliant
