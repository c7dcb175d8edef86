#pragma once

#include <functional>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Bound of w^2, 1/s2, of a body with springs of this stiffness, [outline nodes], N/m2.
double contact_frequency(const Model& model, const Body& body, const double* stiffness);

/// Adds the stiffness of springs on a body's outline nodes, N/m2, to every `stride`-th number.
using AddStiffness = std::function<void(int body, double* to, int stride)>;
/// The same for these bodies, written to their entries of `frequencies`. Compliant bodies of one shape are computed
/// eight at a time.
void find_contact_frequencies(const Model& model, const std::vector<int>& bodies, const AddStiffness& add_stiffness,
                              std::vector<double>& frequencies);

}  // namespace pliant
