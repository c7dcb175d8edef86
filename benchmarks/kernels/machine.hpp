#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace pliant::kernels {

/// Where data of some size are read from.
enum class Level { l1, l2, l3, memory };
constexpr std::array level_names{"l1", "l2", "l3", "memory"};

/// Of data that each thread has to itself, bytes.
Level level_of(double bytes_a_thread);

/// What this machine can do, flops/s and bytes/s of all threads together: the best of some tries.
double fma_peak(int threads);
double read_bandwidth(Level level, int threads);
/// A benchmark of machine/ may have been disturbed less: then its rates hold.
void take_note(const std::string& benchmark, int threads, double flop_rate, double read_rate);

}  // namespace pliant::kernels
