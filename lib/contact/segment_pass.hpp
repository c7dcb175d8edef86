#pragma once

#include <vector>

#include "contact/contact_points.hpp"
#include "contact/half_pass.hpp"
#include "contact/history.hpp"

namespace pliant {

/// Forces of one contact pair whose contact is integrated over segments (docs/method.md 4), added to the buffer ranges
/// `runs`. Reads the history `from` and writes `to`.
PairTotals integrate_pair(const PairView& view, const ForceRuns& runs, const ContactHistory& from, ContactHistory& to,
                          PairForceBuffer& forces);

/// Length of both sides of such a contact pair that penetrates the other, each half pass with weight 1/2, m.
double integrated_length(const PairView& view);

/// Active slave nodes of such a contact pair: mean gaps, tractions and slip over their part of the contact.
std::vector<ContactPoint> inspect_integrated(const PairView& view, const ContactHistory& history);

}  // namespace pliant
