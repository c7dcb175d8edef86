#pragma once

#include "discretisation/basis.hpp"

namespace pliant {

/// Row-sum lumped mass at density 1, [nodes]: the integrals of the shape functions, 6 Gauss points a triangle whatever
/// the recipe's own points (METHOD 2). Throws InputError when one is not positive.
std::vector<double> lumped_mass(const FieldMesh& mesh, const Basis& basis);

}  // namespace pliant
