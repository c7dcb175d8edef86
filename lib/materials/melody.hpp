#pragma once

#include "core/elementary_functions.hpp"
#include "materials/elastic_constants.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Hyperelastic law of the code MELODY (docs/method.md 3): psi = K/2 (J - 1)^2 + mu/2 (J^(-2/3) I1 - 3),
/// K = lambda + 2 mu/3; P = mu J^(-2/3) F + (K (J - 1) - mu/3 J^(-5/3) I1) cof F.
template <class T>
struct Melody : LameLaw<Melody, T> {
  using LameConstants<T>::mu, LameConstants<T>::lambda;

  Response<T> respond(const Tensor<T>& F) const {
    const T J = determinant(F);
    const T root = inverse_cube_root(J);
    const T isochoric = mu * root * root;
    const T bulk = lambda + mu * (2.0 / 3.0);
    return {combine<T>(isochoric, F, bulk * (J - 1.0) - isochoric * first_invariant(F) / (3.0 * J)), J};
  }

  T energy(const Tensor<T>& F) const {
    const T J = determinant(F);
    const T root = inverse_cube_root(J);
    const T bulk = lambda + mu * (2.0 / 3.0);
    return 0.5 * bulk * (J - 1.0) * (J - 1.0) + 0.5 * mu * (root * root * first_invariant(F) - 3.0);
  }

  double sigma_zz(const Tensor<double>& F) const {
    const double J = determinant(F);
    const double deviatoric = mu * std::pow(J, -5.0 / 3.0) * (1.0 - first_invariant(F) / 3.0);
    return (lambda + mu * 2.0 / 3.0) * (J - 1.0) + deviatoric;
  }
};

}  // namespace pliant
