#include "reference/contact/law.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

// ---- energies per area, by (gap, slip, damage)

using Energy = Jet<3>;

Energy squared(const Energy& x) { return x * x; }

/// Zero without touch. p = kn x^2 / (2 w) for penetrations x < w, then kn (x - w / 2).
Energy penalty(const Energy& gap, double kn, double w) {
  const Energy x = -gap;
  if (x.value <= 0) return 0;
  if (x.value < w) return kn / (6 * w) * x * x * x;
  return kn * (w * w / 6 + (x * x - w * x) / 2);
}

/// p = - kn g as far as `reach`, and nothing beyond.
Energy cut_off(const Energy& gap, double kn, double reach) { return kn / 2 * (squared(gap) - reach * reach); }

/// p = - kn g up to the strength, from there on straight to zero at `reach`.
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

/// Of surfaces that slide, or stick by friction.
Energy sliding_energy(const Law& law, const Energy& gap, const Energy& slip) {
  return normal_energy(law, gap) + law.kt / 2 * squared(slip);
}

Energy bond_energy(const Law& law, const Energy& gap, const Energy& slip, const Energy& damage) {
  const Energy opening = gap.value > 0 ? gap : Energy(0);
  return penalty(gap, law.kn, 0) + (1 - damage) / 2 * (law.kn * squared(opening) + law.kt * squared(slip));
}

// ---- how slip and damage follow from gap and motion

using Variable = Jet<2>;

struct Internal {
  Variable slip = 0, damage = 1;
};

/// - d psi / d g. Its second derivatives are left out: nobody asks for them.
Variable pressure(const Law& law, const Variable& gap) {
  const Energy psi = normal_energy(law, Energy(gap.value, 0));
  return gap.chained(-psi.gradient[0], -psi.hessian(0, 0), 0);
}

Variable tapered(const Variable& gap, double limit, double strength, const Law& law) {
  const double critical = strength / law.kn;
  return gap.value > critical ? limit / (law.reach - critical) * (law.reach - gap) : Variable(limit);
}

/// Largest shear traction.
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

Internal slide(const Law& law, const ContactMemory& memory, const Variable& gap, const Variable& motion) {
  Internal now;
  if (!law.shears()) return now;
  const Variable trial = memory.slip + motion, largest = shear_limit(law, gap) / law.kt;
  now.slip = trial > largest ? largest : trial < -largest ? -largest : trial;
  return now;
}

/// Damage of the largest opening and slip so far.
Variable static_damage(const Law& law, const Variable& opening, const Variable& slip) {
  const Variable square = opening * opening + slip * slip / (law.ratio * law.ratio);
  const double critical = law.strength / law.kn;
  if (square.value <= critical * critical) return 0;
  const Variable together = sqrt(square);
  return law.reach / (law.reach - critical) * (1 - critical / together);
}

/// Integral of rate (p - threshold) / (strength - threshold) dp over the part of the way from p_old to p on which p
/// grows above the threshold.
Variable wear(const Law& law, double rate, double p_old, const Variable& p) {
  const double from = std::max(p_old, law.threshold);
  if (rate == 0 || p.value <= from) return 0;
  const double before = from - law.threshold;
  const Variable after = p - law.threshold;
  return rate / (2 * (law.strength - law.threshold)) * (after * after - before * before);
}

Internal hold(const Law& law, const ContactMemory& memory, const Variable& gap, const Variable& motion) {
  const Variable slip = memory.slip + motion, opening = gap.value > 0 ? gap : Variable(0);
  const double stiffness = law.kn * (1 - memory.damage), shear_stiffness = law.kt * law.ratio * (1 - memory.damage);
  const Variable size = slip.value < 0 ? -slip : slip;
  const Variable worn =
      memory.damage + wear(law, law.rate, stiffness * memory.opening, stiffness * opening) +
      wear(law, law.shear_rate / law.ratio, shear_stiffness * std::abs(memory.slip), shear_stiffness * size);
  const Variable sudden = static_damage(law, opening, slip), damage = worn > sudden ? worn : sudden;
  return {slip, damage.value < 1 ? damage : Variable(1)};
}

// ---- books: what the mean traction of a step does along it, less what is then stored more

double bond_loss(const Law& law, const ContactMemory& memory, double opening, double slip, double damage) {
  return (damage - memory.damage) / 2 * (law.kn * memory.opening * opening + law.kt * memory.slip * slip);
}

double sliding_loss(const Law& law, const ContactMemory& memory, double motion, double slip) {
  return law.kt / 2 * (memory.slip + slip) * (memory.slip + motion - slip);
}

/// A bond tears. Surfaces with the residual adhesion take its place at this gap.
double tearing_loss(const Law& law, const ContactMemory& memory, double gap, double motion) {
  return bond_loss(law, memory, std::max(gap, 0.0), memory.slip + motion, 1) + penalty(gap, law.kn, 0).value -
         normal_energy(law, gap).value;
}

// ---- together

void add_tractions(const Energy& psi, const Internal& now, Response& response) {
  const Response::Gradient by_gap(1, 0);
  const auto along_the_path = [&](int row) -> Response::Gradient {
    return psi.hessian(row, 0) * by_gap + psi.hessian(row, 1) * now.slip.gradient +
           psi.hessian(row, 2) * now.damage.gradient;
  };
  response.stored = psi.value;
  response.pressure = -psi.gradient[0];
  response.pressure_by = -along_the_path(0);
  response.shear = psi.gradient[1];
  response.shear_by = along_the_path(1);
}

}  // namespace

Response respond(const Law& law, const ContactMemory& memory, double gap, double motion, bool initial) {
  const Variable g(gap, 0), m(motion, 1);
  const Energy by_gap(gap, 0);
  const bool bonded = law.bonds() && memory.damage < 1;
  Response response;
  Internal now;
  if (bonded) now = initial ? Internal{0, memory.damage} : hold(law, memory, g, m);
  if (bonded && now.damage.value < 1) {
    add_tractions(bond_energy(law, by_gap, Energy(now.slip.value, 1), Energy(now.damage.value, 2)), now, response);
    response.opening = std::max(gap, 0.0);
    if (!initial) response.dissipated = bond_loss(law, memory, response.opening, now.slip.value, now.damage.value);
  } else {
    now = bonded ? Internal{} : slide(law, memory, g, m);  // torn surfaces start without slip
    add_tractions(sliding_energy(law, by_gap, Energy(now.slip.value, 1)), now, response);
    response.dissipated =
        bonded ? tearing_loss(law, memory, gap, motion) : sliding_loss(law, memory, motion, now.slip.value);
  }
  response.slip = now.slip.value;
  response.damage = now.damage.value;
  return response;
}

double parting_loss(const Law& law, const ContactMemory& memory, std::optional<double> gap) {
  if (memory.damage < 1) return bond_loss(law, memory, gap ? std::max(*gap, 0.0) : memory.opening, memory.slip, 1);
  return law.kt / 2 * memory.slip * memory.slip;
}

}  // namespace pliant::reference
