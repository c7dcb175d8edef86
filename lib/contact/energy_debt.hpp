#pragma once

#include <algorithm>
#include <cmath>

#include "contact/history.hpp"
#include "contact/patch.hpp"

namespace pliant {

/// In a step of velocity Verlet the kinetic energy grows by the mean of the forces at its ends times the way, but for a
/// term that comes back. Where contact forces change smoothly, that is what contacts lose. Where a node goes from a
/// segment to the next, whose normal is another, or over a kink of its law, as where contact sets in or ends, it is
/// not, and contacts heat or cool. The difference is a debt of the two bodies, J/m, positive where they gained, which
/// their contacts repay in the steps that follow by pressures against the ways of their gaps (docs/method.md 6).

/// The pressure over what the stiffness makes of the way, at most: little beside what a step does to contacts anyway,
/// nothing at rest, and nothing where steps are short. It acts as a dashpot that sees the way of the step before: with
/// w^2 dt^2 = a and a share b of the stiffness, x+ - 2 x + x- + a x + a b (x - x-) = 0 is stable up to a (1 + 2 b) = 4,
/// and a is 4 safety^2 at most. A share that changes its sign from step to step can feed such a motion well below that;
/// with nine tenths of it no contact at rest was seen to flicker, with all of it one was (docs/defaults.md).
inline double most_repaid(double safety) { return std::clamp(0.5 * (0.9 / (safety * safety) - 1), 0.0, 0.25); }
/// What bodies have lost is given back while it is less than so many times kn times PatchTotals::ways: more would shake
/// what all but stands still. A touch that begins or ends leaves an eighth at most, a pull that breaks off at a gap of
/// twenty ways ten.
constexpr double most_given_back = 10;
/// The least pressure over what the stiffness makes of the way: below, bodies that have parted are even, and what they
/// still owe waits for their next touch.
constexpr double least_repaid = 1e-12;

/// Of a patch, the step that led to an evaluation, if any did: another finds again what was repaid.
struct PatchStep {
  const OutlineField* before;        ///< outlines at its start, with their copies; null: not known
  const PatchForces* forces_before;  ///< then
  /// J/m, then, less PatchTotals::pending: a pressure acts in two steps, half in each.
  double debt;
  /// PatchTotals::recent_ways: where gaps turn back, the next way may be many times the last. 0: not known.
  double ways;
  double most;  ///< most_repaid()
  bool moves;   ///< there is a step

  /// Pressure over way, Pa/m.
  double resistance(double stiffness) const {
    if (ways <= 0 || -debt > most_given_back * stiffness * ways) return 0;
    const double wanted = debt / ways;
    return std::abs(wanted) < least_repaid * stiffness ? 0 : std::clamp(wanted, -most * stiffness, most * stiffness);
  }
};

/// The forces of a patch that was searched or laid out anew go with its nodes to where they stand now.
void carry_forces(const Model& model, const Patch& old, const PatchForces& from, const Patch& now, PatchForces& to);

/// A pair whose contact is integrated repays by its own forces F: they become 1 - c W times what they were, with W
/// their work over the way of the step, which takes c W^2, half in this step and half in the next. This is a dashpot c
/// F F^T, and at most the share `most` of the stiffness K of its contacts if c F K^-1 F is not more, which is c times
/// PatchTotals::squares. `stays`: 1, or 0 where these forces are there to repay alone. Returns what it takes in the
/// step at hand, J/m.
double repay(double debt, double most, double stays, const Patch& patch, const PatchTotals& totals_before,
             PatchForces& forces, PatchTotals& totals);
/// The law whose forces repay after a pair has parted, as far as a skin beyond its own law's reach. Of no account is
/// their size.
ContactLaw parting_law(const ContactLaw& law, double skin);

/// What contacts of a patch repay, from one history into another: from their first touch on until they are even or out
/// of sight, as the step that parts them leaves a debt as well.
class Repayment {
 public:
  Repayment(const PatchStep& step, double stiffness)
      : moves_(step.moves),
        resistance_(step.resistance(stiffness)),
        lingers_(!moves_ || resistance_ != 0 ? ~LaneBits{} : LaneBits{}) {}

  /// Which of eight nodes beside the master act, by what the history has of them.
  LaneBits acting(const Lanes* from, LaneBits beside, LaneBits touching) const {
    const Lanes before = from[ContactHistory::gap];
    return beside & (touching | (lingers_ & (before == before)));
  }
  /// Their pressure, Pa.
  Lanes pressure(const Lanes* from, Lanes* to, Lanes gap, LaneBits acting, Lanes half_length) {
    const Lanes before = from[ContactHistory::gap];
    Lanes repaid = from[ContactHistory::repaid];
    if (moves_) {
      const Lanes way = select(acting & (before == before), before - gap, Lanes{});
      ways_ += half_length * way * way;
      repaid = resistance_ * way;
    }
    to[ContactHistory::gap] = select(acting, gap, broadcast(ContactHistory::nowhere));
    to[ContactHistory::repaid] = repaid;
    return repaid;
  }
  void forget(Lanes* to) const {
    to[ContactHistory::gap] = broadcast(ContactHistory::nowhere);
    to[ContactHistory::repaid] = Lanes{};
  }
  double ways() const { return sum(ways_); }
  double pending() const { return 0.5 * resistance_ * sum(ways_); }

 private:
  bool moves_;
  double resistance_;
  LaneBits lingers_;  ///< all or none: those act that touched once
  Lanes ways_{};
};

}  // namespace pliant
