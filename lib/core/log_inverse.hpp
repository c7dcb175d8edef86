#pragma once

#include <cmath>

#include "core/lanes.hpp"

namespace pliant {

/// ln x and 1/x together, for one division.
template <class T>
struct LogInverse {
  T log, inverse;
};

/// Scalars of any kind, complex numbers for complex-step checks among them.
template <class T>
LogInverse<T> log_inverse(T x) {
  using std::log;
  return {log(x), T(1) / x};
}

/// All lanes at once, for positive normal x; relative error below 6e-16 also near x = 1.
/// x = 2^e m with m in [1/sqrt 2, sqrt 2), ln m = 2 artanh s with s = (m - 1)/(m + 1), |s| < 0.172, as its power series to s^21.
template <>
inline LogInverse<Lanes> log_inverse(Lanes x) {
  constexpr std::int64_t root_half_bits = 0x3fe6a09e667f3bcd;
  constexpr double ln2 = 0.693147180559945309417;
  LaneBits bits;
  std::memcpy(&bits, &x, sizeof bits);
  const LaneBits exponent = (bits - root_half_bits) >> 52;
  const LaneBits mantissa_bits = bits - (exponent << 52);
  const LaneBits scale_bits = (1023 - exponent) << 52;
  Lanes m, scale;
  std::memcpy(&m, &mantissa_bits, sizeof m);
  std::memcpy(&scale, &scale_bits, sizeof scale);
  const Lanes r = 1.0 / (m * (m + 1.0));
  const Lanes s = (m - 1.0) * m * r;
  const Lanes s2 = s * s;
  Lanes series = broadcast(1.0 / 21.0);
  for (int odd = 19; odd >= 3; odd -= 2) series = series * s2 + 1.0 / odd;
  const Lanes e = __builtin_convertvector(exponent, Lanes);
  return {e * ln2 + (2.0 * s + 2.0 * s * s2 * series), r * (m + 1.0) * scale};
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
