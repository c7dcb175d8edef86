#pragma once

#include <cmath>
#include <stdexcept>

#include "scene/scene.hpp"

namespace pliant::reference {

/// Deformation gradient of plane strain, of numbers or of any type with the same arithmetic. zz is 1 in every solution;
/// as a variable it gives the stress out of the plane.
template <class Scalar>
struct Deformation {
  Scalar xx{}, xy{}, yx{}, yy{}, zz{1.0};
};

/// Lame constants and bulk modulus, 3D, of young and poisson, Pa.
struct Moduli {
  double mu, lambda, bulk;
};
inline Moduli moduli(const Material& material) {
  const double E = material.young, nu = material.poisson;
  return {E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu)), E / (3 * (1 - 2 * nu))};
}

template <class Scalar>
Scalar jacobian(const Deformation<Scalar>& F) {
  return (F.xx * F.yy - F.xy * F.yx) * F.zz;
}

/// First invariant of F^T F.
template <class Scalar>
Scalar first_invariant(const Deformation<Scalar>& F) {
  return F.xx * F.xx + F.xy * F.xy + F.yx * F.yx + F.yy * F.yy + F.zz * F.zz;
}

/// Small strain energy of the symmetric part of F - I: F measured from an unrotated start.
template <class Scalar>
Scalar linear_elastic_energy(const Moduli& m, const Deformation<Scalar>& F) {
  const Scalar xx = F.xx - 1.0, yy = F.yy - 1.0, zz = F.zz - 1.0, xy = 0.5 * (F.xy + F.yx);
  const Scalar trace = xx + yy + zz;
  return m.mu * (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy) + 0.5 * m.lambda * trace * trace;
}

/// Strain energy of the equilibrium part per reference volume, Pa (docs/method.md 3). Not a number where J <= 0, except
/// for `linear_elastic`.
template <class Scalar>
Scalar strain_energy(const Material& material, const Deformation<Scalar>& F) {
  using std::log, std::pow;
  const Moduli m = moduli(material);
  const auto shear = [&] { return 0.5 * m.mu * (first_invariant(F) - 3.0 - 2.0 * log(jacobian(F))); };
  const Scalar J = jacobian(F), volume = J - 1.0;
  switch (material.law) {
    case MaterialLaw::neo_hookean:
    case MaterialLaw::neo_hookean_maxwell:  // see branch_energy
      return shear() + 0.5 * m.lambda * log(J) * log(J);
    case MaterialLaw::neo_hookean_quadratic:
      return shear() + 0.5 * m.lambda * volume * volume;
    case MaterialLaw::melody:
      return 0.5 * m.bulk * volume * volume + 0.5 * m.mu * (pow(J, -2.0 / 3) * first_invariant(F) - 3.0);
    case MaterialLaw::linear_elastic:
      return linear_elastic_energy(m, F);
    case MaterialLaw::von_mises:  // see plastic.hpp
    case MaterialLaw::drucker_prager:
    case MaterialLaw::rigid:
      break;
  }
  throw std::logic_error("a material law without an energy");
}

/// Entries of a symmetric tensor in the plane, 1 out of it.
template <class Scalar>
struct Symmetric {
  Scalar xx{1.0}, xy{0.0}, yy{1.0};
};

/// Internal variables of a point: inverse of a viscous or plastic metric in the plane; for a Maxwell branch the value
/// towards which it creeps, for plastic laws the equivalent plastic strain and the logarithm of the plastic volume.
struct PointHistory {
  Symmetric<double> metric, goal;
  double plastic_strain = 0, plastic_volume = 0;
};

/// Inverse of F^T F.
template <class Scalar>
Symmetric<Scalar> inverse_metric(const Deformation<Scalar>& F) {
  const Scalar J = jacobian(F), square = J * J;
  return {(F.xy * F.xy + F.yy * F.yy) / square, -(F.xx * F.xy + F.yx * F.yy) / square,
          (F.xx * F.xx + F.yx * F.yx) / square};
}

/// Energy of a Maxwell branch per reference volume, Pa: neo-Hookean in the elastic part of the strain, with G the
/// inverse of the viscous strain, as Symmetric: m/2 (tr(F^T F G) - 3 - ln det(F^T F G)). The dashpot creeps by
/// dG/dt = ((F^T F)^-1 - G) / relaxation time.
template <class Scalar>
Scalar branch_energy(const Material& material, const Deformation<Scalar>& F, const Symmetric<Scalar>& G) {
  using std::log;
  const Scalar xx = F.xx * F.xx + F.yx * F.yx, xy = F.xx * F.xy + F.yx * F.yy, yy = F.xy * F.xy + F.yy * F.yy;
  const Scalar trace = xx * G.xx + 2.0 * xy * G.xy + yy * G.yy + F.zz * F.zz;
  return 0.5 * material.branch_modulus * (trace - 3.0 - 2.0 * log(jacobian(F)) - log(G.xx * G.yy - G.xy * G.xy));
}

/// Kelvin-Voigt damping (docs/method.md 3): half of the power that it dissipates per reference volume, W/m3,
/// eta E_dot : E_dot. Its derivative by the rate of F is F S with the second Piola stress S = 2 eta E_dot. E:
/// Green-Lagrange strain, so that 2 E_dot = F^T F_dot + F_dot^T F.
template <class Scalar>
Scalar viscous_potential(double viscosity, const Deformation<Scalar>& F, const Deformation<Scalar>& rate) {
  const Scalar xx = F.xx * rate.xx + F.yx * rate.yx, yy = F.xy * rate.xy + F.yy * rate.yy;
  const Scalar twice_xy = F.xx * rate.xy + F.yx * rate.yy + F.xy * rate.xx + F.yy * rate.yx;
  return viscosity * (xx * xx + yy * yy + 0.5 * twice_xy * twice_xy);
}

}  // namespace pliant::reference
