#include "scene/contact_rules.hpp"

#include <algorithm>
#include <set>

namespace pliant {
namespace {

constexpr int no_match = -1;

int specificity(const std::string& name, const ContactParty& party) {
  if (name == "all") return 0;
  if (name == party.name) return 2;
  return name == party.material ? 1 : no_match;
}

int specificity(const ContactRule& rule, const ContactParty& a, const ContactParty& b) {
  const int first = specificity(rule.first, a), second = specificity(rule.second, b);
  return first < 0 || second < 0 ? no_match : first + second;
}

}  // namespace

ContactParty contact_party(const Scene& scene, const std::string& material, const std::string& name, bool wall) {
  const bool named = std::any_of(scene.contacts.begin(), scene.contacts.end(),
                                 [&](const ContactRule& rule) { return rule.first == name || rule.second == name; });
  return named ? ContactParty{material, name, wall} : ContactParty{material, {}, false};
}

std::vector<ContactParty> contact_parties(const Scene& scene) {
  std::set<ContactParty> parties;
  for (const Grains& grains : scene.grains)
    for (const MixEntry& entry : grains.mix) parties.insert(contact_party(scene, entry.material, grains.name, false));
  for (const Wall& wall : scene.walls) parties.insert(contact_party(scene, wall.material, wall.name, true));
  return {parties.begin(), parties.end()};
}

RuleMatch match_rule(const Scene& scene, const ContactParty& a, const ContactParty& b) {
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
