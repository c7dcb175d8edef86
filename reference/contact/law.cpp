#include "reference/contact/law.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

/// Energy per area, by gap and slip.
using Energy = Jet<2>;

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
  }
  return 0;
}

/// A variable by gap and slip increment.
using Variable = Jet<2>;

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

}  // namespace

Response respond(const Law& law, double old_slip, double gap, double motion) {
  const Variable slip = slide(law, Variable(gap, 0), old_slip + Variable(motion, 1));
  const Energy psi = normal_energy(law, Energy(gap, 0)) + law.kt / 2 * squared(Energy(slip.value, 1));
  const auto along_the_path = [&](int row) -> Response::Gradient {
    return psi.hessian(row, 0) * Response::Gradient(1, 0) + psi.hessian(row, 1) * slip.gradient;
  };
  Response response;
  response.stored = psi.value;
  response.pressure = -psi.gradient[0];
  response.pressure_by = -along_the_path(0);
  response.shear = psi.gradient[1];
  response.shear_by = along_the_path(1);
  response.slip = slip.value;
  // Work of the mean traction of a step, less the increase of the stored energy. Exactly 0 if it sticks.
  response.dissipated = law.kt / 2 * (old_slip + slip.value) * (old_slip + motion - slip.value);
  return response;
}

double parting_loss(const Law& law, double slip) { return law.kt / 2 * slip * slip; }

}  // namespace pliant::reference
