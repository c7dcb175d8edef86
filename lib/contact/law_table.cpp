#include "contact/law_table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "bodies/auto_stiffness.hpp"
#include "core/errors.hpp"
#include "scene/contact_rules.hpp"

namespace pliant {
namespace {

constexpr double auto_range_factor = 0.12;
/// Rigid grains touch at few nodes only, and carry force chains. With the softer value of compliant pairs they
/// penetrate by a segment length in the third body at 1 GPa. Their mass allows three times the stiffness before they
/// govern the time step.
constexpr double rigid_pair_factor = 3;

ContactGroup group_of(const Scene& scene, const Body& body) {
  const std::string& name = body.wall ? body.name : scene.grains[body.grains].name;
  return contact_group(scene, scene.materials[body.material].name, name, body.wall);
}

/// Inverse mass along one axis, the larger of both. 0: motion is imposed along both.
double inverse_mass(const Model& model, const Body& body) {
  if (body.kind == BodyKind::compliant) return 0;
  const RigidBody& rigid = model.rigid_bodies[body.rigid];
  return std::max(rigid.dof[0].inverse_mass, rigid.dof[1].inverse_mass);
}

/// The same at a given time, as conditions may begin or end.
double inverse_mass(const Model& model, const Body& body, double time) {
  double largest = 0;
  if (body.kind == BodyKind::rigid)
    for (int c = 0; c < 2; ++c)
      if (const RigidDof& dof = model.rigid_bodies[body.rigid].dof[c]; !dof.imposed(time))
        largest = std::max(largest, dof.inverse_mass);
  return largest;
}

std::string pair_text(const ContactRule& rule) {
  return fmt::format("[[contacts]] between '{}' and '{}'", rule.first, rule.second);
}

/// z acos(z) / sqrt(1 - z^2), continued beyond 1.
double decay_until_release(double z) {
  if (std::abs(z - 1) < 1e-8) return 1;
  return z < 1 ? z * std::acos(z) / std::sqrt(1 - z * z) : z * std::acosh(z) / std::sqrt(z * z - 1);
}

}  // namespace

double damping_ratio(double restitution, bool pull) {
  const double decay = -std::log(restitution);
  if (decay == 0) return 0;
  if (pull) return decay / std::hypot(M_PI, decay);
  double low = 0, high = 1;
  while (2 * decay_until_release(high) < decay) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (2 * decay_until_release(middle) < decay ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

LawTable::LawTable(const Model& model) : file_(model.scene.file.string()), rules_(model.scene.contacts) {
  for (const Body& body : model.bodies) add_body(model, body);
  find_rules(model.scene);
  for (int a = 0; a < static_cast<int>(groups_.size()); ++a)
    for (int b = 0; b < static_cast<int>(groups_.size()); ++b)
      largest_auto_ = std::max(largest_auto_, auto_stiffness(extreme(a, true), extreme(b, true)));
  find_extremes();
  if (damps_) find_eras(model);
}

void LawTable::add_body(const Model& model, const Body& body) {
  const std::string name = group_of(model.scene, body).name;
  const double h = model.outlines[body.outline].spacing, inverse = inverse_mass(model, body);
  auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group& p) {
    return p.kind == body.kind && p.material == body.material && p.name == name;
  });
  if (group == groups_.end()) {
    const double young = body.kind == BodyKind::compliant ? model.scene.materials[body.material].young : 0;
    group = groups_.insert(group, Group{body.kind, body.material, name, young, h, h, 0, 0, true});
  }
  ++group->bodies;
  group->wall &= body.wall;
  group->least_h = std::min(group->least_h, h);
  group->largest_h = std::max(group->largest_h, h);
  group->largest_inverse_mass = std::max(group->largest_inverse_mass, inverse);
  bodies_.push_back({static_cast<int>(group - groups_.begin()), h, inverse});
}

/// Whether bodies of the group may meet each other. A single body meets at most its image or itself.
bool LawTable::meets_itself(const Scene& scene, const Group& group) const {
  if (group.bodies > 1) return true;
  return !group.wall && (scene.is_periodic() || (scene.contact.self_contact && group.kind == BodyKind::compliant));
}

void LawTable::find_rules(const Scene& scene) {
  const auto describe = [&](const Group& group) {
    const bool wall = std::any_of(scene.walls.begin(), scene.walls.end(),
                                  [&](const Wall& w) { return !group.name.empty() && w.name == group.name; });
    return ContactGroup{scene.materials[group.material].name, group.name, wall};
  };
  for (const Group& a : groups_)
    for (const Group& b : groups_) {
      const ContactGroup first = describe(a), second = describe(b);
      const RuleMatch match = match_rule(scene, first, second);
      const bool never_meets = &a == &b && !meets_itself(scene, a);
      if (!match.rule && !never_meets)
        throw InputError(
            fmt::format("{}: no [[contacts]] rule between materials '{}' and '{}'; add one, or one between \"all\"",
                        file_, first.material, second.material));
      if (match.rule && !never_meets) check_restitution(scene, *match.rule, a.kind == BodyKind::compliant ? a : b);
      pair_rule_.push_back(match.rule ? static_cast<int>(match.rule - scene.contacts.data()) : -1);
    }
}

/// Throws InputError for restitution of a compliant body. `softer`: the compliant one of two groups, if any.
void LawTable::check_restitution(const Scene& scene, const ContactRule& rule, const Group& softer) const {
  if (softer.kind == BodyKind::rigid || rule.restitution.value_or(1) == 1) return;
  throw InputError(fmt::format("{}: {}: {}", file_, pair_text(rule),
                               refusal_of_restitution(scene, rule, scene.materials[softer.material].name)));
}

/// Finds bounds over all pairs from the extreme spacings: lengths grow with the finer of the two spacings, stiffness
/// with its inverse.
void LawTable::find_extremes() {
  for (int a = 0; a < static_cast<int>(groups_.size()); ++a)
    for (int b = 0; b < static_cast<int>(groups_.size()); ++b)
      for (const bool finest : {true, false}) {
        const Side first = extreme(a, finest), second = extreme(b, finest);
        if (!rule(first, second)) continue;
        const ContactLaw law = make_law(first, second);
        max_reach_ = std::max(max_reach_, reach_of(law));
        damps_ |= damping_ratio(first, second) > 0;
      }
}

LawTable::Side LawTable::extreme(int group, bool finest) const {
  const Group& p = groups_[group];
  return {group, finest ? p.least_h : p.largest_h, p.largest_inverse_mass};
}

void LawTable::find_eras(const Model& model) {
  for (const RigidBody& rigid : model.rigid_bodies)
    for (int c = 0; c < 2; ++c)
      if (const RigidDof& dof = rigid.dof[c]; dof.imposed())
        for (const double time : {dof.window.from, dof.window.until})
          if (time > 0 && std::isfinite(time)) interval_starts_.push_back(time);
  if (interval_starts_.empty()) return;
  std::sort(interval_starts_.begin(), interval_starts_.end());
  interval_starts_.erase(std::unique(interval_starts_.begin(), interval_starts_.end()), interval_starts_.end());
  for (std::size_t law_interval = 0; law_interval <= interval_starts_.size(); ++law_interval) {
    std::vector<double>& masses = interval_inverse_masses_.emplace_back();
    for (const Body& body : model.bodies)
      masses.push_back(inverse_mass(model, body, law_interval == 0 ? 0 : interval_starts_[law_interval - 1]));
  }
}

int LawTable::law_interval(double time) const {
  return static_cast<int>(std::upper_bound(interval_starts_.begin(), interval_starts_.end(), time) -
                          interval_starts_.begin());
}

ContactLaw LawTable::between(int first, int second, double time) const {
  Side a = bodies_[first], b = bodies_[second];
  if (!interval_inverse_masses_.empty()) {
    const std::vector<double>& masses = interval_inverse_masses_[law_interval(time)];
    a.inverse_mass = masses[first], b.inverse_mass = masses[second];
  }
  return make_law(a, b);
}

bool LawTable::automatic_stiffness(int first, int second) const {
  return !rule(bodies_[first], bodies_[second])->stiffness;
}

double LawTable::largest_stiffness(int body) const {
  double largest = 0;
  for (int other = 0; other < static_cast<int>(groups_.size()); ++other)
    if (const Side side = extreme(other, true); rule(bodies_[body], side))
      largest = std::max(largest, stiffness_of(make_law(bodies_[body], side)));
  return largest;
}

double LawTable::largest_damping_ratio(int body) const {
  double largest = 0;
  for (int other = 0; other < static_cast<int>(groups_.size()); ++other)
    largest = std::max(largest, damping_ratio(bodies_[body], extreme(other, true)));
  return largest;
}

/// Stiffness 8 E/h of a pair; 0 when both are rigid.
double LawTable::auto_stiffness(const Side& a, const Side& b) const {
  double young = 1e300;
  for (const Side* side : {&a, &b})
    if (groups_[side->group].kind == BodyKind::compliant) young = std::min(young, groups_[side->group].young);
  return young < 1e300 ? pliant::auto_stiffness(young, std::min(a.h, b.h)) : 0;
}

ContactLaw LawTable::make_law(const Side& a, const Side& b) const {
  const ContactRule& rule = *this->rule(a, b);
  const double own = auto_stiffness(a, b), h = std::min(a.h, b.h);
  const double kn = rule.stiffness.value_or(own > 0 ? own : rigid_pair_factor * largest_auto_);
  if (kn <= 0)
    throw InputError(fmt::format("{}: {}: stiffness \"auto\" needs a compliant body in the scene; give a value in Pa/m",
                                 file_, pair_text(rule)));
  const double kt = rule.shear_stiffness.value_or(kn);
  const double range = rule.range.value_or(auto_range_factor * h);
  const auto check_range = [&] {
    if (range > rule.strength / kn) return;
    throw InputError(
        fmt::format("{}: {}: range {:.3g} m must exceed strength / stiffness = {:.3g} m; give a larger range or "
                    "stiffness",
                    file_, pair_text(rule), range, rule.strength / kn));
  };
  switch (rule.law) {
    case ContactLawKind::frictionless:
      return with_impact(Frictionless{kn, 0, 0}, rule, a, b);
    case ContactLawKind::mohr_coulomb:
      return with_impact(MohrCoulomb{kn, kt, rule.tension / kn, rule.friction, rule.cohesion}, rule, a, b);
    case ContactLawKind::cohesive:
      check_range();
      return Cohesive{kn, kt, range, rule.strength, rule.shear_strength.value_or(rule.strength)};
  }
  throw std::logic_error("a contact law without a maker");
}

/// Damping ratio; 0: no dashpot. Only two rigid bodies, of which one can move, have one.
double LawTable::damping_ratio(const Side& a, const Side& b) const {
  const ContactRule* rule = this->rule(a, b);
  const bool rigid = groups_[a.group].kind == BodyKind::rigid && groups_[b.group].kind == BodyKind::rigid;
  if (!rule || !rigid || !rule->restitution || a.inverse_mass + b.inverse_mass == 0) return 0;
  return pliant::damping_ratio(*rule->restitution, rule->pull);
}

template <class Law>
ContactLaw LawTable::with_impact(const Law& law, const ContactRule& rule, const Side& a, const Side& b) const {
  if (const double z = damping_ratio(a, b); z > 0) {
    const double root = 2 * z * std::sqrt(law.normal_stiffness / (a.inverse_mass + b.inverse_mass));
    return Damped<Law>{law, root, z, rule.pull};
  }
  if (rule.smoothing > 0) return Smoothed<Law>{law, rule.smoothing * std::min(a.h, b.h)};
  return law;
}

}  // namespace pliant
