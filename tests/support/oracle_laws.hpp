#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scene/scene.hpp"

/// The laws of docs/method.md 4 once more, for support/contact_oracle.hpp.
namespace pliant::testing {

struct OracleLaw {
  ContactRule rule;
  double h = 0;  ///< finer outline spacing of the pair, m
  double kn() const { return *rule.stiffness; }
  double kt() const {
    switch (rule.law) {
      case ContactLawKind::frictionless:
        return 0;
      case ContactLawKind::mohr_coulomb:
      case ContactLawKind::cohesive:
      case ContactLawKind::cohesive_fatigue:
        return rule.shear_stiffness.value_or(kn());
    }
    throw std::logic_error("kt of a law");
  }
  /// g_max of cohesion, the opening at which the tensile cut-off is met, or nothing.
  double reach() const {
    switch (rule.law) {
      case ContactLawKind::frictionless:
        return 0;
      case ContactLawKind::mohr_coulomb:
        return rule.tension / kn();
      case ContactLawKind::cohesive:
      case ContactLawKind::cohesive_fatigue:
        return *rule.range;
    }
    throw std::logic_error("reach of a law");
  }
  double share(double gap) const { return std::clamp((reach() - gap) / (reach() - rule.strength / kn()), 0.0, 1.0); }
  /// Of what pulls by cohesion. What of a bond is broken has a law of its own: residual_of.
  bool cohesive() const {
    switch (rule.law) {
      case ContactLawKind::frictionless:
      case ContactLawKind::mohr_coulomb:
        return false;
      case ContactLawKind::cohesive:
        return true;
      case ContactLawKind::cohesive_fatigue:
        break;
    }
    throw std::logic_error("tractions of bonds by a law without bonds");
  }
  double pressure(double gap) const {
    if (gap >= reach()) return 0;
    if (cohesive()) return std::max(-kn() * gap, -rule.strength * share(gap));
    const double width = rule.smoothing * h;
    if (width > 0 && gap > -width) return kn() * gap * gap / (2 * width);
    return -kn() * (gap + width / 2);
  }
  double shear_limit(double gap) const {
    if (gap >= reach() || kt() == 0) return 0;
    const double frictional = rule.friction * std::max(pressure(gap), 0.0);
    return cohesive() ? *rule.shear_strength * share(gap) + frictional : rule.cohesion + frictional;
  }
  /// Integral of the pressure from the gap to the reach: Simpson's rule on each of the law's pieces, straight or
  /// square, is exact.
  double energy(double gap) const {
    if (gap >= reach()) return 0;
    const double corner = cohesive() ? rule.strength / kn() : rule.smoothing > 0 ? -rule.smoothing * h : reach();
    const auto piece = [&](double a, double b) {
      return (b - a) / 6 * (pressure(a) + 4 * pressure((a + b) / 2) + pressure(std::nextafter(b, a)));
    };
    return gap < corner ? piece(gap, corner) + piece(corner, reach()) : piece(gap, reach());
  }
};

/// What is left of a broken bond.
inline ContactRule residual_of(const ContactRule& rule) {
  ContactRule left = rule;
  left.law = ContactLawKind::cohesive;
  left.strength = rule.residual_strength;
  left.shear_strength = rule.residual_strength / rule.shear_ratio;
  left.shear_stiffness = *rule.stiffness / (rule.shear_ratio * rule.shear_ratio);
  return left;
}

/// A bond of the law cohesive-fatigue: its damage, opening and slip, and what follows from them by the length.
struct OracleBond {
  const ContactRule& rule;
  double damage, opening, slip;

  double kn() const { return *rule.stiffness; }
  double kt() const { return kn() / (rule.shear_ratio * rule.shear_ratio); }
  double tension() const { return (1 - damage) * kn() * opening; }
  double shear() const { return (1 - damage) * kt() * slip; }
  double stored() const { return (tension() * opening + shear() * slip) / 2; }
  double delta() const { return std::hypot(opening, slip / rule.shear_ratio); }

  /// Damage that goes on to another opening and slip bring.
  double damage_at(double to_opening, double to_slip) const {
    const OracleBond there{rule, damage, to_opening, to_slip};
    const double critical = rule.strength / kn(), range = *rule.range, d = there.delta();
    const double by_opening = d > critical ? range * (d - critical) / (d * (range - critical)) : 0;
    const double by_loads =
        rule.fatigue_rate * wear(tension(), there.tension(), rule.fatigue_threshold, rule.strength) +
        rule.shear_fatigue_rate * wear(std::abs(shear()), std::abs(there.shear()),
                                       rule.fatigue_threshold / rule.shear_ratio, rule.strength / rule.shear_ratio);
    return std::min(1.0, std::max(damage + by_loads, by_opening));
  }
  /// Mean of the tractions here and there along the way.
  double work_to(const OracleBond& there) const {
    return (tension() + there.tension()) / 2 * (there.opening - opening) +
           (shear() + there.shear()) / 2 * (there.slip - slip);
  }
  /// The integrand is straight: its middle value is exact.
  static double wear(double from, double to, double threshold, double strength) {
    from = std::max(from, threshold);
    return to > from ? ((from + to) / 2 - threshold) / (strength - threshold) * (to - from) : 0;
  }
};

}  // namespace pliant::testing
