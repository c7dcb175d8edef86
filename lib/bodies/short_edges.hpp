#pragma once

#include <optional>
#include <string>

#include "bodies/model.hpp"

namespace pliant {

/// Sentence on the shortest edge of a compliant outline, over its mean; none if all edges are a tenth of it or more.
std::optional<std::string> of_short_edges(const Model& model);

}  // namespace pliant
