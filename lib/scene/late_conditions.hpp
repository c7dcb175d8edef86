#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace pliant {

/// A text for each condition of an axis, pressure, support or rule of bonds that sets in only when the run is over,
/// with its place in the file.
std::vector<std::string> late_conditions(const Scene& scene);

}  // namespace pliant
