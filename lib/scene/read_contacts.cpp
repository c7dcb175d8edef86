#include "scene/read_tables.hpp"

namespace pliant {

namespace {

void read_between(TableReader& table, ContactRule& rule, const Scene& scene) {
  if (table.has("between") && table.value("between").node.is_string()) {
    table.required("between", rule.first, OneOf{"word", {"all"}});
    rule.second = rule.first;
    return;
  }
  std::vector<std::string> pair;
  table.required("between", pair, List<OneOf>{{"material", names_of(scene.materials)}, 2, 2});
  rule.first = pair[0];
  rule.second = pair[1];
}

void check_unique(const TableReader& table, const ContactRule& rule, const std::vector<ContactRule>& others) {
  for (const ContactRule& other : others) {
    const bool same = (other.first == rule.first && other.second == rule.second) ||
                      (other.first == rule.second && other.second == rule.first);
    if (same) table.fail("between", fmt::format("a second rule for {} and {}; keep one", rule.first, rule.second));
  }
}

void read_mohr_coulomb(TableReader& table, ContactRule& rule) {
  table.required("friction", rule.friction, Quantity{"1", non_negative});
  table.optional("cohesion", rule.cohesion, Quantity{"Pa", non_negative});
  table.optional("tension", rule.tension, Quantity{"Pa", non_negative});
}

void read_cohesive(TableReader& table, ContactRule& rule) {
  table.required("strength", rule.strength, Quantity{"Pa", positive});
  table.optional("shear_strength", rule.shear_strength, QuantityOr{"auto", {"Pa", non_negative}});
  table.optional("range", rule.range, QuantityOr{"auto", {"m", positive}});
  if (!rule.range || !rule.stiffness) return;
  const double peak = rule.strength / *rule.stiffness;
  if (*rule.range <= peak) {
    table.value("range").reject(
        fmt::format("more than strength / stiffness = {} m, the gap of the greatest tension", peak));
  }
}

}  // namespace

ContactRule read_contact(TableReader table, const Scene& scene) {
  ContactRule rule;
  read_between(table, rule, scene);
  check_unique(table, rule, scene.contacts);
  table.required("law", rule.law,
                 Choice<ContactLawKind>{{{"frictionless", ContactLawKind::frictionless},
                                         {"mohr-coulomb", ContactLawKind::mohr_coulomb},
                                         {"cohesive", ContactLawKind::cohesive}}});
  const QuantityOr stiffness{"auto", {"Pa/m", positive}};
  table.optional("stiffness", rule.stiffness, stiffness);
  if (rule.law != ContactLawKind::frictionless) table.optional("shear_stiffness", rule.shear_stiffness, stiffness);
  if (rule.law == ContactLawKind::mohr_coulomb) read_mohr_coulomb(table, rule);
  if (rule.law == ContactLawKind::cohesive) read_cohesive(table, rule);
  table.finish();
  return rule;
}

}  // namespace pliant
