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

}  // namespace pliant
