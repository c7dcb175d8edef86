#pragma once

#include <algorithm>

#include "reference/system.hpp"

namespace pliant::reference_tests {

/// Largest difference of matrix columns from central differences of the residual, over the largest entry.
inline double tangent_error(reference::System& system, const reference::Motion& motion, bool by_positions,
                            double step) {
  const reference::Forces at = system.evaluate(motion, true);
  const Eigen::MatrixXd exact = by_positions ? at.stiffness : at.viscosity;
  double worst = 0;
  for (int j = 0; j < exact.cols(); ++j) {
    reference::Motion up = motion, down = motion;
    (by_positions ? up.q : up.v)[j] += step;
    (by_positions ? down.q : down.v)[j] -= step;
    const reference::Vector difference =
        (system.evaluate(up, false).residual - system.evaluate(down, false).residual) / (2 * step);
    worst = std::max(worst, (difference - exact.col(j)).cwiseAbs().maxCoeff());
  }
  return worst / exact.cwiseAbs().maxCoeff();
}

}  // namespace pliant::reference_tests
