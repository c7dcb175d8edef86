#pragma once

#include <array>
#include <cstddef>

namespace pliant::kernels {

/// Where data of some size are read from.
enum class Level { l1, l2, l3, memory };
constexpr std::array level_names{"l1", "l2", "l3", "memory"};

/// Of data that each thread has to itself, bytes.
Level level_of(double bytes_a_thread);

/// What this machine can do, flops/s and bytes/s of all threads together: the best of some tries, found once.
double fma_peak(int threads);
double read_bandwidth(Level level, int threads);

}  // namespace pliant::kernels
