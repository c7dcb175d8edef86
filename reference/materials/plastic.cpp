#include "reference/materials/plastic.hpp"

#include <Eigen/Dense>

namespace pliant::reference {
namespace {

const double root = std::sqrt(1.5);

/// Slope of the potential of flow, R'(x), with its derivative.
YieldStress resistance(const Material& material, double from, double x, double times) {
  const YieldStress yield = yield_stress(material, from + x);
  return {yield.stress * (1 + times * x), yield.slope * (1 + times * x) + yield.stress * times};
}

/// Increment of flow: 2 G sqrt(3/2) (norm - sqrt(3/2) x) = R'(x), by Newton's method within a shrinking bracket.
double find_flow(const Material& material, double norm, double from, double times) {
  const double G = moduli(material).mu;
  double low = 0, high = norm / root, x = 0;
  for (int i = 0; i < 200; ++i) {
    const YieldStress resists = resistance(material, from, x, times);
    const double excess = 2 * G * root * (norm - root * x) - resists.stress;
    (excess > 0 ? low : high) = x;
    const double next = x + excess / (3 * G + resists.slope);
    const double inside = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(inside - x) <= 1e-16 * high) break;
    x = inside;
  }
  return x;
}

/// Integral of the yield stress over a step, by Simpson's rule on parts so short that it is exact to rounding.
double plastic_work(const Material& material, double from, double x) {
  constexpr int parts = 64;
  double sum = 0;
  for (int k = 0; k <= 2 * parts; ++k)
    sum += (k == 0 || k == 2 * parts ? 1 : k % 2 ? 4 : 2) * yield_stress(material, from + x * k / (2 * parts)).stress;
  return sum * x / (6 * parts);
}

}  // namespace

PlasticIncrement elastic_increment(const Moduli& moduli, const Deformation<double>& F, const PointHistory& old) {
  const Jet<4> W = elastic_energy(moduli, LogarithmicStrain<Jet<4>>(as_plane_variables<4>(F), old));
  return {W.gradient, W.hessian, W.value, 0, old};
}

/// F^-1 b F^-T with other principal strains of b.
Symmetric<double> returned_metric(const Deformation<double>& F, const Symmetric<double>& B, double volume, double kept,
                                  double r) {
  Eigen::Matrix2d f, metric;
  f << F.xx, F.xy, F.yx, F.yy;
  metric << B.xx, B.xy, B.xy, B.yy;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> b(f * metric * f.transpose());
  const Eigen::Array2d strain = 0.5 * b.eigenvalues().array().log();
  const Eigen::Array2d left = kept / 3 + r * (strain - volume / 3);
  const Eigen::Matrix2d n = f.inverse() * b.eigenvectors();
  const Eigen::Matrix2d now = n * (2 * left).exp().matrix().asDiagonal() * n.transpose();
  return {now(0, 0), 0.5 * (now(0, 1) + now(1, 0)), now(1, 1)};
}

PlasticIncrement plastic_increment(const Material& material, const Deformation<double>& F, const PointHistory& old,
                                   double elapsed) {
  const Moduli m = moduli(material);
  if (elapsed == 0) return elastic_increment(m, F, old);
  if (material.law == MaterialLaw::drucker_prager) return drucker_prager_increment(material, F, old);
  const LogarithmicStrain<double> trial(F, old);
  const double norm = std::sqrt(trial.deviator_squared), times = material.viscoplastic_time / elapsed;
  if (2 * m.mu * root * norm <= yield_stress(material, old.plastic_strain).stress) return elastic_increment(m, F, old);
  PlasticIncrement result;
  result.now = old;
  const double x = find_flow(material, norm, old.plastic_strain, times);
  const LogarithmicStrain<Jet<5>> e(as_plane_variables<5>(F), old);
  const Jet<5> flow(x, 4), left = sqrt(e.deviator_squared) - root * flow;
  Jet<5> W = 0.5 * m.bulk * e.volume * e.volume + m.mu * left * left;
  result.energy = W.value;
  const YieldStress resists = resistance(material, old.plastic_strain, x, times);
  W += flow.chained(0, resists.stress, resists.slope);
  result.stress = W.gradient.head<4>();
  result.stiffness = W.hessian.topLeftCorner<4, 4>() -
                     W.hessian.topRightCorner<4, 1>() * W.hessian.bottomLeftCorner<1, 4>() / W.hessian(4, 4);
  const double yield = yield_stress(material, old.plastic_strain + x).stress;
  result.loss = plastic_work(material, old.plastic_strain, x) + (resists.stress - yield) * x;
  result.now.metric = returned_metric(F, old.metric, trial.volume, trial.volume, 1 - root * x / norm);
  result.now.plastic_strain += x;
  return result;
}

}  // namespace pliant::reference
