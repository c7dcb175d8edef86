#include "reference/contact/pair_laws.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "scene/contact_rules.hpp"

namespace pliant::reference {
namespace {

double segment_length(const ContactOutline& outline, int i) {
  const int last = outline.count - 1;
  const Vec2 end = i < last ? outline.reference[i + 1] : Vec2(outline.reference[0] + Vec2(outline.turn_shift, 0));
  return (end - outline.reference[i]).norm();
}

/// Parameters of the automatic stiffness, of bodies that no rule distinguishes.
struct Stiffness {
  double young =
      std::numeric_limits<double>::infinity();  ///< of the softest compliant body, Pa; infinite: all are rigid
  double spacing = std::numeric_limits<double>::infinity();  ///< finest outline spacing, m

  static Stiffness of(const Scene& scene, const ContactOutline& body) {
    Stiffness result;
    if (body.kind == BodyKind::compliant) result.young = scene.material(body.material).young;
    result.spacing = mean_spacing(body);
    return result;
  }
  Stiffness with(const Stiffness& other) const {
    return {std::min(young, other.young), std::min(spacing, other.spacing)};
  }
  bool rigid() const { return young == std::numeric_limits<double>::infinity(); }
  double value() const { return 8 * young / spacing; }
};

ContactGroup group_of(const Scene& scene, const ContactOutline& body) {
  return contact_group(scene, body.material, body.name, body.wall);
}

/// Largest automatic stiffness of pairs that have a rule, 0 if none has a compliant body.
double largest_stiffness(const Scene& scene, const std::vector<ContactOutline>& outlines) {
  std::map<ContactGroup, Stiffness> groups;
  for (const ContactOutline& body : outlines) {
    Stiffness& group = groups[group_of(scene, body)];
    group = group.with(Stiffness::of(scene, body));
  }
  double largest = 0;
  for (const auto& [a, of_a] : groups)
    for (const auto& [b, of_b] : groups) {
      const Stiffness both = of_a.with(of_b);
      if (!both.rigid() && match_rule(scene, a, b).rule != nullptr) largest = std::max(largest, both.value());
    }
  return largest;
}

double normal_stiffness(const ContactRule& rule, const Stiffness& pair, double largest) {
  if (rule.stiffness) return *rule.stiffness;
  if (!pair.rigid()) return pair.value();
  if (largest > 0) return 3 * largest;
  throw InputError(fmt::format(
      "stiffness of contacts between \"{}\" and \"{}\": \"auto\" needs a compliant body in the scene; give it in Pa/m",
      rule.first, rule.second));
}

void refuse_dashpots(const ContactRule& rule) {
  if (rule.restitution && *rule.restitution < 1)
    throw InputError(fmt::format(
        "restitution = {} of contacts between \"{}\" and \"{}\": the reference solver has no dashpots; leave it out",
        *rule.restitution, rule.first, rule.second));
}

void check_range(const ContactRule& rule, const Law& law) {
  if (law.strength < law.kn * law.reach) return;
  throw InputError(
      fmt::format("strength of contacts between \"{}\" and \"{}\" is only reached at a gap of {:.4g} m, beyond the "
                  "range of {:.4g} m: "
                  "give a larger stiffness or range",
                  rule.first, rule.second, law.strength / law.kn, law.reach));
}

Law make_law(const ContactRule& rule, double kn, double spacing) {
  refuse_dashpots(rule);
  Law law;
  law.kind = rule.law;
  law.kn = kn;
  law.kt = rule.shear_stiffness.value_or(kn);
  law.start = rule.smoothing * spacing;
  law.friction = rule.friction;
  law.cohesion = rule.cohesion;
  law.strength = rule.strength;
  law.shear_strength = rule.shear_strength.value_or(rule.strength);
  switch (rule.law) {
    case ContactLawKind::frictionless:
      break;
    case ContactLawKind::mohr_coulomb:
      law.reach = rule.tension / kn;
      break;
    case ContactLawKind::cohesive:
      law.reach = rule.range.value_or(0.12 * spacing);
      check_range(rule, law);
  }
  return law;
}

}  // namespace

std::vector<double> tributary_lengths(const ContactOutline& outline) {
  std::vector<double> lengths(outline.count);
  for (int i = 0; i < outline.count; ++i)
    lengths[i] = (segment_length(outline, i) + segment_length(outline, (i + outline.count - 1) % outline.count)) / 2;
  return lengths;
}

double mean_spacing(const ContactOutline& outline) {
  double sum = 0;
  for (int i = 0; i < outline.count; ++i) sum += segment_length(outline, i);
  return sum / outline.count;
}

PairLaws::PairLaws(const Scene& scene, const std::vector<ContactOutline>& outlines)
    : bodies_(static_cast<int>(outlines.size())), laws_(outlines.size() * outlines.size()) {
  const double largest = largest_stiffness(scene, outlines);
  for (int a = 0; a < bodies_; ++a)
    for (int b = 0; b < bodies_; ++b) {
      // A body meets itself only as a periodic image, and a wall has none.
      if (a == b && (!scene.is_periodic() || outlines[a].wall)) continue;
      const ContactRule* rule = match_rule(scene, group_of(scene, outlines[a]), group_of(scene, outlines[b])).rule;
      if (rule == nullptr) continue;
      const Stiffness pair = Stiffness::of(scene, outlines[a]).with(Stiffness::of(scene, outlines[b]));
      laws_[a * bodies_ + b] = make_law(*rule, normal_stiffness(*rule, pair, largest), pair.spacing);
    }
}

}  // namespace pliant::reference
