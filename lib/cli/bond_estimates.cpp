#include "cli/bond_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace pliant {
namespace {

/// Segments that a process zone needs (Turon et al. 2007, Eng. Fract. Mech. 74, 1665: three to ten in the literature).
constexpr double least_segments = 3;

/// Plane strain modulus E/(1 - nu^2), Pa; infinite for rigid bodies.
double modulus_of(const Model& model, int body) {
  const Material& material = model.scene.materials[model.bodies[body].material];
  return model.bodies[body].kind == BodyKind::compliant ? material.young / (1 - material.poisson * material.poisson)
                                                        : std::numeric_limits<double>::infinity();
}

/// Of the softer side, Pa. Rigid cells with bonds between them are as soft as the bonds: stiffness x cell size. 0 where
/// a rigid grain is bonded to a wall.
double modulus_of(const Model& model, const Bond& bond, const BondLaw<double>& law) {
  const double least = std::min(modulus_of(model, bond.slave), modulus_of(model, bond.master));
  if (!std::isinf(least)) return least;
  return law.normal_stiffness * std::sqrt(std::min(model.bodies[bond.slave].area, model.bodies[bond.master].area));
}

struct BondEstimate {
  int count = 0;
  double compliance = 0;  ///< largest share of the bonds in the compliance of a cell and a bond
  double zone = std::numeric_limits<double>::infinity();      ///< shortest process zone, m
  double segments = std::numeric_limits<double>::infinity();  ///< fewest segments in one
};

}  // namespace

std::vector<std::string> describe_bonds(const Model& model, const BondSystem& bonds) {
  std::vector<BondEstimate> rules(model.scene.bonds.size());
  for (const Bond& bond : bonds.bonds()) {
    BondEstimate& estimate = rules[bond.rule];
    ++estimate.count;
    const BondLaw<double> law = bonds.law_of(bond);
    const double modulus = modulus_of(model, bond, law);
    if (modulus == 0) continue;
    for (const int body : {bond.slave, bond.master})
      if (model.bodies[body].kind == BodyKind::compliant)
        estimate.compliance = std::max(
            estimate.compliance, modulus_of(model, body) / (law.normal_stiffness * std::sqrt(model.bodies[body].area)));
    const double zone = modulus * law.energy_1 / (law.strength * law.strength);
    estimate.zone = std::min(estimate.zone, zone);
    estimate.segments = std::min(estimate.segments, zone / bond.length);
  }
  std::vector<std::string> lines;
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const BondRule& rule = model.scene.bonds[r];
    const std::string names = fmt::format("{} - {}", rule.first, rule.second);
    if (rule.from > 0) {
      lines.push_back(fmt::format("{:<24} made at t = {:.3g} s", names, rule.from));
      continue;
    }
    std::string text = fmt::format("{:<24} {} segments", names, rules[r].count);
    if (rules[r].compliance > 0)
      text += fmt::format(", which add up to {:.2g} % to the compliance", 100 * rules[r].compliance);
    if (!std::isinf(rules[r].zone))
      text += fmt::format("; process zone {} G/strength^2 {:.3g} m, {:.2g} segments{}",
                          rules[r].compliance > 0 ? "E'" : "stiffness x cell size x", rules[r].zone, rules[r].segments,
                          rules[r].segments < least_segments
                              ? fmt::format(": too few, a crack then depends on the mesh; take {} or more: a finer "
                                            "mesh, more fracture_energy or less strength",
                                            least_segments)
                              : "");
    lines.push_back(text);
  }
  return lines;
}

}  // namespace pliant
