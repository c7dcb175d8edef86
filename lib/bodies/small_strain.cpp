#include "bodies/small_strain.hpp"

#include <algorithm>
#include <cmath>

#include "bodies/internal_forces.hpp"

namespace pliant {

double largest_small_strain(const Model& model, const Dofs& position) {
  double largest = 0;
  for (const CompliantGroup& group : model.groups) {
    if (group.law != MaterialLaw::linear_elastic) continue;
    for (const int body : group.bodies)
      for (const Tensor<double>& F : deformation_gradients(model, model.bodies[body], position))
        largest = std::max({largest, std::abs(F.xx - 1), std::abs(F.xy), std::abs(F.yx), std::abs(F.yy - 1)});
  }
  return largest;
}

}  // namespace pliant
