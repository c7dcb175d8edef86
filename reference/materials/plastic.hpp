#pragma once

#include <cmath>

#include "reference/jet.hpp"
#include "reference/materials/energy.hpp"

namespace pliant::reference {

/// Von Mises plasticity (docs/method.md 9) from an incremental energy (Ortiz and Stainier 1999, Comput. Methods Appl.
/// Mech. Eng. 171, 419-444). An increment of flow x shortens the deviator of the trial's logarithmic strain e by
/// sqrt(3/2) x, so that
///
///     W(F, x) = K/2 (tr e)^2 + G (|dev e| - sqrt(3/2) x)^2 + R(x),   R'(x) = Y(a + x)(1 + x t/dt),
///
/// is least at the x of the return, P = dW/dF at that x, and the tangent follows from all second derivatives of W.

/// Coefficients of artanh(s)^2 in powers of s^2, from s^2 on: products of the series of artanh.
inline constexpr double artanh_squares[] = {1.0, 2.0 / 3, 23.0 / 45, 44.0 / 105, 563.0 / 1575, 3254.0 / 10395};

/// artanh(s)^2 as a function of w = s^2, with its derivatives by w.
struct SquaredArtanh {
  double value = 0, first = 0, second = 0;
  explicit SquaredArtanh(double w) {
    if (w < 1e-3) {  // remainder of the sixth term: 1e-19
      double power = 1;
      for (int k = 0; k < 6; ++k) {
        const double c = artanh_squares[k], n = k + 1;
        value += c * power * w, first += c * n * power;
        power *= w;
      }
      double lower = 1;
      for (int k = 1; k < 6; ++k) second += artanh_squares[k] * (k + 1) * k * lower, lower *= w;
      return;
    }
    const double s = std::sqrt(w), a = std::atanh(s), rest = 1 - w;
    value = a * a, first = a / (s * rest);
    second = (0.5 - a * (1 - 3 * w) / (2 * s)) / (w * rest * rest);
  }
};
inline double squared_artanh(double w) { return SquaredArtanh(w).value; }
template <int N>
Jet<N> squared_artanh(const Jet<N>& w) {
  const SquaredArtanh f(w.value);
  return w.chained(f.value, f.first, f.second);
}

/// Elastic logarithmic strain with the plastic metric held. Out of the plane it follows from the plastic volume.
template <class Scalar>
struct LogarithmicStrain {
  Scalar volume, deviator_squared;

  LogarithmicStrain(const Deformation<Scalar>& F, const PointHistory& held) {
    using std::log;
    const Symmetric<double>& B = held.metric;
    const double det = B.xx * B.yy - B.xy * B.xy;
    const auto pull = [&](const Scalar& a, const Scalar& b, const Scalar& c, const Scalar& d) {
      return B.xx * a * c + B.xy * (a * d + b * c) + B.yy * b * d;
    };
    const Scalar xx = pull(F.xx, F.xy, F.xx, F.xy), xy = pull(F.xx, F.xy, F.yx, F.yy),
                 yy = pull(F.yx, F.yy, F.yx, F.yy);
    const Scalar mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy), in_plane = F.xx * F.yy - F.xy * F.yx;
    const Scalar level = 0.5 * log(in_plane) + 0.25 * std::log(det);             // mean principal strain in the plane
    const Scalar along = log(F.zz) - 0.5 * std::log(det) - held.plastic_volume;  // and the one out of it
    const Scalar spread = 0.25 * squared_artanh((half * half + xy * xy) / (mean * mean));  // (half difference)^2
    volume = 2.0 * level + along;
    const Scalar in = level - (1.0 / 3) * volume, out = along - (1.0 / 3) * volume;
    deviator_squared = 2.0 * in * in + 2.0 * spread + out * out;
  }
};

template <class Scalar>
Scalar elastic_energy(const Moduli& m, const LogarithmicStrain<Scalar>& e) {
  return 0.5 * m.bulk * e.volume * e.volume + m.mu * e.deviator_squared;
}

/// Yield stress, at least 0, with its derivative.
struct YieldStress {
  double stress, slope;
};
inline YieldStress yield_stress(const Material& m, double strain) {
  double stress = m.yield + m.hardening * strain, slope = m.hardening;
  if (m.saturation > 0) {
    const double rise = m.saturation - m.yield;
    stress -= rise * std::expm1(-m.saturation_rate * strain);
    slope += rise * m.saturation_rate * std::exp(-m.saturation_rate * strain);
  }
  return stress > 0 ? YieldStress{stress, slope} : YieldStress{0, 0};
}

/// Result of an increment at one point.
struct PlasticIncrement {
  Eigen::Vector4d stress;     ///< first Piola, Pa
  Eigen::Matrix4d stiffness;  ///< its derivative by F
  double energy = 0;          ///< elastic, Pa
  double loss = 0;            ///< dissipated, J/m3
  PointHistory now;
};

template <int N>
Deformation<Jet<N>> as_plane_variables(const Deformation<double>& F) {
  return {Jet<N>(F.xx, 0), Jet<N>(F.xy, 1), Jet<N>(F.yx, 2), Jet<N>(F.yy, 3)};
}

/// Response to F with the internal variables held.
PlasticIncrement elastic_increment(const Moduli& moduli, const Deformation<double>& F, const PointHistory& old);
/// Plastic metric when the elastic strain of the trial, of volume `volume`, gets the volume `kept` and the deviator
/// shrinks by r.
Symmetric<double> returned_metric(const Deformation<double>& F, const Symmetric<double>& B, double volume, double kept,
                                  double r);

/// Response to F after an increment of `elapsed`, s; infinite: without a rate; 0: internal variables are held.
PlasticIncrement plastic_increment(const Material& material, const Deformation<double>& F, const PointHistory& old,
                                   double elapsed);

/// The same of `drucker-prager`, which has no rate and, in general, no potential: the stiffness is not symmetric.
PlasticIncrement drucker_prager_increment(const Material& material, const Deformation<double>& F,
                                          const PointHistory& old);

}  // namespace pliant::reference
