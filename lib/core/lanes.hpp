#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace pliant {

/// Eight doubles handled as one: a lane is one body of a batch (bodies/) or one outline node (contact/).
inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(64)));
using LaneBits = std::int64_t __attribute__((vector_size(64)));  ///< comparison results and bit patterns

inline Lanes broadcast(double value) { return value - Lanes{}; }

inline Lanes load(const double* from) {
  Lanes value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

inline void store(double* to, Lanes value) { std::memcpy(to, &value, sizeof value); }

inline Lanes select(LaneBits mask, Lanes yes, Lanes no) { return mask ? yes : no; }
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes abs(Lanes a) { return max(a, -a); }

inline Lanes sqrt(Lanes a) {
#if defined(__clang__)
  return __builtin_elementwise_sqrt(a);
#else
  for (int lane = 0; lane < lane_count; ++lane) a[lane] = std::sqrt(a[lane]);
  return a;
#endif
}

/// Nearest integer for |a| < 2^51, ties to even.
inline Lanes round_to_integer(Lanes a) {
  constexpr double magic = 6755399441055744.0;  // 1.5 x 2^52: the sum's last bit is the unit
  const Lanes shifted = a + magic;
  return shifted - magic;
}

inline bool any(LaneBits mask) {
#if defined(__clang__)
  return __builtin_reduce_or(mask) != 0;
#else
  std::int64_t result = 0;
  for (int lane = 0; lane < lane_count; ++lane) result |= mask[lane];
  return result != 0;
#endif
}

/// Mask of the first `count` lanes.
inline LaneBits first_lanes(int count) {
  const LaneBits index = {0, 1, 2, 3, 4, 5, 6, 7};
  return index < static_cast<std::int64_t>(count);
}

/// Sum in a fixed order.
inline double sum(Lanes a) { return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7])); }

inline double largest(Lanes a) {
  double result = a[0];
  for (int lane = 1; lane < lane_count; ++lane) result = a[lane] > result ? a[lane] : result;
  return result;
}

}  // namespace pliant
