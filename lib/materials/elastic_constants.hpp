#pragma once

namespace pliant {

/// 3D Lame constants, Pa.
struct LameConstants {
  double mu, lambda;
};

inline LameConstants lame_constants(double young, double poisson) {
  return {young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))};
}

}  // namespace pliant
