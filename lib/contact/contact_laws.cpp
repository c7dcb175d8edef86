#include "contact/contact_laws.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "core/errors.hpp"

namespace pliant {
namespace {

/// METHOD 4: 6 to 8 % of h penetration at p = E/2.
constexpr double auto_stiffness_factor = 8;
constexpr double auto_range_factor = 0.12;
/// Rigid grains touch on a few nodes only, and carry force chains: with the softer value of the compliant pairs they sink in by a segment
/// length in the third body at 1 GPa. Their mass lets the stiffness be three times higher before they govern the time step.
constexpr double rigid_pair_factor = 3;

struct BodyClass {
  BodyKind kind;
  int material, outline;
  auto operator<=>(const BodyClass&) const = default;
};

/// Stiffness 8 E/h of a pair; 0 when both are rigid.
double auto_stiffness(const Model& model, const BodyClass& a, const BodyClass& b) {
  double young = 1e300;
  for (const BodyClass* c : {&a, &b})
    if (c->kind == BodyKind::compliant) young = std::min(young, model.scene.materials[c->material].young);
  const double h = std::min(model.outlines[a.outline].spacing, model.outlines[b.outline].spacing);
  return young < 1e300 ? auto_stiffness_factor * young / h : 0;
}

const ContactRule& rule_between(const Scene& scene, const std::string& a, const std::string& b) {
  const ContactRule* general = nullptr;
  for (const ContactRule& rule : scene.contacts) {
    if ((rule.first == a && rule.second == b) || (rule.first == b && rule.second == a)) return rule;
    if (rule.first == "all") general = &rule;
  }
  if (!general)
    throw InputError(
        fmt::format("{}: no [[contacts]] rule between materials '{}' and '{}'; add one, or one between \"all\"",
                    scene.file.string(), a, b));
  return *general;
}

ContactLaw make_law(const Scene& scene, const ContactRule& rule, double kn, double h) {
  const double kt = rule.shear_stiffness.value_or(kn);
  switch (rule.law) {
    case ContactLawKind::frictionless:
      return Frictionless{kn, 0, 0};
    case ContactLawKind::mohr_coulomb:
      return MohrCoulomb{kn, kt, rule.tension / kn, rule.friction, rule.cohesion};
    case ContactLawKind::cohesive:
      break;
  }
  const double range = rule.range.value_or(auto_range_factor * h);
  if (range <= rule.strength / kn)
    throw InputError(fmt::format(
        "{}: [[contacts]] between '{}' and '{}': range {:.3g} m must exceed strength / stiffness = {:.3g} m; "
        "give a larger range or stiffness",
        scene.file.string(), rule.first, rule.second, range, rule.strength / kn));
  return Cohesive{kn, kt, range, rule.strength, rule.shear_strength.value_or(rule.strength)};
}

ContactLaw law_between(const Model& model, const BodyClass& a, const BodyClass& b, double largest_auto) {
  const Scene& scene = model.scene;
  const std::string& name_a = scene.materials[a.material].name;
  const std::string& name_b = scene.materials[b.material].name;
  const ContactRule& rule = rule_between(scene, name_a, name_b);
  const double own = auto_stiffness(model, a, b);
  const double kn = rule.stiffness.value_or(own > 0 ? own : rigid_pair_factor * largest_auto);
  if (kn <= 0)
    throw InputError(
        fmt::format("{}: [[contacts]] between '{}' and '{}': stiffness \"auto\" needs a compliant body in the scene; "
                    "give a value in Pa/m",
                    scene.file.string(), name_a, name_b));
  return make_law(scene, rule, kn, std::min(model.outlines[a.outline].spacing, model.outlines[b.outline].spacing));
}

}  // namespace

ContactLaws make_contact_laws(const Model& model) {
  ContactLaws result;
  std::map<BodyClass, int> index;
  std::vector<BodyClass> classes;
  for (const Body& body : model.bodies) {
    const BodyClass key{body.kind, body.material, body.outline};
    const auto [at, is_new] = index.try_emplace(key, static_cast<int>(classes.size()));
    if (is_new) classes.push_back(key);
    result.body_class.push_back(at->second);
  }
  double largest_auto = 0;
  for (const BodyClass& a : classes)
    for (const BodyClass& b : classes) largest_auto = std::max(largest_auto, auto_stiffness(model, a, b));
  result.classes = static_cast<int>(classes.size());
  for (const BodyClass& a : classes)
    for (const BodyClass& b : classes) {
      result.pair_law.push_back(static_cast<int>(result.laws.size()));
      result.laws.push_back(law_between(model, a, b, largest_auto));
      result.max_reach = std::max(result.max_reach, reach_of(result.laws.back()));
    }
  return result;
}

}  // namespace pliant
