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
        return *rule.range;
    }
    throw std::logic_error("reach of a law");
  }
  double share(double gap) const { return std::clamp((reach() - gap) / (reach() - rule.strength / kn()), 0.0, 1.0); }
  bool cohesive() const { return rule.law == ContactLawKind::cohesive; }
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

}  // namespace pliant::testing
