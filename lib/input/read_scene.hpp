#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace pliant {

/// Reads and validates a scene file. Throws InputError with file, line and column, what was found, what is
/// allowed and the nearest name. Nothing is written.
Scene read_scene(const std::filesystem::path& file);

}  // namespace pliant
