#include <cmath>

#include "reference/materials/plastic.hpp"

namespace pliant::reference {
namespace {

/// q + friction s <= cohesion + hardening a, and flow along q + dilatancy s (docs/method.md 9).
struct Cone {
  double friction, dilatancy, cohesion, hardening;

  explicit Cone(const Material& material)
      : friction(slope(material.friction_angle)),
        dilatancy(slope(material.dilatancy_angle)),
        cohesion(friction / std::tan(material.friction_angle) * material.cohesion),
        hardening(friction / std::tan(material.friction_angle) * material.hardening) {}

  static double slope(double angle) { return 3 / std::sqrt(3 / std::pow(std::tan(angle), 2) + 4); }
};

}  // namespace

/// With the volume V and the squared deviator D of the trial's logarithmic strain and their derivatives by F, the
/// stress is P = G r dD + s dV: r and s follow from V and D, and the stiffness by the chain rule.
PlasticIncrement drucker_prager_increment(const Material& material, const Deformation<double>& F,
                                          const PointHistory& old) {
  const Moduli m = moduli(material);
  const Cone cone(material);
  const LogarithmicStrain<Jet<4>> trial(as_plane_variables<4>(F), old);
  const Jet<4>&V = trial.volume, &D = trial.deviator_squared;
  const double q = std::sqrt(6 * D.value) * m.mu, s = m.bulk * V.value;
  const double limit = cone.cohesion + cone.hardening * old.plastic_strain;
  if (q + cone.friction * s <= limit) return elastic_increment(m, F, old);

  const double yielding = 3 * m.mu + m.bulk * cone.friction * cone.dilatancy + cone.hardening;
  double x = (q + cone.friction * s - limit) / yielding, r = 0, widens = cone.friction;
  Eigen::Vector4d dx = Eigen::Vector4d::Zero(), dr = Eigen::Vector4d::Zero();
  if (3 * m.mu * x <= q) {
    const Eigen::Vector4d dq = q / (2 * D.value) * D.gradient;
    dx = (dq + cone.friction * m.bulk * V.gradient) / yielding;
    r = 1 - 3 * m.mu * x / q, widens = cone.dilatancy;
    dr = -3 * m.mu / q * (dx - x / q * dq);
  } else {  // the apex: no deviator is left
    const double apex = m.bulk * cone.friction * cone.friction + cone.hardening;
    x = (cone.friction * s - limit) / apex;
    dx = cone.friction * m.bulk / apex * V.gradient;
  }
  const double left = s - m.bulk * widens * x;
  const Eigen::Vector4d dleft = m.bulk * (V.gradient - widens * dx);
  PlasticIncrement result;
  result.stress = m.mu * r * D.gradient + left * V.gradient;
  result.stiffness =
      m.mu * (r * D.hessian + D.gradient * dr.transpose()) + left * V.hessian + V.gradient * dleft.transpose();
  result.energy = 0.5 * left * left / m.bulk + m.mu * r * r * D.value;
  // On the yield surface flow dissipates q + widens s, and q is the limit less friction s. Within a step the limit
  // grows with x, and s is that of its end.
  result.loss = x * (limit + 0.5 * cone.hardening * x + (widens - cone.friction) * left);
  result.now = old;
  result.now.metric = returned_metric(F, old.metric, V.value, left / m.bulk, r);
  result.now.plastic_strain += x;
  result.now.plastic_volume += widens * x;
  return result;
}

}  // namespace pliant::reference
