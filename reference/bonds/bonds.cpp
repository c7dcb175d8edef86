#include "reference/bonds/bonds.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/located.hpp"
#include "reference/bonds/bond_law.hpp"
#include "reference/bonds/bond_search.hpp"
#include "reference/contact/pair_laws.hpp"

namespace pliant::reference {
namespace {

/// History variables of one end, at an accepted or a trial state.
struct EndMemory {
  double damage = 0;
  double opening = 0, slip = 0;  ///< that have a traction, m
};
using Memory = std::array<EndMemory, 2>;

/// Energy stored per length, J/m2.
double stored(const BondLaw& law, const EndMemory& at) {
  return (1 - at.damage) * 0.5 * (law.kn * at.opening * at.opening + law.kt * at.slip * at.slip);
}

/// Work of the mean tractions of a step less the change of the stored energy, J/m2.
double loss(const BondLaw& law, const EndMemory& before, const EndMemory& now) {
  const double whole0 = 1 - before.damage, whole1 = 1 - now.damage;
  const double pull = law.kn * (whole0 * before.opening + whole1 * now.opening) / 2,
               shear = law.kt * (whole0 * before.slip + whole1 * now.slip) / 2;
  return pull * (now.opening - before.opening) + shear * (now.slip - before.slip) -
         (stored(law, now) - stored(law, before));
}

void refuse(const BondRule& rule) {
  if (rule.weibull_modulus)
    throw InputError(
        "'weibull_modulus' in [[bonds]]: the reference solver gives all bonds of a rule one strength; leave it out");
}

/// Throws InputError unless more energy is lost in tearing than a bond stores at its strength.
void check_energy(const char* key, double energy, double strength, double stiffness) {
  if (const double elastic = strength * strength / (2 * stiffness); energy <= elastic)
    throw InputError(
        fmt::format("'{}' in [[bonds]] is {:.4g} J/m2, but bonds store {:.4g} J/m2 at their strength; "
                    "give more, or a higher 'stiffness'",
                    key, energy, elastic));
}

}  // namespace

struct Bonds::Implementation {
  Implementation(const Scene& of, std::vector<ContactOutline> given) : scene(of), outlines(std::move(given)) {
    if (scene.bonds.empty()) return;
    for (const BondRule& rule : scene.bonds) located(rule.where, [&] { refuse(rule); });
    contact.emplace(scene, outlines);
    made.resize(scene.bonds.size(), false);
  }

  BondLaw law_of(const Bond& bond) const {
    const BondRule& rule = scene.bonds[static_cast<std::size_t>(bond.rule)];
    const std::optional<Law>& beside = contact->between(bond.slave, bond.master);
    if (!beside && !rule.stiffness)
      throw InputError("'stiffness' of [[bonds]] between bodies that have no [[contacts]] rule: give it in Pa/m");
    BondLaw law;
    if (beside) {
      law.contact_kn = beside->kn;
      law.contact_kt = beside->shears() ? beside->kt : 0;
      law.contact_friction = beside->kind == ContactLawKind::mohr_coulomb ? beside->friction : 0;
    }
    law.kn = rule.stiffness.value_or(law.contact_kn);
    law.kt = rule.shear_stiffness.value_or(law.kn);
    law.strength = rule.strength;
    law.cohesion = rule.cohesion.value_or(rule.strength);
    law.friction = rule.friction.value_or(law.contact_friction);
    law.energy_1 = rule.fracture_energy;
    law.energy_2 = rule.shear_fracture_energy.value_or(rule.fracture_energy);
    law.bears_pressure = rule.gap > 0;
    law.threshold = rule.fatigue_threshold;
    law.rate_1 = rule.fatigue_rate;
    law.rate_2 = rule.shear_fatigue_rate;
    if (law.friction < law.contact_friction)
      throw InputError(fmt::format("'friction' in [[bonds]] is {}; allowed: at least that of the contacts, {}",
                                   law.friction, law.contact_friction));
    check_energy("fracture_energy", law.energy_1, law.strength, law.kn);
    check_energy("shear_fracture_energy", law.energy_2, law.cohesion, law.kt);
    return law;
  }

  void make(int rule, const Points& x, const Periods& periods) {
    const BondRule& of = scene.bonds[static_cast<std::size_t>(rule)];
    const std::vector<Bond> found = find_bonds(scene, outlines, x, periods, rule);
    // A segment that an earlier rule has bonded to this body keeps its bond.
    const auto end = static_cast<std::ptrdiff_t>(bonds.size());
    std::size_t added = 0;
    for (const Bond& bond : found) {
      const auto same = [&](const Bond& other) {
        return other.slave == bond.slave && other.master == bond.master && other.segment == bond.segment;
      };
      if (std::any_of(bonds.begin(), bonds.begin() + end, same)) continue;
      laws.push_back(law_of(bond));
      bonds.push_back(bond), accepted.emplace_back(), trial.emplace_back(), ++added;
    }
    if (added == 0 && of.from == 0)
      throw InputError(
          fmt::format("[[bonds]] between '{}' and '{}' find nothing to bond: no segment is near another outline",
                      of.first, of.second));
  }

  BondResult evaluate(const Points& x, const Periods& periods) {
    BondResult result;
    trial = accepted;
    for (std::size_t i = 0; i < bonds.size(); ++i) add(i, x, periods, result);
    return result;
  }

  void add(std::size_t number, const Points& x, const Periods& periods, BondResult& result) {
    const Bond& bond = bonds[number];
    const BondLaw& law = laws[number];
    const PresentOutline slave(outlines[static_cast<std::size_t>(bond.slave)], x),
        master(outlines[static_cast<std::size_t>(bond.master)], x);
    const BondPoints points = points_of(bond, slave, master, periods.shift(bond.image));
    const BondDistances distances = distances_of(points);
    BondJet::Gradient force = BondJet::Gradient::Zero();
    BondJet::Hessian tangent = BondJet::Hessian::Zero();
    const double weight = bond.length / 2;
    for (std::size_t end = 0; end < 2; ++end) {
      const BondJet opening = distances.gap[end] - bond.rest_gap[end], slip = distances.slip[end] - bond.rest_slip[end];
      const EndMemory& before = accepted[number][end];
      BondJet damage = law.damage(opening, slip, distances.gap[end]);
      const BondJet worn = before.damage + law.fatigue(before.damage, before.opening, before.slip, opening, slip);
      if (worn.value > damage.value) damage = worn.value < 1 ? worn : BondJet(1.0);
      if (damage.value > before.damage)
        result.damages = true;
      else
        damage = before.damage;
      const BondJet energy = law.energy(opening, slip);
      force += weight * (1 - damage.value) * energy.gradient;
      tangent += weight * ((1 - damage.value) * energy.hessian - energy.gradient * damage.gradient.transpose());
      const EndMemory now = trial[number][end] = {damage.value, law.bearing(opening).value, slip.value};
      result.stored += weight * stored(law, now);
      if (now.damage > before.damage) result.dissipated += weight * loss(law, before, now);
    }
    result.elements.push_back(at_nodes(bond, slave, master, points, force, tangent));
  }

  /// Forces on points to forces on nodes.
  static BondElement at_nodes(const Bond& bond, const PresentOutline& slave, const PresentOutline& master,
                              const BondPoints& points, const BondJet::Gradient& force,
                              const BondJet::Hessian& tangent) {
    BondElement element;
    Eigen::Matrix<double, 8, 12> share = Eigen::Matrix<double, 8, 12>::Zero();
    for (int end = 0; end < 2; ++end) {
      const auto& [segment, xi] = bond.points[static_cast<std::size_t>(end)];
      element.node[static_cast<std::size_t>(end)] = slave.index(bond.segment + end);
      element.node[static_cast<std::size_t>(2 + 2 * end)] = master.index(segment);
      element.node[static_cast<std::size_t>(3 + 2 * end)] = master.index(segment + 1);
      for (int c = 0; c < 2; ++c) {
        share(2 * end + c, 2 * end + c) = 1;
        share(4 + 2 * end + c, 4 + 4 * end + c) = 1 - xi, share(4 + 2 * end + c, 6 + 4 * end + c) = xi;
      }
    }
    element.force = share.transpose() * force;
    element.tangent = share.transpose() * tangent * share;
    element.lever.image = bond.image;
    for (int i = 0; i < 4; ++i) {
      const Vec2 at = force.segment<2>(2 * i);
      element.lever.moment += at * (points[static_cast<std::size_t>(i)] - points[0]).transpose();
      if (i >= 2) element.lever.residual += at;
    }
    return element;
  }

  Scene scene;
  std::vector<ContactOutline> outlines;
  std::optional<PairLaws> contact;
  std::vector<bool> made;  ///< [rules]
  std::vector<Bond> bonds;
  std::vector<BondLaw> laws;            ///< [bonds]
  std::vector<Memory> accepted, trial;  ///< [bonds]
};

void add_forces(const BondResult& result, Points& forces) {
  for (const BondElement& element : result.elements)
    for (std::size_t i = 0; i < element.node.size(); ++i)
      forces[static_cast<std::size_t>(element.node[i])] -= element.force.segment<2>(2 * static_cast<Eigen::Index>(i));
}

Bonds::Bonds(const Scene& scene, std::vector<ContactOutline> outlines)
    : implementation_(std::make_unique<Implementation>(scene, std::move(outlines))) {}

Bonds::~Bonds() = default;

void Bonds::make(const Points& x, const Periods& periods, double time) {
  Implementation& own = *implementation_;
  for (std::size_t rule = 0; rule < own.made.size(); ++rule) {
    if (own.made[rule] || time < own.scene.bonds[rule].from) continue;
    own.made[rule] = true;
    located(own.scene.bonds[rule].where, [&] { own.make(static_cast<int>(rule), x, periods); });
  }
}

BondResult Bonds::evaluate(const Points& x, const Periods& periods) { return implementation_->evaluate(x, periods); }

void Bonds::accept() { implementation_->accepted = implementation_->trial; }

const std::vector<Bond>& Bonds::all() const { return implementation_->bonds; }

double Bonds::damage(std::size_t bond, std::size_t end) const { return implementation_->accepted[bond][end].damage; }

BondCounts Bonds::counts() const {
  BondCounts counts;
  for (const auto& [first, second] : implementation_->accepted)
    ++(first.damage == 0 && second.damage == 0   ? counts.whole
       : first.damage == 1 && second.damage == 1 ? counts.torn
                                                 : counts.softening);
  return counts;
}

std::vector<double> Bonds::times() const {
  std::vector<double> times;
  for (const BondRule& rule : implementation_->scene.bonds)
    if (rule.from > 0) times.push_back(rule.from);
  return times;
}

}  // namespace pliant::reference
