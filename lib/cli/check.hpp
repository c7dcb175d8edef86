#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// `pliant check`: prints bodies, nodes, DOFs, masses, contact stiffness and what it costs, stable time step and what
/// governs it, estimated evaluations and time, memory, output size. Runs the scene for at most a second to measure;
/// writes nothing. Throws as a run would.
void print_check(const Scene& scene, int threads);

}  // namespace pliant
