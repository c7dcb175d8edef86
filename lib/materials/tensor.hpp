#pragma once

namespace pliant {

/// Plane second-order tensor, such as the deformation gradient F (F33 = 1) or the first Piola stress P.
template <class T>
struct Tensor {
  T xx, xy, yx, yy;
};

template <class T>
T determinant(const Tensor<T>& F) {
  return F.xx * F.yy - F.xy * F.yx;
}

/// J F^-T.
template <class T>
Tensor<T> cofactor(const Tensor<T>& F) {
  return {F.yy, -F.yx, -F.xy, F.xx};
}

/// F:F + 1, the first invariant of the plane-strain C.
template <class T>
T first_invariant(const Tensor<T>& F) {
  return F.xx * F.xx + F.xy * F.xy + F.yx * F.yx + F.yy * F.yy + 1.0;
}

/// a F + b cof(F): the form of every isotropic plane stress.
template <class T>
Tensor<T> combine(T a, const Tensor<T>& F, T b) {
  return {a * F.xx + b * F.yy, a * F.xy - b * F.yx, a * F.yx - b * F.xy, a * F.yy + b * F.xx};
}

}  // namespace pliant
