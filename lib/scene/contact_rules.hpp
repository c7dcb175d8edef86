#pragma once

#include <compare>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// Bodies that no contact rule tells apart: one material, and the grains or the wall when some rule calls them by name.
struct ContactGroup {
  std::string material;
  std::string name;   ///< of grains or a wall; empty: no rule names them
  bool wall = false;  ///< a single wall, which does not meet itself; only with a name
  auto operator<=>(const ContactGroup&) const = default;
};

/// The group of bodies of a material that belong to the grains or the wall of this name.
ContactGroup contact_group(const Scene& scene, const std::string& material, const std::string& name, bool wall);

/// All groups of the scene, sorted, each once.
std::vector<ContactGroup> contact_parties(const Scene& scene);

/// Whether two bodies of the group may touch, or one its own image or itself: not where it is a single wall, nor a
/// single body of a scene without a period and self-contact.
bool meets_itself(const Scene& scene, const ContactGroup& group);

/// Why a rule with restitution does not serve a compliant body of that material, and what to write instead.
std::string refusal_of_restitution(const Scene& scene, const ContactRule& rule, const std::string& material);

/// The rule of a pair. A side of a rule that names grains or a wall counts 2, a material 1, "all" 0: the largest sum
/// wins.
struct RuleMatch {
  const ContactRule* rule = nullptr;   ///< nullptr: none applies
  const ContactRule* rival = nullptr;  ///< another of the same sum: the scene does not say which holds
};

RuleMatch match_rule(const Scene& scene, const ContactGroup& a, const ContactGroup& b);

}  // namespace pliant
