#include "scene/contact_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace pliant {
namespace {

constexpr int no_match = -1;

int specificity(const std::string& name, const ContactGroup& group) {
  if (name == "all") return 0;
  if (name == group.name) return 2;
  return name == group.material ? 1 : no_match;
}

int specificity(const ContactRule& rule, const ContactGroup& a, const ContactGroup& b) {
  const int first = specificity(rule.first, a), second = specificity(rule.second, b);
  return first < 0 || second < 0 ? no_match : first + second;
}

}  // namespace

ContactGroup contact_group(const Scene& scene, const std::string& material, const std::string& name, bool wall) {
  const bool named = std::any_of(scene.contacts.begin(), scene.contacts.end(),
                                 [&](const ContactRule& rule) { return rule.first == name || rule.second == name; });
  return named ? ContactGroup{material, name, wall} : ContactGroup{material, {}, false};
}

std::vector<ContactGroup> contact_parties(const Scene& scene) {
  std::set<ContactGroup> groups;
  for (const Grains& grains : scene.grains)
    for (const Species& entry : grains.species) groups.insert(contact_group(scene, entry.material, grains.name, false));
  for (const Wall& wall : scene.walls) groups.insert(contact_group(scene, wall.material, wall.name, true));
  return {groups.begin(), groups.end()};
}

bool meets_itself(const Scene& scene, const ContactGroup& group) {
  std::int64_t bodies = 0;
  bool may_return = false;  // to its own image or folds, as walls do not
  for (const Grains& grains : scene.grains)
    for (const Species& entry : grains.species) {
      if (contact_group(scene, entry.material, grains.name, false) != group) continue;
      bodies += grains.body_count();
      may_return |= scene.is_periodic() || (scene.contact.self_contact && entry.body == BodyKind::compliant);
    }
  for (const Wall& wall : scene.walls) bodies += contact_group(scene, wall.material, wall.name, true) == group;
  return bodies != 1 || may_return;
}

std::string refusal_of_restitution(const Scene& scene, const ContactRule& rule, const std::string& material) {
  std::set<std::string> soft, rigid;  // materials of bodies
  for (const Wall& wall : scene.walls) rigid.insert(wall.material);
  for (const Grains& grains : scene.grains)
    for (const Species& entry : grains.species)
      (entry.body == BodyKind::compliant ? soft : rigid).insert(entry.material);
  const auto own = std::ranges::find_if(rigid, [&](const std::string& name) { return !soft.contains(name); });
  std::string instead = "take 'restitution' out of this rule";
  if (own != rigid.end())
    instead += fmt::format(
        "; pairs of rigid bodies may have it in a rule of their own, such as between = "
        "[\"{0}\", \"{0}\"]",
        *own);
  else if (!rigid.empty())
    instead +=
        "; pairs of rigid bodies, whose material is compliant elsewhere, may have it in a rule between names of "
        "grains and walls";
  return fmt::format(
      "restitution = {} is of pairs of rigid bodies, and bodies of '{}' are compliant: they lose by the "
      "viscosity of their material; {}",
      *rule.restitution, material, instead);
}

RuleMatch match_rule(const Scene& scene, const ContactGroup& a, const ContactGroup& b) {
  RuleMatch match;
  int best = no_match;
  for (const ContactRule& rule : scene.contacts) {
    const int rank = std::max(specificity(rule, a, b), specificity(rule, b, a));
    if (rank == no_match || rank < best) continue;
    match = {rank > best ? &rule : match.rule, rank > best ? nullptr : &rule};
    best = rank;
  }
  return match;
}

}  // namespace pliant
