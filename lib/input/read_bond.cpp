#include <tuple>

#include "input/read_tables.hpp"

namespace pliant {
namespace {

/// The threshold holds in shear too, in the ratio of the strengths.
void read_fatigue(TableReader& table, BondRule& rule) {
  const bool grows = table.optional("fatigue_rate", rule.fatigue_rate);
  rule.shear_fatigue_rate = rule.fatigue_rate;
  const bool grows_in_shear = table.optional("shear_fatigue_rate", rule.shear_fatigue_rate);
  const Range below_strength{.low = 0, .high = rule.strength, .high_open = true};
  if (grows || grows_in_shear)
    table.required("fatigue_threshold", rule.fatigue_threshold, below_strength);
  else
    table.optional("fatigue_threshold", rule.fatigue_threshold, below_strength);
}

}  // namespace

BondRule read_bond(TableReader table, const Scene& scene) {
  BondRule rule;
  rule.where = table.place();
  std::tie(rule.first, rule.second) = read_between(table, scene);
  table.optional("from", rule.from);
  table.optional("gap", rule.gap);
  table.required("strength", rule.strength);
  table.optional("cohesion", rule.cohesion);
  table.optional("friction", rule.friction);
  table.required("fracture_energy", rule.fracture_energy);
  table.optional("shear_fracture_energy", rule.shear_fracture_energy);
  table.optional("stiffness", rule.stiffness);
  table.optional("shear_stiffness", rule.shear_stiffness);
  read_fatigue(table, rule);
  if (table.optional("weibull_modulus", rule.weibull_modulus)) table.required("seed", rule.seed);
  table.finish();
  return rule;
}

}  // namespace pliant
