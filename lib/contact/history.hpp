#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lanes.hpp"

namespace pliant {

/// Contact history, one record a slave node and other body (docs/method.md 4): committed on accepted steps only.
struct ContactHistory {
  /// On the master's outline at the last accepted step, see slip.hpp; NaN when not beside it.
  std::vector<double> place;
  /// Elastic tangential displacement then, m.
  std::vector<double> slip;
  /// What the pair's law remembers besides (laws/response.hpp): first of all records, then second of all ...; empty
  /// when no law of the scene does.
  std::vector<double> of_law;
  /// For energy_debt.hpp, empty without. Of each record that touched: gap then, m, else NaN; and the pressure that
  /// repaid, Pa. [patches]: what they owe, J/m.
  std::vector<double> gap = {}, repaid = {}, owed = {};
  /// Which evaluation of the forces left it behind, where debts are kept; 0: none.
  std::int64_t evaluation = 0;
  /// Where records stand (patch_table.hpp): histories with the same number have each node's at the same place.
  std::int64_t layout = 0;

  std::size_t records() const { return place.size(); }
  std::size_t fields() const { return records() == 0 ? 0 : of_law.size() / records(); }
  double* field(std::size_t k) { return of_law.data() + k * records(); }
  const double* field(std::size_t k) const { return of_law.data() + k * records(); }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("place", place), visitor("slip", slip), visitor("of_law", of_law), visitor("gap", gap),
        visitor("repaid", repaid), visitor("owed", owed);
    visitor("evaluation", evaluation), visitor("layout", layout);
  }
};

/// What a law remembers of eight nodes, from a record on.
template <std::size_t count>
std::array<Lanes, count> load_record(const ContactHistory& history, int record) {
  std::array<Lanes, count> values;
  for (std::size_t k = 0; k < count; ++k) values[k] = load(history.field(k) + record);
  return values;
}
template <std::size_t count>
void store_record(ContactHistory& history, int record, const std::array<Lanes, count>& values) {
  for (std::size_t k = 0; k < count; ++k) store(history.field(k) + record, values[k]);
}

}  // namespace pliant
