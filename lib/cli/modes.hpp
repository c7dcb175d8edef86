#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace pliant {

struct ModesRequest {
  int count = 10;                  ///< frequencies a body
  std::string body;                ///< a body's or a set of grains' name; empty: all compliant ones
  std::filesystem::path json;      ///< file for the same figures; empty: none
  std::filesystem::path matrices;  ///< folder for stiffness and inverse mass in Matrix Market format; empty: none
};

/// `pliant modes`: prints natural frequencies of the scene's compliant bodies at their start, once for each shape, size
/// and material; nothing touches, loads or damps them. Throws InputError for scenes and names without compliant bodies
/// and for too many nodes.
void print_modes(const Scene& scene, const ModesRequest& request);

}  // namespace pliant
