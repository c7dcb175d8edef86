#pragma once

#include "core/elementary_functions.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Symmetric tensor in the plane.
template <class T>
struct PlaneMetric {
  T xx, xy, yy;
};

/// Elastic logarithmic strain e of plane strain, F = Fe Fp, with the inverse plastic metric C = Cp^-1 held
/// (docs/method.md 9): e = ln(b)/2 with b = F C F^T. It is isotropic in b, so that no eigenvector is needed: with
/// A = tr b/2 in the plane and half the difference h of the principal strains there,
///
///     dev e = mean 1 + slope/2 (b - A 1) in the plane, -2 mean out of it,   slope = artanh(z)/(z A),  tanh(2 h) = z.
template <class T>
struct HenckyStrain {
  T J;           ///< det F
  Tensor<T> FC;  ///< b F^-T
  T det_C;       ///< in the plane
  T inverse_J;
  T volume;                         ///< tr e
  T mean, h_squared, ratio, slope;  ///< ratio = slope A

  /// `det`: determinant of C in three dimensions.
  [[gnu::always_inline]] HenckyStrain(const Tensor<T>& F, const PlaneMetric<T>& C, T det) {
    J = determinant(F);
    det_C = C.xx * C.yy - C.xy * C.xy;
    const T log_det = natural_log<T>(J * J * det), log_in_plane = natural_log<T>(J * J * det_C);
    volume = 0.5 * log_det;
    mean = 0.25 * log_in_plane - 1.0 / 6 * log_det;
    FC = {F.xx * C.xx + F.xy * C.xy, F.xx * C.xy + F.xy * C.yy, F.yx * C.xx + F.yy * C.xy, F.yx * C.xy + F.yy * C.yy};
    const T b_xx = FC.xx * F.xx + FC.xy * F.xy, b_xy = FC.xx * F.yx + FC.xy * F.yy, b_yy = FC.yx * F.yx + FC.yy * F.yy;
    const T half_trace = 0.5 * (b_xx + b_yy), half_difference = 0.5 * (b_xx - b_yy);
    const T inverse = 1.0 / (J * half_trace), inverse_A = J * inverse;
    inverse_J = half_trace * inverse;
    const T z2 = (half_difference * half_difference + b_xy * b_xy) * (inverse_A * inverse_A);
    ratio = artanh_over<T>(z2);
    h_squared = 0.25 * z2 * (ratio * ratio);
    slope = ratio * inverse_A;
  }

  /// dev e : dev e.
  T deviator_squared() const { return 6.0 * mean * mean + 2.0 * h_squared; }
  /// Square of sqrt(3/2) |dev tau| for the Kirchhoff stress tau of a shear modulus.
  T equivalent_stress_squared(T shear_modulus) const {
    return 6.0 * shear_modulus * shear_modulus * deviator_squared();
  }

  /// Inverse plastic metric after an exponential return (Weber and Anand 1990, Comput. Methods Appl. Mech. Eng. 79,
  /// 173-202) that scales dev e by 1 - s and reduces tr e by `plastic_volume`: b_new = exp(-2 s dev e) b. With
  /// (b - A 1)^2 = (A^2 - det b) 1 in the plane and S(y) = sinh(y)/y,
  ///
  ///     b_new = c1 1 + c2 b,   c2 = g (cosh(2 s h) - s S(2 s h) slope A),   c1 = g s S(2 s h) slope det b,
  ///
  /// g = exp(-2 s mean - 2/3 plastic_volume), and C_new = F^-1 b_new F^-T = c1 (F^T F)^-1 + c2 C. No return, s = 0 and
  /// no plastic volume, leaves C to the bit.
  [[gnu::always_inline]] PlaneMetric<T> returned(const Tensor<T>& F, const PlaneMetric<T>& C, T s,
                                                 T plastic_volume) const {
    const T g = exponential_of_small<T>(-2.0 * s * mean - 2.0 / 3 * plastic_volume);
    const auto [cosh, S] = hyperbolic_of_small<T>(4.0 * s * s * h_squared);
    const T share = g * s * S, c1 = share * slope * det_C, c2 = g * cosh - share * ratio;  // c1 without J^2
    return {c1 * (F.xy * F.xy + F.yy * F.yy) + c2 * C.xx, c2 * C.xy - c1 * (F.xx * F.xy + F.yx * F.yy),
            c1 * (F.xx * F.xx + F.yx * F.yx) + c2 * C.yy};
  }

  /// First Piola stress of the Kirchhoff stress pressure 1 + 2 shear dev e; `pressure`: tension positive.
  Tensor<T> piola(const Tensor<T>& F, T pressure, T shear) const {
    const T p = (pressure + shear * (2.0 * mean - ratio)) * inverse_J, s = shear * slope;
    return {s * FC.xx + p * F.yy, s * FC.xy - p * F.yx, s * FC.yx - p * F.xy, s * FC.yy + p * F.xx};
  }
};

}  // namespace pliant
