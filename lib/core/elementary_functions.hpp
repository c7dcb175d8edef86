#pragma once

#include <cmath>

#include "core/lanes.hpp"

namespace pliant {

// Functions that laws call at every point and step. For others, and for constants of a step, in_each_lane in
// core/lanes.hpp calls any function lane by lane.

/// Natural logarithm of any scalar, complex numbers for complex-step checks included.
template <class T>
T natural_log(T x) {
  using std::log;
  return log(x);
}

/// Natural logarithm of all lanes at once, for positive normal x; relative error below 6e-16 also near x = 1. x = 2^e m
/// with m in [1/sqrt 2, sqrt 2), ln m = 2 artanh s with s = (m - 1)/(m + 1), |s| < 0.172. (2 artanh s)/s is the minimax
/// polynomial in s^2 (Remez, relative error of ln m 1.3e-18); its even and its odd powers make two short chains instead
/// of a long one.
template <>
inline Lanes natural_log(Lanes x) {
  // Unsigned words wrap: trial steps may invert an element, and the result of a negative x is not used.
  using LaneWords = std::uint64_t __attribute__((vector_size(64)));
  constexpr std::uint64_t root_half_bits = 0x3fe6a09e667f3bcd;
  constexpr double ln2 = 0.693147180559945309417;
  LaneWords bits;
  std::memcpy(&bits, &x, sizeof bits);
  const LaneBits exponent = reinterpret_cast<LaneBits>(bits - root_half_bits) >> 52;
  const LaneWords mantissa_bits = bits - (reinterpret_cast<LaneWords>(exponent) << 52);
  Lanes m;
  std::memcpy(&m, &mantissa_bits, sizeof m);
  const Lanes s = (m - 1.0) / (m + 1.0), s2 = s * s, s4 = s2 * s2;
  const Lanes even = ((0.1531409801905285 * s4 + 0.22222198610167193) * s4 + 0.39999999999416347) * s4 + 2.0;
  const Lanes odd =
      ((0.14795483289617054 * s4 + 0.1818356243714162) * s4 + 0.28571428742021504) * s4 + 0.6666666666666734;
  return __builtin_convertvector(exponent, Lanes) * ln2 + s * (even + s2 * odd);
}

/// x^(-1/3): Newton steps from a guess that is linear in the bits.
template <class T>
T inverse_cube_root(T x) {
  using std::pow;
  return pow(x, -1.0 / 3.0);
}

template <>
inline Lanes inverse_cube_root(Lanes x) {
  LaneBits bits;
  std::memcpy(&bits, &x, sizeof bits);
  // For y = x^(-1/3) the bit patterns obey B(y) = 4/3 B(1) - B(x)/3 up to the mantissa's curvature (below 6 %).
  const Lanes guess_bits = 4607182418800017408.0 * (4.0 / 3.0) - __builtin_convertvector(bits, Lanes) * (1.0 / 3.0);
  const LaneBits guess = __builtin_convertvector(guess_bits, LaneBits);
  Lanes y;
  std::memcpy(&y, &guess, sizeof y);
  for (int iteration = 0; iteration < 5; ++iteration) y = y + y * (1.0 - x * y * y * y) * (1.0 / 3.0);
  return y;
}

}  // namespace pliant
