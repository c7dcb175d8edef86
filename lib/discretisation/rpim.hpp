#pragma once

#include "discretisation/basis.hpp"
#include "discretisation/mls.hpp"

namespace pliant {

/// Radial point interpolation (Wang and Liu 2002, doi 10.1002/nme.489): multiquadrics (r^2 + c^2)^q with c one mean
/// node distance and q = 1.03, and a linear basis, through the nodes whose supports contain the point, by distances
/// through the body. It interpolates, and jumps where the set of nodes changes: for comparison only (docs/method.md 2).
/// Lengths in mean node distances.
Basis radial_point_interpolation(const MlsNodes& nodes);

}  // namespace pliant
