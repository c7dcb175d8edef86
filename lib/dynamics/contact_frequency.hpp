#pragma once

#include <functional>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// Bound of w^2 that springs of this stiffness, [outline nodes], N/m2, give a body, 1/s2.
double contact_frequency(const Model& model, const Body& body, const double* stiffness);

/// Adds the stiffness of springs on a body's outline nodes, N/m2, to every `stride`-th number.
using AddStiffness = std::function<void(int body, double* to, int stride)>;
/// The same of these bodies, into theirs of all: compliant ones of one shape by eights.
void find_contact_frequencies(const Model& model, const std::vector<int>& bodies, const AddStiffness& add_stiffness,
                              std::vector<double>& frequencies);

}  // namespace pliant
