#pragma once

#include <vector>

#include "contact/contact_points.hpp"
#include "contact/history.hpp"
#include "contact/pass.hpp"

namespace pliant {

/// Forces of one patch whose contact is integrated over segments (docs/method.md 4), added to buffers of these runs,
/// from one history into another.
PatchTotals integrate_patch(const PatchView& view, const ForceRuns& runs, const ContactHistory& from,
                            ContactHistory& to, PatchForces& forces);

/// Length of both sides of such a patch inside the other, each pass with weight 1/2, m.
double integrated_length(const PatchView& view);

/// Of such a patch the slave nodes in touch: mean gaps, tractions and slip over their part of the contact.
std::vector<ContactPoint> inspect_integrated(const PatchView& view, const ContactHistory& history);

}  // namespace pliant
