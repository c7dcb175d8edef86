#include "reference/contact/law.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

// ---- energies per area, by (gap, slip, damage, elastic slip of friction)

using Energy = Jet<4>;

Energy squared(const Energy& x) { return x * x; }

/// Zero without contact. p = kn x^2 / (2 w) for penetrations x < w, then kn (x - w / 2).
Energy penalty(const Energy& gap, double kn, double w) {
  const Energy x = -gap;
  if (x.value <= 0) return 0;
  if (x.value < w) return kn / (6 * w) * x * x * x;
  return kn * (w * w / 6 + (x * x - w * x) / 2);
}

/// p = - kn g up to `reach`, and zero beyond.
Energy cut_off(const Energy& gap, double kn, double reach) { return kn / 2 * (squared(gap) - reach * reach); }

/// p = - kn g up to the strength, then linear to zero at `reach`.
Energy adhesion(const Energy& gap, double kn, double strength, double reach) {
  const double critical = strength / kn, fall = reach - critical;
  if (gap.value > critical) return -strength / (2 * fall) * squared(reach - gap);
  return kn / 2 * (squared(gap) - critical * critical) - strength * fall / 2;
}

Energy normal_energy(const Law& law, const Energy& gap) {
  switch (law.kind) {
    case ContactLawKind::frictionless:
      return penalty(gap, law.kn, law.start);
    case ContactLawKind::mohr_coulomb:
      return law.start > 0 ? penalty(gap, law.kn, law.start) : cut_off(gap, law.kn, law.reach);
    case ContactLawKind::cohesive:
      return adhesion(gap, law.kn, law.strength, law.reach);
    case ContactLawKind::cohesive_fatigue:
      return adhesion(gap, law.kn, law.residual_strength, law.reach);
  }
  return 0;
}

/// Energy of surfaces that slide, or stick by friction.
Energy sliding_energy(const Law& law, const Energy& gap, const Energy& slip) {
  return normal_energy(law, gap) + law.kt / 2 * squared(slip);
}

/// Energy of a bond: an intact share, and broken surfaces in the share of the damage.
Energy bond_energy(const Law& law, const Energy& gap, const Energy& slip, const Energy& damage, const Energy& elastic) {
  const Energy whole = law.kn / 2 * squared(gap) + law.kt / 2 * squared(slip);
  return (1 - damage) * whole + damage * sliding_energy(law, gap, elastic);
}

// ---- slip and damage from gap and slip increment

using Variable = Jet<2>;

struct Internal {
  Variable slip = 0, damage = 1;  ///< of a bond
  Variable elastic = 0;           ///< slip of broken surfaces
};

/// - d psi / d g. Its second derivatives are omitted, because they are not needed.
Variable pressure(const Law& law, const Variable& gap) {
  const Energy psi = normal_energy(law, Energy(gap.value, 0));
  return gap.chained(-psi.gradient[0], -psi.hessian(0, 0), 0);
}

Variable tapered(const Variable& gap, double limit, double strength, const Law& law) {
  const double critical = strength / law.kn;
  return gap.value > critical ? limit / (law.reach - critical) * (law.reach - gap) : Variable(limit);
}

}  // namespace

Variable shear_limit(const Law& law, const Variable& gap) {
  const Variable p = pressure(law, gap);
  const Variable frictional = p.value > 0 ? law.friction * p : Variable(0);
  switch (law.kind) {
    case ContactLawKind::frictionless:
      return 0;
    case ContactLawKind::mohr_coulomb:
      return law.cohesion + frictional;
    case ContactLawKind::cohesive:
      return tapered(gap, law.shear_strength, law.strength, law);
    case ContactLawKind::cohesive_fatigue:
      return tapered(gap, law.residual_strength / law.ratio, law.residual_strength, law) + frictional;
  }
  return 0;
}

namespace {

/// Elastic slip after the return mapping.
Variable slide(const Law& law, const Variable& gap, const Variable& trial) {
  if (!law.shears()) return 0;
  const Variable largest = shear_limit(law, gap) / law.kt;
  return trial > largest ? largest : trial < -largest ? -largest : trial;
}

/// Damage by the largest opening and slip so far.
Variable static_damage(const Law& law, const Variable& opening, const Variable& slip) {
  const Variable square = opening * opening + slip * slip / (law.ratio * law.ratio);
  const double critical = law.strength / law.kn;
  if (square.value <= critical * critical) return 0;
  const Variable together = sqrt(square);
  return law.reach / (law.reach - critical) * (1 - critical / together);
}

/// Integral of rate (p - threshold) / (strength - threshold) dp over the part of the path from p_old to p on which p
/// grows above the threshold.
Variable wear(const Law& law, double rate, double p_old, const Variable& p) {
  const double from = std::max(p_old, law.threshold);
  if (rate == 0 || p.value <= from) return 0;
  const double before = from - law.threshold;
  const Variable after = p - law.threshold;
  return rate / (2 * (law.strength - law.threshold)) * (after * after - before * before);
}

/// Bond with updated damage. `elastic`: slip of broken surfaces. Damage turns the energy of the bond into that of
/// friction, and must not add energy.
Internal hold(const Law& law, const ContactMemory& memory, const Variable& gap, const Variable& motion,
              const Variable& elastic) {
  const Variable slip = memory.slip + motion, opening = gap.value > 0 ? gap : Variable(0);
  const double whole = law.kn * opening.value * opening.value + law.kt * slip.value * slip.value,
               broken = law.kt * elastic.value * elastic.value;
  if (broken > whole * (1 + 1e-9)) return {slip, memory.damage, elastic};
  const double stiffness = law.kn * (1 - memory.damage), shear_stiffness = law.kt * law.ratio * (1 - memory.damage);
  const Variable size = slip.value < 0 ? -slip : slip;
  const Variable worn =
      memory.damage + wear(law, law.rate, stiffness * memory.opening, stiffness * opening) +
      wear(law, law.shear_rate / law.ratio, shear_stiffness * std::abs(memory.slip), shear_stiffness * size);
  const Variable sudden = static_damage(law, opening, slip), damage = worn > sudden ? worn : sudden;
  return {slip, damage.value < 1 ? damage : Variable(1), elastic};
}

// ---- energy balance: work of the mean traction of a step, less the increase of the stored energy

double bond_loss(const Law& law, const ContactMemory& memory, double opening, double slip, double damage) {
  return (damage - memory.damage) / 2 * (law.kn * memory.opening * opening + law.kt * memory.slip * slip);
}

/// Loss of the broken share, with damage `before` and then `damage`: work of its mean traction, less the stored energy.
/// Exactly 0 if it sticks and the damage stays.
double sliding_loss(const Law& law, double before, double damage, double old_slip, double slip, double motion) {
  const double slid = old_slip + motion - slip;
  return law.kt / 2 * ((before * old_slip + damage * slip) * slid - (damage - before) * old_slip * slip);
}

/// The energy of residual adhesion is negative, so the energy that damage turns into it is lost.
double adhesion_loss(const Law& law, const ContactMemory& memory, double opening, double damage) {
  const auto energy = [&](double gap) { return normal_energy(law, std::min(gap, law.reach)).value; };
  const double energies = energy(memory.opening) + energy(opening);
  return -(damage - memory.damage) / 2 * energies;
}

// ---- together

void add_tractions(const Energy& psi, const Internal& now, Response& response) {
  const Response::Gradient by_gap(1, 0);
  const auto along_the_path = [&](int row) -> Response::Gradient {
    return psi.hessian(row, 0) * by_gap + psi.hessian(row, 1) * now.slip.gradient +
           psi.hessian(row, 2) * now.damage.gradient + psi.hessian(row, 3) * now.elastic.gradient;
  };
  response.stored = psi.value;
  response.pressure = -psi.gradient[0];
  response.pressure_by = -along_the_path(0);
  response.shear = psi.gradient[1] + psi.gradient[3];
  response.shear_by = along_the_path(1) + along_the_path(3);
}

}  // namespace

Response respond(const Law& law, const ContactMemory& memory, double gap, double motion, bool initial) {
  const Variable g(gap, 0), m(motion, 1);
  const bool bonded = law.bonds() && memory.damage < 1;
  const double old_elastic = bonded ? memory.friction_slip : memory.slip;
  const Variable elastic = slide(law, g, old_elastic + m);
  Internal now{0, 1, elastic};
  if (bonded) now = initial ? Internal{0, memory.damage, elastic} : hold(law, memory, g, m, elastic);
  const bool holds = bonded && now.damage.value < 1;
  const Energy by_gap(gap, 0), by_elastic(now.elastic.value, 3);
  Response response;
  add_tractions(holds ? bond_energy(law, by_gap, Energy(now.slip.value, 1), Energy(now.damage.value, 2), by_elastic)
                      : sliding_energy(law, by_gap, by_elastic),
                now, response);
  response.slip = holds ? now.slip.value : now.elastic.value;
  response.friction_slip = holds ? now.elastic.value : 0;
  response.damage = now.damage.value;
  response.opening = bonded ? std::max(gap, 0.0) : 0;
  if (initial) return response;
  response.dissipated = sliding_loss(law, memory.damage, now.damage.value, old_elastic, now.elastic.value, motion);
  if (bonded)
    response.dissipated += bond_loss(law, memory, response.opening, memory.slip + motion, now.damage.value) +
                           adhesion_loss(law, memory, response.opening, now.damage.value);
  return response;
}

double parting_loss(const Law& law, const ContactMemory& memory, std::optional<double> gap) {
  if (memory.damage >= 1) return law.kt / 2 * memory.slip * memory.slip;
  const double opening = gap ? std::max(*gap, 0.0) : memory.opening;
  const double adhesion = gap ? adhesion_loss(law, memory, opening, 1) : 0;
  return bond_loss(law, memory, opening, memory.slip, 1) +
         law.kt / 2 * memory.damage * memory.friction_slip * memory.friction_slip + adhesion;
}

}  // namespace pliant::reference
