#pragma once

#include "core/elementary_functions.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Neo-Hookean solid with a quadratic volume term (METHOD 3), no logarithm in the stress:
/// psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (J - 1)^2,  P = mu F + (lambda (J - 1) - mu/J) cof F.
struct NeoHookeanQuadratic {
  template <class T>
  static Response<T> stress(const Tensor<T>& F, T mu, T lambda) {
    const T J = determinant(F);
    return {combine<T>(mu, F, lambda * (J - 1.0) - mu / J), J};
  }

  template <class T>
  static T energy(const Tensor<T>& F, T mu, T lambda) {
    const T J = determinant(F);
    return 0.5 * mu * (first_invariant(F) - 3.0 - 2.0 * natural_log(J)) + 0.5 * lambda * (J - 1.0) * (J - 1.0);
  }

  static double sigma_zz(const Tensor<double>& F, double, double lambda) { return lambda * (determinant(F) - 1.0); }
};

}  // namespace pliant
