#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// `pliant check`: prints bodies, nodes, DOFs, masses, stable time step and what governs it, memory, output size, estimated evaluations and time.
void print_check(const Scene& scene, int threads);

}  // namespace pliant
