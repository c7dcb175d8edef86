#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace pliant {

// The standard fixes the bits of its engines, not those of its distributions. These distributions are the same on every
// machine.

/// Uniform in [0, 1).
inline double uniform_number(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Separate engine for each purpose, so that a change of one leaves the others unchanged.
inline std::mt19937_64 random_stream(std::uint64_t seed, std::uint64_t purpose) {
  return std::mt19937_64(seed + purpose * 0x9E3779B97F4A7C15);  // odd: purposes are far apart for any seeds
}

template <class Entry>
void shuffle(std::vector<Entry>& entries, std::mt19937_64& random) {
  for (std::size_t i = entries.size(); i > 1; --i) std::swap(entries[i - 1], entries[random() % i]);
}

/// Index of the share of each of `count` items: exact shares, rounded, in random order. Shares sum to 1.
inline std::vector<int> assign_shares(const std::vector<double>& shares, int count, std::mt19937_64& random) {
  std::vector<int> choice;
  double share = 0;
  for (std::size_t m = 0; m < shares.size(); ++m) {
    share += shares[m];
    const bool last = m + 1 == shares.size();
    const int upto = last ? count : static_cast<int>(std::lround(share * count));
    choice.resize(std::max<std::size_t>(choice.size(), static_cast<std::size_t>(upto)), static_cast<int>(m));
  }
  shuffle(choice, random);
  return choice;
}

}  // namespace pliant
