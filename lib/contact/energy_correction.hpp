#pragma once

#include <algorithm>
#include <cmath>

#include "contact/contact_pair.hpp"
#include "contact/history.hpp"

namespace pliant {

/// Energy correction of contact pairs (docs/method.md 6, equations (44) to (48)). In a step of velocity Verlet the
/// kinetic energy grows by the mean of the forces at its ends times the displacements, except for a reversible term. If
/// contact forces change smoothly, contacts lose just as much energy. They do not if a node passes to a segment with
/// another normal, or passes a kink of its law, as at the onset or the end of contact. The difference is the energy
/// error d of the pair, J/m, positive if the bodies gained energy. The contact forces f of the following steps correct
/// it. They are multiplied by 1 - chi W1, where W1 is their work over the step's displacements. This removes chi W1^2,
/// half in this step and half in the next.

/// Upper bound b of the dashpot chi f f^T relative to the stiffness K of the contacts: chi <= b/S, because f K^-1 f is
/// at most S, PairTotals::traction_norm. The correction is small compared with the error that a step makes at
/// contacts anyway. It vanishes at rest and in short steps. The dashpot uses the displacement of the step that led to
/// it. With a = w^2 dt^2, x+ - 2 x + x- + a x + a b (x - x-) = 0 is critically damped by b = 2/sqrt(a) - 1, and a is 4
/// safety^2 at most. A larger b damps that mode less, and none of it at the limit of stability, a (1 + 2 b) = 4. Below
/// safety 0.8 b stays 1/4, so that the correction remains small.
inline double largest_correction(double safety) { return std::clamp(1 / safety - 1, 0.0, 0.25); }

/// Motion of a rigid body in a step.
struct RigidStep {
  Vec2 from, to;  ///< centre at the start and the end, m
  double turn;    ///< rotation, rad
  /// Accelerations by the forces at the start of the step, and by those there that ended the previous step: x, y, m/s2,
  /// and rotation, 1/s2. They differ where loads jump and where a motion is let go.
  double acceleration[3], acceleration_before[3];
};

/// The step that led to an evaluation, as a contact pair sees it.
struct PairStep {
  const OutlineField* before;            ///< outlines at the start, with their cyclic copies
  const PairForceBuffer& forces_before;  ///< at the start
  const RigidStep* rigid[2];             ///< by side; null: compliant
  double dt, dt_before;                  ///< sizes of this step and of the previous one, s
};

/// Kinetic energy that the present and the previous forces add in a step, J/m, without dt^2 F^2/(8 m). That term is
/// reversible unless the step size changes, or forces jump; then the energy that rigid bodies keep counts. Compliant
/// bodies account for it themselves (lib/dynamics/body_energy_correction.hpp).
inline double kinetic_energy_gain(const PairTotals& now) {
  return 0.5 * (now.work_before + now.work) + now.step_change;
}

/// Transfers the forces of a contact pair that was searched or stored again to the present entries of its nodes.
void carry_forces(const Model& model, const ContactPair& old, const PairForceBuffer& from, const ContactPair& now,
                  PairForceBuffer& to);

/// Relative change -chi W1 of a contact pair's forces that corrects an energy error, J/m, with chi <= `share`/S.
/// `work_before`: work of the same law's forces in the last step. The larger work counts, because where the motion
/// reverses the next displacement may be many times this one.
double relative_correction(double error, double share, const PairTotals& now, double work_before = 0);
/// Whether the energy error is so small that it may be rounding of energies. Each correction removes about half of the
/// error, which would never end. `now`: totals of parting_law(), whose gaps are about half a spacing.
inline bool is_rounding(double error, const PairTotals& now) { return std::abs(error) < 1e-15 * now.traction_norm; }
void scale_forces(const ContactPair& contact_pair, double factor, PairForceBuffer& forces);
/// Law whose forces correct the energy error after a pair has separated, up to a skin beyond its own law's reach. Their
/// magnitude does not matter.
ContactLaw parting_law(const ContactLaw& law, double skin);

}  // namespace pliant
