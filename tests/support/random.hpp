#pragma once

#include <cstdint>
#include <random>

namespace pliant::testing {

/// Random numbers that are the same on every platform: the mapping of std::uniform_* is not fixed by the standard.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(generator_() % static_cast<std::uint64_t>(count)); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace pliant::testing
