#include "contact/energy_correction.hpp"

#include <algorithm>

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

double relative_correction(double error, double most, const PairTotals& now, double work_before) {
  const double square = std::max(now.work * now.work, work_before * work_before);
  if (square == 0 || now.squares == 0) return 0;
  const double limit = most / now.squares;
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

}  // namespace pliant
