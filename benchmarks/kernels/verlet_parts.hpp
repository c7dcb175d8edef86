#pragma once

#include "dynamics/verlet.hpp"

/// Parts of velocity Verlet that only it calls: the benchmarks time them alone.
namespace pliant::kernels {

void predict(Verlet& verlet, const State& state, double dt);
void finish_region(Verlet& verlet, const State& state, double dt, int region);

}  // namespace pliant::kernels
