#include <algorithm>
#include <cmath>

#include "contact/contact.hpp"
#include "contact/patch_forces.hpp"

namespace pliant {

/// Forces of a patch after a step in which it repays some of what it owes, and what it owes then.
PatchTotals ContactSystem::settle(const PatchView& view, int patch, const StepStart* step, const ContactHistory& from,
                                  ContactHistory& to, PatchForces& forces) {
  to.owed[patch] = from.owed[patch];
  // What a dashpot takes depends on the step: what it seems to owe, it does not.
  if (is_damped(view.patch.law)) return compute_patch(view, nullptr, from, to, forces);
  const PatchTotals& before = last_.totals[patch];
  // Parts of a body that touches itself are others after a search.
  const bool known = step && last_.number > 0 && last_.number == from.evaluation &&
                     (!view.patch.of_itself() || view.patch.found <= last_.refreshes);
  const PatchStep way{known ? &step->position : nullptr, &last_.forces, from.owed[patch] - before.pending,
                      known ? before.recent_ways : 0,    most_repaid_,  step != nullptr};
  PatchTotals now = compute_patch(view, &way, from, to, forces);
  now.recent_ways = now.ways;
  if (!known) return now;
  now.recent_ways = std::max(now.ways, before.ways);
  const double lost =
      before.stored - now.stored - now.dissipated - 0.5 * step->elapsed * (before.damping_power + now.damping_power);
  to.owed[patch] += now.work - lost;
  if (view.patch.corners && reach_of(view.patch.law) > 0) now.at_corners = now.jump = now.work - lost;
  if (!view.patch.is_integrated()) return now;
  if (now.contacts > 0) {
    to.owed[patch] -= repay(to.owed[patch], most_repaid_, 1, view.patch, before, forces, now);
  } else if (std::abs(to.owed[patch]) > 0) {
    // What is left when a pair parts: by the forces of a law that still reaches it.
    Patch near = view.patch;
    near.law = parting_law(near.law, skin_);
    PatchTotals parting =
        compute_patch({model_, view.outlines, near, skin_, view.window, view.elapsed}, &way, from, to, forces);
    to.owed[patch] -= repay(to.owed[patch], most_repaid_, 0, near, before, forces, parting);
    now.ways = parting.ways;
  }
  return now;
}

}  // namespace pliant
