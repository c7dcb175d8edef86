#pragma once

#include <string>

#include "scene/scene.hpp"

namespace pliant {

/// One shape function of a disc whose mean node distance is 1.
struct ShapeFunctionRequest {
  DiscretisationSettings settings;
  int nodes = 168;
  int grid = 201;  ///< points along either axis of the square about the disc
};

/// CSV text: the nodes of the disc (rows "node"), and phi of the node nearest to the centre and its gradient on a grid
/// of points inside
/// (rows "value"). Columns kind, x, y, phi, phi_x, phi_y; lengths in mean node distances. Throws InputError.
std::string shape_function_csv(const ShapeFunctionRequest& request);

}  // namespace pliant
