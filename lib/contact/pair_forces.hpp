#pragma once

#include "contact/contact_pair.hpp"
#include "contact/energy_debt.hpp"
#include "contact/history.hpp"

namespace pliant {

/// Forces of one contact pair: each body's nodes against the other's segments, each pass with weight 1/2
/// (docs/method.md 4), from one history into another. Penetrations are seen down to the longest segment near and the
/// skin more. Candidates were found at an accepted state, at most a segment deep, from which nothing goes further than
/// the skin before they are found anew: none can pass from a permitted depth to beyond sight.
/// `step`: null without energy_debt.hpp.
PairTotals compute_pair(const PairView& view, const PairStep* step, const ContactHistory& from, ContactHistory& to,
                        PairForceBuffer& forces);

}  // namespace pliant
