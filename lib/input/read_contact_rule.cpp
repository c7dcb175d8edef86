#include <algorithm>
#include <tuple>

#include "input/read_tables.hpp"

namespace pliant {

namespace {

/// What a side of a rule may be called.
std::vector<std::string> group_names(const Scene& scene) {
  std::vector<std::string> names = names_of(scene.materials);
  for (const std::vector<std::string>& more : {names_of(scene.grains), names_of(scene.walls)})
    names.insert(names.end(), more.begin(), more.end());
  names.push_back("all");
  return names;
}

/// A material may bear the name of grains or a wall, as long as no rule uses it.
void refuse_ambiguous(const TableReader& table, const std::string& name, const std::vector<std::string>& names) {
  if (std::count(names.begin(), names.end(), name) < 2) return;
  table.fail("between", fmt::format("'{}' is a material and also grains or a wall; rename one of them", name));
}

void check_unique(const TableReader& table, const ContactRule& rule, const std::vector<ContactRule>& others) {
  for (const ContactRule& other : others) {
    const bool same = (other.first == rule.first && other.second == rule.second) ||
                      (other.first == rule.second && other.second == rule.first);
    if (same) table.fail("between", fmt::format("a second rule for {} and {}; keep one", rule.first, rule.second));
  }
}

/// Keys of the two laws without tension: a dashpot needs a constant stiffness, so it excludes a smooth start.
void read_impact(TableReader& table, ContactRule& rule) {
  table.optional("smoothing", rule.smoothing);
  if (!table.optional("restitution", rule.restitution)) return;
  table.optional("pull", rule.pull);
  if (rule.smoothing > 0)
    table.fail("smoothing", "has no meaning with restitution, whose dashpot goes with a constant stiffness");
}

void read_mohr_coulomb(TableReader& table, ContactRule& rule) {
  table.optional("shear_stiffness", rule.shear_stiffness);
  table.required("friction", rule.friction);
  table.optional("cohesion", rule.cohesion);
  table.optional("tension", rule.tension);
  if (rule.tension == 0) read_impact(table, rule);
}

void read_cohesive(TableReader& table, ContactRule& rule) {
  table.optional("shear_stiffness", rule.shear_stiffness);
  table.required("strength", rule.strength);
  table.optional("range", rule.range);
  table.optional("shear_strength", rule.shear_strength);
  if (!rule.range || !rule.stiffness) return;
  const double peak = rule.strength / *rule.stiffness;
  if (*rule.range <= peak) {
    table.value("range").reject(
        fmt::format("more than strength / stiffness = {} m, the gap of the greatest tension", peak));
  }
}

/// Throws for a law of earlier versions.
void refuse_former(TableReader& table) {
  if (table.has("law") && table.value("law").node.value_or(std::string()) == "cohesive-fatigue")
    table.fail("law",
               "'cohesive-fatigue' is now a rule of its own, [[bonds]], beside a law such as \"mohr-coulomb\": its "
               "fracture_energy is strength x range / 2 (range was 0.12 of the spacing unless given), its gap is "
               "bond_gap, its cohesion strength / shear_ratio; residual_strength has no successor");
}

}  // namespace

std::pair<std::string, std::string> read_between(TableReader& table, const Scene& scene) {
  if (table.has("between") && table.value("between").node.is_string()) {
    std::string all;
    table.required("between", all);
    return {all, all};
  }
  const std::vector<std::string> names = group_names(scene);
  std::vector<std::string> pair;
  table.required("between", pair, names);
  for (const std::string& name : pair) refuse_ambiguous(table, name, names);
  return {pair[0], pair[1]};
}

ContactRule read_contact(TableReader table, const Scene& scene) {
  ContactRule rule;
  std::tie(rule.first, rule.second) = read_between(table, scene);
  check_unique(table, rule, scene.contacts);
  refuse_former(table);
  table.required("law", rule.law);
  table.optional("stiffness", rule.stiffness);
  switch (rule.law) {
    case ContactLawKind::frictionless:
      read_impact(table, rule);
      break;
    case ContactLawKind::mohr_coulomb:
      read_mohr_coulomb(table, rule);
      break;
    case ContactLawKind::cohesive:
      read_cohesive(table, rule);
  }
  table.finish();
  return rule;
}

}  // namespace pliant
