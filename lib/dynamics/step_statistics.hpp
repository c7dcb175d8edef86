#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "dynamics/trial.hpp"

namespace pliant {

/// What the accepted steps of a run have met: for the diagnosis of its energy balance.
struct StepStatistics {
  double deepest = 0;             ///< penetration over the longest segment near, the largest
  double deepest_time = 0;        ///< s
  std::int64_t contacts = 0;      ///< nodes in touch at once, the most
  std::int64_t by_error = 0;      ///< steps whose length the error limited ...
  std::int64_t by_stability = 0;  ///< ... and the bound of stability

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
