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
  T half_trace, root;  ///< A, and sqrt(det b) in the plane
  T volume;            ///< tr e
  T mean, h, slope;

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
    root = J * square_root<T>(C.xx * C.yy - C.xy * C.xy);
    const T half_difference = 0.5 * (b_xx - b_yy), inverse_A = 1.0 / half_trace;
    const T z2 = (half_difference * half_difference + b_xy * b_xy) * inverse_A * inverse_A;
    const T ratio = artanh_over<T>(z2);
    h = 0.5 * square_root<T>(z2) * ratio;
    slope = ratio * inverse_A;
  }

  /// dev e : dev e.
  T deviator_squared() const { return 6.0 * mean * mean + 2.0 * h * h; }
  /// sqrt(3/2) |dev tau| for the Kirchhoff stress tau of a shear modulus.
  T equivalent_stress(T shear_modulus) const { return 2.0 * shear_modulus * square_root<T>(1.5 * deviator_squared()); }

  /// Inverse plastic metric after an exponential return (Weber and Anand 1990, Comput. Methods Appl. Mech. Eng. 79,
  /// 173-202) that scales dev e by r and reduces tr e by `plastic_volume`. With S(y) = sinh(y)/y
  ///
  ///     b_new = c1 1 + c2 b,   c2 = g r S(2 r h)/S(2 h),   g = exp(2 (r - 1) mean - 2/3 plastic_volume),
  ///
  /// tr b_new/2 = g sqrt(det b) cosh(2 r h), and C_new = F^-1 b_new F^-T = c1 (F^T F)^-1 + c2 C.
  PlaneMetric<T> returned(const Tensor<T>& F, const PlaneMetric<T>& C, T r, T plastic_volume) const {
    const T g = exponential<T>(2.0 * (r - 1.0) * mean - 2.0 / 3 * plastic_volume);
    const T y = 2.0 * r * h, S = sinh_over<T>(y * y);
    const T c2 = g * r * S * slope * root;  // slope sqrt(det b) = 1/S(2 h)
    const T c1 = (g * root * square_root<T>(1.0 + y * y * S * S) - c2 * half_trace) / (J * J);
    return {c1 * (F.xy * F.xy + F.yy * F.yy) + c2 * C.xx, c2 * C.xy - c1 * (F.xx * F.xy + F.yx * F.yy),
            c1 * (F.xx * F.xx + F.yx * F.yx) + c2 * C.yy};
  }

  /// First Piola stress of the Kirchhoff stress pressure 1 + 2 shear dev e; `pressure`: tension positive.
  Tensor<T> piola(const Tensor<T>& F, T pressure, T shear) const {
    const T s = shear * slope, p = pressure + 2.0 * shear * mean - s * half_trace, inverse = 1.0 / J;
    const T xx = (p + s * b_xx) * inverse, xy = s * b_xy * inverse, yy = (p + s * b_yy) * inverse;
    return {xx * F.yy - xy * F.xy, xy * F.xx - xx * F.yx, xy * F.yy - yy * F.xy, yy * F.xx - xy * F.yx};
  }
};

template <class T>
PlaneMetric<T> select_metric(auto mask, const PlaneMetric<T>& yes, const PlaneMetric<T>& no) {
  return {select(mask, yes.xx, no.xx), select(mask, yes.xy, no.xy), select(mask, yes.yy, no.yy)};
}

}  // namespace pliant
