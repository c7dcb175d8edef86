#pragma once

#include "contact/contact_pair.hpp"
#include "contact/energy_correction.hpp"
#include "contact/history.hpp"

namespace pliant {

/// Forces of one contact pair: each body's nodes against the other's segments, each half pass with weight 1/2
/// (docs/method.md 4). Reads the history `from` and writes `to`. Penetrations are detected down to the length of the
/// longest segment of the master window plus the skin. Candidates were found at an accepted state, at most one segment
/// deep, and no node moves further than the skin before the next search. Thus no node can pass from a permitted depth
/// beyond detection. `step`: null without the energy correction of energy_correction.hpp.
PairTotals compute_pair(const PairView& view, const PairStep* step, const ContactHistory& from, ContactHistory& to,
                        PairForceBuffer& forces);

}  // namespace pliant
