#include "contact/pair_table.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>

#include "core/archive.hpp"
#include "core/parallel.hpp"

namespace pliant {
namespace {

/// Capacity with spare room, for contact pairs that outgrow their places before the next layout. The present one is
/// kept while it leaves some and is not far too large: memory of another size would be given out anew, page by page.
int with_spare(int needed, int present) {
  constexpr int few = 32 * lane_count;
  const int spare = present - needed;
  const bool fits = spare >= needed / 5 + few / 2 && spare <= needed / 2 + 2 * few;
  return fits ? present : padded(needed + needed / 4) + few;
}

/// Transfers the records of one side's nodes from another contact pair of the same bodies to cleared ones.
void carry(const Model& model, const ContactPair& from, const ContactHistory& old, const ContactPair& to, int side,
           ContactHistory& history) {
  for_each_shared(model, to, side, from.nodes[side], to.nodes[side], [&](int old_at, int at, int count) {
    for (int i = 0; i < count; ++i) history.copy_record(old, from.record[side] + old_at + i, to.record[side] + at + i);
  });
}

/// Copies whole groups of eight records.
void copy_eights(const ContactHistory& from, int first, int count, ContactHistory& to, int at) {
  std::copy_n(from.at(first), count / lane_count * ContactHistory::columns, to.at(at));
}

/// Moves the records of a contact pair aside, because others may take their place, and clears them there.
void take_aside(ContactHistory& history, ContactPair& contact_pair, ContactHistory& aside) {
  const int size[2] = {padded(contact_pair.nodes[0].count), padded(contact_pair.nodes[1].count)};
  aside.resize(size[0] + size[1]);
  for (int side = 0; side < 2; ++side) {
    const int from = contact_pair.record[side], to = side * size[0];
    copy_eights(history, from, size[side], aside, to);
    history.clear(from, size[side]);
    contact_pair.record[side] = to;
  }
}

/// Finds space for one side's numbers: at the old place if they fit, else behind all others. Returns false without
/// room.
bool find_room(int wanted, int had, int room, int& used, int& at) {
  if (wanted <= had) return true;
  if (used + wanted > room) return false;
  at = used;
  used += wanted;
  return true;
}

}  // namespace

std::vector<ContactPair> PairTable::lay_out(std::vector<ContactPair> contact_pairs, ContactHistory& history) {
  if (!std::ranges::is_sorted(contact_pairs, comes_before)) std::ranges::sort(contact_pairs, comes_before);
  assign_places(contact_pairs);
  record_room_ = with_spare(records_, record_room_), entry_room_ = with_spare(entries_, entry_room_);
  ContactHistory& next = spare_;
  next.resize(record_room_);
  if (model_.scene.corrects_energy()) next.start_energy_errors(contact_pairs.size());
  const auto transfer = [&](int p) {
    const ContactPair& contact_pair = contact_pairs[p];
    for (int side = 0; side < 2; ++side) next.clear(contact_pair.record[side], padded(contact_pair.nodes[side].count));
    const int from = find_pair(contact_pairs_, contact_pair, p);
    if (from < 0) return;
    for (int side = 0; side < 2; ++side) carry(model_, contact_pairs_[from], history, contact_pair, side, next);
    if (!next.energy_error.empty()) next.copy_energy_error(history, from, p);
  };
  const Blocks spare{record_room_ - records_, 4096};
  const auto clear = [&](int b) { next.clear(records_ + spare[b].begin, spare[b].end - spare[b].begin); };
  parallel_for(static_cast<int>(contact_pairs.size()), transfer, spare.count(), clear);
  std::swap(history, next);
  history.layout = laid_out_ = ++layout_;
  moved_from_ = none;
  std::swap(contact_pairs_, contact_pairs);
  index();
  return contact_pairs;
}

/// Gives contact pairs their records and entries one behind the other. Threads share all but the sums.
void PairTable::assign_places(std::vector<ContactPair>& contact_pairs) {
  const int count = static_cast<int>(contact_pairs.size());
  places_.resize(contact_pairs.size());
  parallel_for(count, [&](int p) {
    for (int side = 0; side < 2; ++side)
      places_[p][side] = {padded(contact_pairs[p].nodes[side].count), padded(contact_pairs[p].forces(side).count)};
  });
  records_ = entries_ = 0;
  for (auto& sides : places_)
    for (auto& [record, entry] : sides)
      record = std::exchange(records_, records_ + record), entry = std::exchange(entries_, entries_ + entry);
  parallel_for(count, [&](int p) {
    for (int side = 0; side < 2; ++side)
      contact_pairs[p].record[side] = places_[p][side][0], contact_pairs[p].entry[side] = places_[p][side][1];
  });
}

void PairTable::take(std::vector<ContactPair> contact_pairs, int records) {
  contact_pairs_ = std::move(contact_pairs);
  records_ = record_room_ = records;
  entries_ = 0;
  for (ContactPair& contact_pair : contact_pairs_)
    for (int side = 0; side < 2; ++side)
      contact_pair.entry[side] = std::exchange(entries_, entries_ + padded(contact_pair.forces(side).count));
  entry_room_ = entries_;
  loaded();
}

/// Assigns memory to new contact pairs. Returns false, and changes nothing in the table, if there is no room.
bool PairTable::take_room(const std::vector<int>& at, std::vector<ContactPair>& now, ContactHistory& history) {
  int records = records_, entries = entries_;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const ContactPair& old = contact_pairs_[at[i]];
    ContactPair& contact_pair = now[i];
    for (int side = 0; side < 2; ++side) {
      contact_pair.record[side] = old.record[side], contact_pair.entry[side] = old.entry[side];
      if (!find_room(padded(contact_pair.nodes[side].count), padded(old.nodes[side].count), record_room_, records,
                     contact_pair.record[side]) ||
          !find_room(padded(contact_pair.forces(side).count), padded(old.forces(side).count), entry_room_, entries,
                     contact_pair.entry[side]))
        return false;
    }
  }
  records_ = records, entries_ = entries;
  history.layout = ++layout_;
  return true;
}

void PairTable::note_moves(const std::vector<int>& at, const std::vector<ContactPair>& now) {
  moved_.clear();
  moved_from_ = layout_ - 1;
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int side = 0; side < 2; ++side) {
      const ContactPair& old = contact_pairs_[at[i]];
      moved_.push_back({old.record[side], padded(old.nodes[side].count)});
      if (now[i].record[side] != old.record[side])
        moved_.push_back({now[i].record[side], padded(now[i].nodes[side].count)});
    }
}

void PairTable::follow(const ContactHistory& from, ContactHistory& to) const {
  if (to.layout == from.layout && to.records() == from.records()) return;
  if (to.layout != moved_from_ || from.layout != layout_ || to.records() != from.records()) {
    to = from;
    return;
  }
  parallel_for(static_cast<int>(moved_.size()),
               [&](int i) { copy_eights(from, moved_[i][0], moved_[i][1], to, moved_[i][0]); });
  to.energy_error = from.energy_error, to.correction = from.correction;
  to.layout = from.layout;
}

void PairTable::move_history(const ContactPair& old, const ContactPair& now, ContactHistory& history) const {
  thread_local ContactHistory aside;  // memory is allocated once
  ContactPair there = old;
  take_aside(history, there, aside);
  for (int side = 0; side < 2; ++side) {
    history.clear(now.record[side], padded(now.nodes[side].count));
    carry(model_, there, aside, now, side, history);
  }
}

ArcEntries PairTable::arc_of(const ContactPair& contact_pair, int side) const {
  const Arc arc = contact_pair.forces(side);
  return {arc.begin, arc.count, contact_pair.entry[side]};
}

/// Throws ArchiveError for contact pairs that no search produces, as in a checkpoint of another model.
void PairTable::refuse_others() const {
  constexpr int far = 1 << 29;  // bound of nodes along a wall, or periods: their sums do not overflow
  const int bodies = static_cast<int>(model_.bodies.size());
  const auto is_arc = [](const Arc& arc) { return std::abs(arc.begin) < far && arc.count >= 0 && arc.count < far; };
  const auto fits = [](int at, int count, int room) { return at >= 0 && at % lane_count == 0 && at <= room - count; };
  const auto is_one = [&](const ContactPair& contact_pair) {
    bool good = contact_pair.first >= 0 && contact_pair.first <= contact_pair.second && contact_pair.second < bodies &&
                std::abs(contact_pair.images.x) < far && std::abs(contact_pair.images.y) < far;
    for (int side = 0; good && side < 2; ++side)
      good = is_arc(contact_pair.nodes[side]) && is_arc(contact_pair.segments[side]) &&
             is_arc(contact_pair.window[side]) &&
             fits(contact_pair.record[side], padded(contact_pair.nodes[side].count), record_room_) &&
             fits(contact_pair.entry[side], padded(contact_pair.forces(side).count), entry_room_);
    return good;
  };
  const auto has_room = [](int used, int room) {
    return 0 <= used && used <= room && used % lane_count == 0 && room % lane_count == 0;
  };
  const bool sound = has_room(records_, record_room_) && has_room(entries_, entry_room_);
  if (!sound || !std::ranges::all_of(contact_pairs_, is_one)) throw ArchiveError("contacts are those of other bodies");
}

/// Forces take as long as their slave nodes and the windows of their masters are large, eight by eight. What else a
/// pair needs counts as eight. Sums that are too large for a number do not grow further.
void PairTable::sum_cost() {
  cost_.resize(contact_pairs_.size() + 1);
  cost_[0] = 0;
  parallel_for(count(), [&](int p) {
    const ContactPair& contact_pair = contact_pairs_[p];
    int cost = 1;
    for (int side = 0; side < 2; ++side)
      cost += (padded(contact_pair.nodes[side].count) + padded(contact_pair.window[side].count)) / lane_count;
    cost_[p + 1] = cost;
  });
  std::int64_t sum = 0;
  for (int& cost : cost_)
    cost = static_cast<int>(sum = std::min<std::int64_t>(sum + cost, std::numeric_limits<int>::max()));
}

void PairTable::index() {
  sum_cost();
  slot_.resize(contact_pairs_.size());
  parallel_for(count(), [&](int p) { slot_[p] = {contact_pairs_[p].first, contact_pairs_[p].second}; });
  arc_begin_.assign(model_.bodies.size() + 1, 0);
  for (const auto& [first, second] : slot_) ++arc_begin_[first + 1], ++arc_begin_[second + 1];
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) arc_begin_[b + 1] += arc_begin_[b];
  std::vector<int> next(arc_begin_.begin(), arc_begin_.end() - 1);
  for (auto& [first, second] : slot_) first = next[first]++, second = next[second]++;
  arcs_.resize(2 * contact_pairs_.size());
  parallel_for(count(), [&](int p) {
    for (int side = 0; side < 2; ++side) arcs_[slot_[p][side]] = arc_of(contact_pairs_[p], side);
  });
}

}  // namespace pliant
