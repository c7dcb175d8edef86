#pragma once

#include <algorithm>
#include <cmath>

#include "contact/contact_pair.hpp"
#include "contact/history.hpp"

namespace pliant {

/// In a step of velocity Verlet the kinetic energy grows by the mean of the forces at its ends times the way, but for a
/// term that comes back. Where contact forces change smoothly, that is what contacts lose. Where a node goes from a
/// segment to the next, whose normal is another, or over a kink of its law, as where contact sets in or ends, it is
/// not, and contacts heat or cool. The difference is a debt of the two bodies, J/m, positive where they gained, which
/// they repay in the steps that follow by the forces of their contact (docs/method.md 6): these, F, become 1 - c W
/// times what they were, with W their work over the way of the step, which takes c W^2, half in this step and half in
/// the next.

/// The dashpot c F F^T over the stiffness K of the contacts, at most: little beside what a step does to contacts
/// anyway, nothing at rest, and nothing where steps are short. c F K^-1 F is c times PairTotals::squares. The dashpot
/// sees the way of the step before: with w^2 dt^2 = a and a share b of the stiffness, x+ - 2 x + x- + a x + a b (x -
/// x-) = 0 is stable up to a (1 + 2 b) = 4, and a is 4 safety^2 at most. A share that changes its sign from step to
/// step can feed such a motion well below that; with nine tenths of it no contact at rest was seen to flicker, with all
/// of it one was (docs/defaults.md).
inline double most_repaid(double safety) { return std::clamp(0.5 * (0.9 / (safety * safety) - 1), 0.0, 0.25); }

/// A rigid body in a step.
struct RigidStep {
  Vec2 from, to;             ///< its centre, m
  double turn;               ///< rad
  Vec2 acceleration;         ///< by forces at the start, m/s2
  double spin_acceleration;  ///< likewise, 1/s2
};

/// Of a contact pair, the step that led to an evaluation.
struct PairStep {
  const OutlineField* before;            ///< outlines at its start, with their copies
  const PairForceBuffer& forces_before;  ///< then
  const RigidStep* rigid[2];             ///< by side; null: compliant
};

/// What the kinetic energy grows by in a step by these forces and those before, J/m, but for dt^2 F^2/(8 m), which
/// comes back unless the step changes: what it then keeps of rigid bodies counts. Compliant ones keep books of it.
/// `before`: the step before, s.
inline double gain(const PairTotals& now, double dt, double before) {
  return 0.5 * (now.work_before + now.work) - 0.125 * (dt * dt - before * before) * now.pull;
}

/// The forces of a contact pair that was searched or laid out anew go with its nodes to where they stand now.
void carry_forces(const Model& model, const ContactPair& old, const PairForceBuffer& from, const ContactPair& now,
                  PairForceBuffer& to);

/// What forces of a contact pair are multiplied by to repay a debt, J/m: -c W. `work_before`: of the same law's forces
/// in the last step. Where motions turn back, the next way may be many times this one.
double repayment(double debt, double most, const PairTotals& now, double work_before = 0);
/// Whether so little is owed that it may be the rounding of energies: each settlement halves a debt or so, which would
/// never end. `now`: of parting_law(), whose gaps are those of half a spacing or so.
inline bool is_rounding(double debt, const PairTotals& now) { return std::abs(debt) < 1e-15 * now.squares; }
void scale_forces(const ContactPair& contact_pair, double factor, PairForceBuffer& forces);
/// The law whose forces repay after a pair has parted, as far as a skin beyond its own law's reach. Of no account is
/// their size.
ContactLaw parting_law(const ContactLaw& law, double skin);

}  // namespace pliant
