#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dynamics/trial.hpp"

namespace pliant {

/// Statistics of the accepted steps of a run, for the diagnosis of its energy balance.
struct StepStatistics {
  double deepest = 0;             ///< largest penetration over the longest segment near
  double deepest_time = 0;        ///< s
  std::int64_t contacts = 0;      ///< largest number of simultaneous contacts
  std::int64_t by_error = 0;      ///< steps limited by the error ...
  std::int64_t by_stability = 0;  ///< ... and by the stability bound

  void add(const StepReport& report, double time) {
    const PairTotals& contact = report.evaluation.contact;
    if (contact.deepest > deepest) deepest = contact.deepest, deepest_time = time;
    contacts = std::max<std::int64_t>(contacts, contact.contacts);
    by_error += report.limited_by == StepLimit::error;
    by_stability += report.limited_by == StepLimit::stability;
  }

  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("deepest", deepest), visitor("deepest_time", deepest_time), visitor("contacts", contacts);
    visitor("by_error", by_error), visitor("by_stability", by_stability);
  }
};

}  // namespace pliant
