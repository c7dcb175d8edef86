#pragma once

#include "core/elementary_functions.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Compressible neo-Hookean solid in plane strain (METHOD 3):
/// psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2,  P = mu F + (lambda ln J - mu)/J cof F.  mu, lambda in Pa.
struct NeoHookean {
  template <class T>
  static Response<T> stress(const Tensor<T>& F, T mu, T lambda) {
    const T J = determinant(F);
    return {combine<T>(mu, F, (lambda * natural_log(J) - mu) / J), J};
  }

  /// Strain energy per reference volume, J/m3.
  template <class T>
  static T energy(const Tensor<T>& F, T mu, T lambda) {
    const T log_J = natural_log(determinant(F));
    return 0.5 * mu * (first_invariant(F) - 3.0 - 2.0 * log_J) + 0.5 * lambda * log_J * log_J;
  }

  /// Out-of-plane Cauchy stress, Pa (from dpsi/dF33 at F33 = 1).
  static double sigma_zz(const Tensor<double>& F, double, double lambda) {
    const double J = determinant(F);
    return lambda * std::log(J) / J;
  }
};

}  // namespace pliant
