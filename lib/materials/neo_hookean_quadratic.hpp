#pragma once

#include "core/elementary_functions.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Neo-Hookean solid with a quadratic volume term (docs/method.md 3), no logarithm in the stress:
/// psi = mu/2 (I1 - 3 - 2 ln J) + lambda/2 (J - 1)^2,  P = mu F + (lambda (J - 1) - mu/J) cof F.
template <class T>
struct NeoHookeanQuadratic : LameLaw<NeoHookeanQuadratic, T> {
  using LameConstants<T>::mu, LameConstants<T>::lambda;

  Response<T> respond(const Tensor<T>& F) const {
    const T J = determinant(F);
    return {combine<T>(mu, F, lambda * (J - 1.0) - mu / J), J};
  }

  T energy(const Tensor<T>& F) const {
    const T J = determinant(F);
    return 0.5 * mu * (first_invariant(F) - 3.0 - 2.0 * natural_log(J)) + 0.5 * lambda * (J - 1.0) * (J - 1.0);
  }

  double sigma_zz(const Tensor<double>& F) const { return lambda * (determinant(F) - 1.0); }
};

}  // namespace pliant
