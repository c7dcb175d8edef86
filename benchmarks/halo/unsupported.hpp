#pragma once

#include "bodies/model.hpp"

namespace pliant::halo {

/// Throws InputError for a scene with something that the prototype does not exchange.
void refuse_unsupported(const Model& model);

}  // namespace pliant::halo
