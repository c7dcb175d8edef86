#include "contact/contact.hpp"
#include "contact/patch_forces.hpp"

namespace pliant {

/// Forces of a patch after a step in which it repays some of what it owes, and what it owes then. Without a step it
/// finds again what it repaid.
PatchTotals ContactSystem::settle(const PatchView& view, int patch, const StepStart* step, const ContactHistory& from,
                                  ContactHistory& to, PatchForces& forces) {
  double &owed = to.owed[patch] = from.owed[patch], &repaid = to.repaid[patch] = from.repaid[patch];
  const PatchTotals& before = last_.totals[patch];
  // Parts of a body that touches itself are others after a search.
  const bool known = step && last_.number > 0 && last_.number == from.evaluation &&
                     (!view.patch.of_itself() || view.patch.found <= last_.refreshes);
  const auto rigid = [&](int side) {
    const int number = model_.bodies[view.body(side)].rigid;
    return known && number >= 0 ? &step->rigid[number] : nullptr;
  };
  const PatchStep way{known ? &step->position : nullptr, last_.forces, {rigid(0), rigid(1)}};
  const auto compute = [&](const PatchView& as) { return compute_patch(as, known ? &way : nullptr, from, to, forces); };
  // What is left when a pair parts is repaid by the forces of a law that still reaches it.
  const auto compute_apart = [&] {
    Patch near = view.patch;
    near.law = parting_law(near.law, skin_);
    return compute(PatchView{model_, view.outlines, near, skin_, view.window, view.elapsed});
  };

  PatchTotals now, repaying;
  // Of a pair that was apart these forces tell as well whether it still is.
  const bool was_apart = known && owed != 0 && before.contacts == 0 && reach_of(view.patch.law) == 0;
  if (was_apart) repaying = compute_apart();
  const bool still_apart = was_apart && repaying.deepest == 0;
  if (still_apart)
    now.work_before = repaying.work_before, now.pull = repaying.pull;
  else
    now = compute(view);
  // What a dashpot takes depends on the step: what it seems to owe, it does not.
  if (is_damped(view.patch.law)) return now;
  if (known) owed += gain(now, step->elapsed, last_.elapsed) - (before.stored - now.stored - now.dissipated);
  if (now.contacts > 0) {
    if (step) repaid = repayment(owed, most_repaid_, now, before.contacts > 0 ? before.work : 0);
    scale_forces(view.patch, 1 + repaid, forces);
  } else if (owed != 0 || still_apart) {
    if (!still_apart) repaying = compute_apart();
    now.work = repaying.work;
    if (step && repaying.contacts > 0 && is_rounding(owed, repaying)) owed = 0;
    if (step) repaid = repayment(owed, most_repaid_, repaying);
    scale_forces(view.patch, repaid, forces);
  }
  if (known) owed += 0.5 * repaid * now.work;
  return now;
}

}  // namespace pliant
