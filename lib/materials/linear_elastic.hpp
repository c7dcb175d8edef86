#pragma once

#include "materials/elastic_constants.hpp"
#include "materials/respond.hpp"

namespace pliant {

/// Linear elasticity in plane strain, for checks at small strains only: psi = mu e:e + lambda/2 (tr e)^2,
/// P = 2 mu e + lambda tr(e) I with the strain e = sym(F - I). Not objective: a rotation by r counts as a strain of
/// r^2/2, so bodies must start without rotation (F = I) and hardly rotate.
template <class T>
struct LinearElastic : LameLaw<LinearElastic, T> {
  using LameConstants<T>::mu, LameConstants<T>::lambda;

  Response<T> respond(const Tensor<T>& F) const {
    const T shear = mu * (F.xy + F.yx), volume = lambda * (F.xx + F.yy - 2.0);
    return {{2.0 * mu * (F.xx - 1.0) + volume, shear, shear, 2.0 * mu * (F.yy - 1.0) + volume}, determinant(F)};
  }

  T energy(const Tensor<T>& F) const {
    const T xx = F.xx - 1.0, yy = F.yy - 1.0, xy = 0.5 * (F.xy + F.yx);
    return mu * (xx * xx + yy * yy + 2.0 * xy * xy) + 0.5 * lambda * (xx + yy) * (xx + yy);
  }

  double sigma_zz(const Tensor<double>& F) const { return lambda * (F.xx + F.yy - 2.0); }
};

}  // namespace pliant
