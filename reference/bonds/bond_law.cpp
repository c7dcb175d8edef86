#include "reference/bonds/bond_law.hpp"

#include <algorithm>

namespace pliant::reference {
namespace {

BondJet positive(const BondJet& x) { return x.value > 0 ? x : BondJet(); }
BondJet magnitude(const BondJet& x) { return x.value < 0 ? -x : x; }

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

BondJet BondLaw::shear_strength(const BondJet& slip, const BondJet& gap) const {
  const BondJet pressure = contact_kn * positive(-gap);
  if (pressure.value == 0) return cohesion;
  const BondJet by_contact = std::min(contact_friction * pressure, contact_kt * magnitude(slip));
  return cohesion + friction * pressure - by_contact;
}

}  // namespace pliant::reference
