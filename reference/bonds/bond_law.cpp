#include "reference/bonds/bond_law.hpp"

#include <algorithm>
#include <cmath>

namespace pliant::reference {
namespace {

BondJet positive(const BondJet& x) { return x.value > 0 ? x : BondJet(); }
BondJet magnitude(const BondJet& x) { return x.value < 0 ? -x : x; }

/// Integral of rate (p - threshold)/(strength - threshold) dp from p = from to p = to, over the part above the
/// threshold.
BondJet wear(double rate, double threshold, double strength, double from, const BondJet& to) {
  const double first = std::max(from, threshold);
  if (rate == 0 || to.value <= first) return 0.0;
  const BondJet above = to - threshold;
  return rate / (2 * (strength - threshold)) * (above * above - (first - threshold) * (first - threshold));
}

}  // namespace

BondJet BondLaw::bearing(const BondJet& opening) const { return bears_pressure ? opening : positive(opening); }

BondJet BondLaw::energy(const BondJet& opening, const BondJet& slip) const {
  const BondJet u = bearing(opening);
  return 0.5 * (kn * u * u + kt * slip * slip);
}

BondJet BondLaw::damage(const BondJet& opening, const BondJet& slip, const BondJet& gap) const {
  const BondJet u = positive(opening);
  const BondJet pull = kn * u / strength, shear = kt * slip / shear_strength(slip, gap);
  const BondJet squared = pull * pull + shear * shear;
  if (squared.value <= 1) return 0.0;
  const BondJet r = sqrt(squared);
  const BondJet q = 0.5 * (kn / energy_1 * u * u + kt / energy_2 * slip * slip);
  if (q.value >= r.value) return 1.0;
  return r * (r - 1) / (squared - q);
}

BondJet BondLaw::fatigue(double old_damage, double old_opening, double old_slip, const BondJet& opening,
                         const BondJet& slip) const {
  const double normal = (1 - old_damage) * kn, shear = (1 - old_damage) * kt;
  const double threshold_2 = threshold * cohesion / strength;  // in the ratio of the strengths
  return wear(rate_1, threshold, strength, normal * std::max(old_opening, 0.0), normal * positive(opening)) +
         wear(rate_2, threshold_2, cohesion, shear * std::abs(old_slip), shear * magnitude(slip));
}

BondJet BondLaw::shear_strength(const BondJet& slip, const BondJet& gap) const {
  const BondJet pressure = contact_kn * positive(-gap);
  if (pressure.value == 0) return cohesion;
  const BondJet by_contact = std::min(contact_friction * pressure, contact_kt * magnitude(slip));
  return cohesion + friction * pressure - by_contact;
}

}  // namespace pliant::reference
