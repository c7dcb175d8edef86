#include "contact/energy_correction.hpp"

#include <algorithm>

#include "contact/contact.hpp"
#include "contact/pair_forces.hpp"
#include "contact/pair_table.hpp"

namespace pliant {

void carry_forces(const Model& model, const ContactPair& old, const PairForceBuffer& from, const ContactPair& now,
                  PairForceBuffer& to) {
  thread_local PairForceBuffer aside[2];  // memory is allocated once
  for (int side = 0; side < 2; ++side) {
    const int begin = old.entry[side], end = begin + old.forces(side).count;
    aside[side].x.assign(from.x.begin() + begin, from.x.begin() + end);
    aside[side].y.assign(from.y.begin() + begin, from.y.begin() + end);
  }
  for (int side = 0; side < 2; ++side) {
    double *x = &to.x[now.entry[side]], *y = &to.y[now.entry[side]];
    std::fill_n(x, padded(now.forces(side).count), 0.0);
    std::fill_n(y, padded(now.forces(side).count), 0.0);
    // Both arcs of a small body may go all the way around and contain some nodes twice: forces at both positions are
    // added.
    for_each_shared(model, now, side, now.forces(side), old.forces(side), [&](int at, int before, int count) {
      for (int i = 0; i < count; ++i) x[at + i] += aside[side].x[before + i], y[at + i] += aside[side].y[before + i];
    });
  }
}

double relative_correction(double error, double share, const PairTotals& now, double work_before) {
  const double square = std::max(now.work * now.work, work_before * work_before);
  if (square == 0 || now.traction_norm == 0) return 0;
  const double limit = share / now.traction_norm;
  return -std::clamp(error / square, -limit, limit) * now.work;
}

void scale_forces(const ContactPair& contact_pair, double factor, PairForceBuffer& forces) {
  if (factor == 1) return;
  for (int side = 0; side < 2; ++side)
    for (int i = contact_pair.entry[side]; i < contact_pair.entry[side] + padded(contact_pair.forces(side).count);
         i += lane_count)
      for (double* force : {&forces.x[i], &forces.y[i]}) store(force, factor * load(force));
}

ContactLaw parting_law(const ContactLaw& law, double skin) {
  const double stiffness = normal_stiffness_of(law), reach = reach_of(law) + skin;
  constexpr double rises = 0.1;  // share of the reach over which the tension rises
  return Cohesive{stiffness, stiffness, reach, rises * reach * stiffness, 0};
}

/// Computes the forces of a contact pair after a step with the correction of its energy error, and updates that error.
/// Without a step it applies the stored correction again.
PairTotals ContactSystem::corrected_forces(const PairView& view, int contact_pair, const StepStart* step,
                                           const ContactHistory& from, ContactHistory& to) const {
  double &energy_error = to.energy_error[contact_pair] = from.energy_error[contact_pair],
         &correction = to.correction[contact_pair] = from.correction[contact_pair];
  const PairTotals& before = from.last.totals[contact_pair];
  // Parts of a body with self-contact change with a search.
  const bool known =
      step && from.last.dt > 0 && (!view.contact_pair.of_itself() || view.contact_pair.found <= from.last.refreshes);
  const auto rigid = [&](int side) {
    const int number = model_.bodies[view.body(side)].rigid;
    return known && step->rigid && number >= 0 ? &step->rigid[number] : nullptr;
  };
  const PairStep pair_step{
      known ? &step->position : nullptr, from.last.forces, {rigid(0), rigid(1)}, view.dt, from.last.dt};
  const auto compute = [&](const PairView& as) {
    return compute_pair(as, known ? &pair_step : nullptr, from, to, to.last.forces);
  };
  // The error that is left when a pair separates is corrected by the forces of a law that still reaches it.
  const auto compute_apart = [&] {
    ContactPair near = view.contact_pair;
    near.law = parting_law(near.law, skin_);
    return compute(PairView{model_, view.outlines, near, skin_, view.window, view.dt});
  };

  PairTotals now, correcting;
  // For a pair that was apart these forces also show whether it still is.
  const bool was_apart = known && energy_error != 0 && before.contacts == 0 && reach_of(view.contact_pair.law) == 0;
  if (was_apart) correcting = compute_apart();
  const bool still_apart = was_apart && correcting.deepest == 0;
  if (still_apart)
    now.work_before = correcting.work_before, now.step_change = correcting.step_change;
  else
    now = compute(view);
  // The work of a dashpot depends on the step size: the difference is not an energy error.
  if (is_damped(view.contact_pair.law)) return now;
  if (known) energy_error += kinetic_energy_gain(now) - (before.stored - now.stored - now.dissipated);
  if (now.contacts > 0) {
    if (step)
      correction = relative_correction(energy_error, largest_correction_, now, before.contacts > 0 ? before.work : 0);
    scale_forces(view.contact_pair, 1 + correction, to.last.forces);
  } else if (energy_error != 0 || still_apart) {
    if (!still_apart) correcting = compute_apart();
    now.work = correcting.work;
    if (step && correcting.contacts > 0 && is_rounding(energy_error, correcting)) energy_error = 0;
    if (step) correction = relative_correction(energy_error, largest_correction_, correcting);
    scale_forces(view.contact_pair, correction, to.last.forces);
  }
  if (known) energy_error += 0.5 * correction * now.work;
  return now;
}

}  // namespace pliant
