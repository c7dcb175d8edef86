#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "contact/contact_pair.hpp"
#include "core/archive.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Contact forces of the step that led to a state. The energy correction needs their work in the next step.
struct StepForces {
  PairForceBuffer forces;
  std::vector<PairTotals> totals;  ///< [contact pairs]
  long refreshes = 0;              ///< number of rebuilds before it
  double dt = 0;                   ///< size of the step, s; 0: no step led to the state

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("forces", forces), visitor("totals", totals), visitor("refreshes", refreshes), visitor("dt", dt);
  }
};

/// Contact history, one record per slave node and partner (docs/method.md 4); committed on accepted steps only. All
/// columns of the eight nodes that a pass handles at once are adjacent in memory.
struct ContactHistory {
  enum Column {
    place,           ///< surface coordinate on the master at the last accepted step, see slip.hpp; NaN: no projection
    weight = place,  ///< length that an integrated contact assigns to the node, see segment_pass.hpp, m
    slip,            ///< elastic tangential displacement at the last accepted step, m
    columns,         ///< number of columns
  };
  static constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();

  std::vector<Lanes> numbers;        ///< [eights of records][columns]
  std::vector<double> energy_error;  ///< [contact pairs] energy error to be corrected, J/m; empty without correction
  /// [contact pairs] relative change -chi W1 of the forces; after separation, factor of the forces of parting_law().
  std::vector<double> correction;
  StepForces last;  ///< empty without correction; no part of the state's hash
  /// Version of the storage layout (pair_table.hpp): histories with the same number store each node's record at the
  /// same position.
  std::int64_t layout = 0;

  void start_energy_errors(std::size_t contact_pairs) {
    energy_error.assign(contact_pairs, 0.0), correction.assign(contact_pairs, 0.0);
  }
  void copy_energy_error(const ContactHistory& from, int old_contact_pair, int contact_pair) {
    energy_error[contact_pair] = from.energy_error[old_contact_pair],
    correction[contact_pair] = from.correction[old_contact_pair];
  }
  void resize(int records) { numbers.resize(static_cast<std::size_t>(records / lane_count * columns)); }
  int records() const { return static_cast<int>(numbers.size()) / columns * lane_count; }

  /// Columns of the eight records that begin at `record`.
  Lanes* at(int record) { return numbers.data() + record / lane_count * columns; }
  const Lanes* at(int record) const { return numbers.data() + record / lane_count * columns; }
  double number(int record, int column) const { return at(record)[column][record % lane_count]; }
  void copy_record(const ContactHistory& from, int old_record, int record) {
    for (int c = 0; c < columns; ++c) at(record)[c][record % lane_count] = from.number(old_record, c);
  }
  /// Resets records to nodes without contact.
  void clear(int record, int count) {
    for (int i = record; i < record + count; i += lane_count) at(i)[place] = broadcast(nowhere), at(i)[slip] = Lanes{};
  }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("numbers", numbers);
    visitor("energy_error", energy_error), visitor("correction", correction), visitor("layout", layout);
  }
  void loaded() const {
    if (numbers.size() % columns != 0) throw ArchiveError("contact records have other columns");
  }
};

/// Kind of law between any two bodies, whether they are close or not.
struct PairLaws {
  std::vector<std::int32_t> groups;  ///< [bodies] index of each body's group
  std::vector<std::int32_t> kinds;   ///< [groups x groups] as LawTable::kind
  std::int32_t count = 0;            ///< number of groups

  std::int32_t kind(int first, int second) const { return kinds[groups[first] * count + groups[second]]; }
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("groups", groups), visitor("kinds", kinds), visitor("count", count);
  }
};

/// Contact state at the end of a run, for another run of the same bodies.
struct InheritedContact {
  std::vector<ContactPair> contact_pairs;
  PairLaws laws;
  ContactHistory history;  ///< with the records that the contact pairs refer to

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("contact_pairs", contact_pairs), visitor("laws", laws), visitor("history", history);
  }
};

}  // namespace pliant
