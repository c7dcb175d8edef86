#include <algorithm>

#include "input/read_tables.hpp"
#include "scene/contact_rules.hpp"

namespace pliant {

namespace {

std::string name_of(const ContactGroup& group) {
  return group.name.empty() ? fmt::format("'{}'", group.material)
                            : fmt::format("'{}' of '{}'", group.name, group.material);
}

/// A pair needs a rule, and only one.
const ContactRule& require_rule(const TableReader& root, const Scene& scene, const std::vector<TableReader>& tables,
                                const ContactGroup& a, const ContactGroup& b) {
  if (tables.empty()) root.fail_missing("contacts", "at least one table [[contacts]]");
  const RuleMatch match = match_rule(scene, a, b);
  if (!match.rule) {
    tables.back().fail(
        fmt::format("no contact rule for the materials '{0}' and '{1}'; add [[contacts]] between = "
                    "[\"{0}\", \"{1}\"] or between = \"all\"",
                    a.material, b.material));
  }
  if (match.rival) {
    const auto pair = [](const ContactRule& rule) { return fmt::format("[{}, {}]", rule.first, rule.second); };
    tables[static_cast<std::size_t>(match.rival - scene.contacts.data())].fail(
        "between",
        fmt::format("says as much of {} and {} as the rule between {} does; name both sides more closely, or "
                    "add a rule for these two",
                    name_of(a), name_of(b), pair(*match.rule)));
  }
  return *match.rule;
}

bool has_compliant(const Scene& scene, const ContactGroup& group) {
  for (const Grains& grains : scene.grains)
    for (const Species& entry : grains.species)
      if (entry.body == BodyKind::compliant && contact_group(scene, entry.material, grains.name, false) == group)
        return true;
  return false;
}

void check_restitution(const Scene& scene, const TableReader& table, const ContactRule& rule, const ContactGroup& a,
                       const ContactGroup& b) {
  if (rule.restitution.value_or(1) == 1) return;
  for (const ContactGroup* group : {&a, &b})
    if (has_compliant(scene, *group)) table.fail("restitution", refusal_of_restitution(scene, rule, group->material));
}

/// The automatic stiffness follows from the compliant bodies of the scene.
void check_pair(const TableReader& root, const Scene& scene, const std::vector<TableReader>& tables,
                const ContactGroup& a, const ContactGroup& b) {
  const ContactRule& rule = require_rule(root, scene, tables, a, b);
  const TableReader& table = tables[static_cast<std::size_t>(&rule - scene.contacts.data())];
  check_restitution(scene, table, rule, a, b);
  const bool compliant = std::any_of(scene.grains.begin(), scene.grains.end(),
                                     [](const Grains& grains) { return has_body(grains, BodyKind::compliant); });
  if (compliant || rule.stiffness) return;
  table.fail(
      fmt::format("the stiffness between '{}' and '{}' cannot be automatic in a scene without compliant "
                  "bodies; add stiffness in {} (Pa/m)",
                  a.material, b.material, table.title()));
}

void check_rules(const TableReader& root, const Scene& scene, const std::vector<TableReader>& tables) {
  const std::vector<ContactGroup> groups = contact_parties(scene);
  for (auto a = groups.begin(); a != groups.end(); ++a)
    for (auto b = a; b != groups.end(); ++b)
      if (a != b || meets_itself(scene, *a)) check_pair(root, scene, tables, *a, *b);
}

/// "safe", a whole number of steps, or a time.
void read_refresh(TableReader& table, ContactSettings& contact) {
  const bool given = table.has("refresh");
  if (given && table.value("refresh").node.is_integer()) {
    table.optional("refresh", contact.refresh_steps);
    return;
  }
  if (given && !table.value("refresh").node.is_string())
    table.value("refresh").reject("\"safe\", a number of steps from 1, or a time with its unit, > 0");
  std::optional<double> period;
  table.optional("refresh", period);
  contact.refresh_period = period.value_or(0);
}

void read_settings(TableReader settings, Scene& scene) {
  settings.optional("skin", scene.skin);
  settings.optional("quadrature", scene.contact.quadrature);
  settings.optional("length", scene.contact.length);
  read_refresh(settings, scene.contact);
  settings.optional("self_contact", scene.contact.self_contact);
  if (traits_of(scene.time.integrator).corrects_energy)
    settings.optional("energy_consistent", scene.contact.energy_consistent);
  if (settings.has("energy_consistent") && scene.contact.energy_consistent &&
      scene.contact.length == ContactLength::current)
    settings.value("energy_consistent")
        .reject("false with length = \"current\", whose pressure is no gradient of an energy");
  settings.finish();
}

}  // namespace

void read_contacts(TableReader& root, Scene& scene) {
  if (root.has("contact") && root.value("contact").node.is_array())
    root.value("contact").reject("a table [contact] of settings; rules for pairs of materials are [[contacts]]");
  read_settings(root.optional_table("contact"), scene);
  const std::vector<TableReader> tables = root.tables("contacts");
  for (const TableReader& table : tables) scene.contacts.push_back(read_contact(table, scene));
  check_rules(root, scene, tables);
}

}  // namespace pliant
