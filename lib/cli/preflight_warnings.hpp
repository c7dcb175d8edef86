#pragma once

#include <string>
#include <vector>

#include "bodies/model.hpp"

namespace pliant {

/// What polygons and lumped masses change in a scene's mechanics, with figures and what lessens it: a sentence each,
/// none where it does not apply.
std::vector<std::string> preflight_warnings(const Model& model);

}  // namespace pliant
