#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// 3D Lame constants, Pa.
template <class T>
struct LameConstants {
  T mu, lambda;
};

inline LameConstants<double> lame_constants(double young, double poisson) {
  return {young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))};
}
inline LameConstants<double> lame_constants(const Material& material) {
  return lame_constants(material.young, material.poisson);
}

/// Base of laws whose only constants are these two: `of`, `weighted` and `small_strains` (materials/respond.hpp).
template <template <class> class Law, class T>
struct LameLaw : LameConstants<T> {
  static Law<T> of(const Material& material) { return {{lame_constants(material)}}; }
  template <class W>
  Law<T> weighted(W w) const {
    return {{{w * this->mu, w * this->lambda}}};
  }
  LameConstants<T> small_strains() const { return *this; }
};

}  // namespace pliant
