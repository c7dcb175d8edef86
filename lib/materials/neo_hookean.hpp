#pragma once

#include "core/elementary_functions.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Compressible neo-Hookean solid in plane strain (docs/method.md 3):
/// psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2,  P = mu F + (lambda ln J - mu)/J cof F.
template <class T>
struct NeoHookean : LameLaw<NeoHookean, T> {
  using LameConstants<T>::mu, LameConstants<T>::lambda;

  Response<T> respond(const Tensor<T>& F) const {
    const T J = determinant(F);
    return {combine<T>(mu, F, (lambda * natural_log(J) - mu) / J), J};
  }

  /// Strain energy per reference volume, J/m3.
  T energy(const Tensor<T>& F) const {
    const T log_J = natural_log(determinant(F));
    return 0.5 * mu * (first_invariant(F) - 3.0 - 2.0 * log_J) + 0.5 * lambda * log_J * log_J;
  }

  /// Out-of-plane Cauchy stress, Pa (from dpsi/dF33 at F33 = 1).
  double sigma_zz(const Tensor<double>& F) const {
    const double J = determinant(F);
    return lambda * std::log(J) / J;
  }
};

}  // namespace pliant
