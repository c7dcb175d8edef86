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
  T J;                 ///< det F
  T b_xx, b_xy, b_yy;  ///< in the plane
  T half_trace;        ///< A
  T inverse_J;
  T volume;  ///< tr e
  T mean, h_squared, slope;

  /// `log_zz`: logarithm of C_zz.
  HenckyStrain(const Tensor<T>& F, const PlaneMetric<T>& C, T log_det, T log_zz) {
    J = determinant(F);
    const T x = F.xx * C.xx + F.xy * C.xy, y = F.xx * C.xy + F.xy * C.yy, u = F.yx * C.xx + F.yy * C.xy,
            v = F.yx * C.xy + F.yy * C.yy;
    b_xx = x * F.xx + y * F.xy, b_xy = x * F.yx + y * F.yy, b_yy = u * F.yx + v * F.yy;
    const T in_plane = natural_log(J) + 0.5 * log_det;
    volume = in_plane + 0.5 * log_zz;
    mean = 0.5 * in_plane - 1.0 / 3 * volume;
    half_trace = 0.5 * (b_xx + b_yy);
    const T inverse = 1.0 / (J * half_trace), inverse_A = J * inverse;
    inverse_J = half_trace * inverse;
    const T half_difference = 0.5 * (b_xx - b_yy);
    const T z2 = (half_difference * half_difference + b_xy * b_xy) * inverse_A * inverse_A;
    const T ratio = artanh_over<T>(z2);
    h_squared = 0.25 * z2 * ratio * ratio;
    slope = ratio * inverse_A;
  }

  /// dev e : dev e.
  T deviator_squared() const { return 6.0 * mean * mean + 2.0 * h_squared; }
  /// Square of sqrt(3/2) |dev tau| for the Kirchhoff stress tau of a shear modulus.
  T equivalent_stress_squared(T shear_modulus) const {
    return 6.0 * shear_modulus * shear_modulus * deviator_squared();
  }

  /// Inverse plastic metric after an exponential return (Weber and Anand 1990, Comput. Methods Appl. Mech. Eng. 79,
  /// 173-202) that scales dev e by r and reduces tr e by `plastic_volume`. With S(y) = sinh(y)/y
  ///
  ///     b_new = c1 1 + c2 b,   c2 = g r S(2 r h)/S(2 h),   g = exp(2 (r - 1) mean - 2/3 plastic_volume),
  ///
  /// tr b_new/2 = g sqrt(det b) cosh(2 r h), and C_new = F^-1 b_new F^-T = c1 (F^T F)^-1 + c2 C.
  PlaneMetric<T> returned(const Tensor<T>& F, const PlaneMetric<T>& C, T r, T plastic_volume) const {
    const T g = exponential_of_small<T>(2.0 * (r - 1.0) * mean - 2.0 / 3 * plastic_volume);
    const T root = J * square_root<T>(C.xx * C.yy - C.xy * C.xy);  // of det b in the plane; slope root = 1/S(2 h)
    const auto [cosh, S] = hyperbolic<T>(4.0 * r * r * h_squared);
    const T c2 = g * r * S * slope * root, c1 = (g * root * cosh - c2 * half_trace) * inverse_J * inverse_J;
    return {c1 * (F.xy * F.xy + F.yy * F.yy) + c2 * C.xx, c2 * C.xy - c1 * (F.xx * F.xy + F.yx * F.yy),
            c1 * (F.xx * F.xx + F.yx * F.yx) + c2 * C.yy};
  }

  /// First Piola stress of the Kirchhoff stress pressure 1 + 2 shear dev e; `pressure`: tension positive.
  Tensor<T> piola(const Tensor<T>& F, T pressure, T shear) const {
    const T s = shear * slope, p = pressure + 2.0 * shear * mean - s * half_trace;
    const T xx = (p + s * b_xx) * inverse_J, xy = s * b_xy * inverse_J, yy = (p + s * b_yy) * inverse_J;
    return {xx * F.yy - xy * F.xy, xy * F.xx - xx * F.yx, xy * F.yy - yy * F.xy, yy * F.xx - xy * F.yx};
  }
};

template <class T>
PlaneMetric<T> select_metric(auto mask, const PlaneMetric<T>& yes, const PlaneMetric<T>& no) {
  return {select(mask, yes.xx, no.xx), select(mask, yes.xy, no.xy), select(mask, yes.yy, no.yy)};
}

}  // namespace pliant
