#pragma once

#include <cmath>

#include "core/lanes.hpp"

namespace pliant {

// Functions that laws call at every point and step. For others, and for constants of a step, in_each_lane in
// core/lanes.hpp calls any function lane by lane.

/// Comparison of any scalars: a mask for lanes, else a truth value; complex numbers by their real parts.
template <class T>
auto is_less(T a, T b) {
  if constexpr (requires { a.real(); })
    return a.real() < b.real();
  else
    return a < b;
}

/// Whether both comparisons hold.
inline bool both(bool a, bool b) { return a && b; }
inline LaneBits both(LaneBits a, LaneBits b) { return a & b; }

/// Natural logarithm of any scalar, complex numbers for complex-step checks included.
template <class T>
T natural_log(T x) {
  using std::log;
  return log(x);
}

/// 2 artanh(s)/s as a function of s^2 in [0, 0.02944], |s| <= (sqrt 2 - 1)/(sqrt 2 + 1): minimax polynomial (Remez,
/// relative error 1.3e-18). Its even and its odd powers make two short chains instead of a long one.
template <class T>
T twice_artanh_over_small(T s2) {
  const T s4 = s2 * s2;
  const T even = ((0.1531409801905285 * s4 + 0.22222198610167193) * s4 + 0.39999999999416347) * s4 + 2.0;
  const T odd = ((0.14795483289617054 * s4 + 0.1818356243714162) * s4 + 0.28571428742021504) * s4 + 0.6666666666666734;
  return even + s2 * odd;
}

/// Natural logarithm of all lanes at once, for positive normal x; relative error below 6e-16 also near x = 1. x = 2^e m
/// with m in [1/sqrt 2, sqrt 2), ln m = 2 artanh s with s = (m - 1)/(m + 1).
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
  const Lanes s = (m - 1.0) / (m + 1.0);
  return __builtin_convertvector(exponent, Lanes) * ln2 + s * twice_artanh_over_small(s * s);
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

/// Square root of any scalar.
template <class T>
T square_root(T x) {
  using std::sqrt;
  return sqrt(x);
}
template <>
inline Lanes square_root(Lanes x) {
  return sqrt(x);
}

/// 1/sqrt(x) for x > 0.
template <class T>
T inverse_square_root(T x) {
  return 1.0 / square_root<T>(x);
}
template <>
inline Lanes inverse_square_root(Lanes x) {
  return inverse_sqrt(x);
}

/// Exponential of any scalar.
template <class T>
T exponential(T x) {
  using std::exp;
  return exp(x);
}

/// Exponential of all lanes at once; relative error below 4e-16. Arguments beyond 700 count as 700. x = n ln 2 + r with
/// |r| <= 0.347, and exp r is its Taylor polynomial of degree 13, whose remainder is 4e-18.
template <>
inline Lanes exponential(Lanes x) {
  constexpr double inverse_ln2 = 1.442695040888963407360, ln2_high = 6.93147180369123816490e-1,
                   ln2_low = 1.90821492927058770002e-10;  // the high part times n < 2^20 is exact
  x = max(min(x, broadcast(700)), broadcast(-700));
  const Lanes n = round_to_integer(x * inverse_ln2);
  const Lanes r = (x - n * ln2_high) - n * ln2_low;
  const Lanes r2 = r * r;  // even and odd powers make two short chains
  const Lanes even =
      ((((r2 * (1.0 / 479001600) + 1.0 / 3628800) * r2 + 1.0 / 40320) * r2 + 1.0 / 720) * r2 + 1.0 / 24) * r2 + 0.5;
  const Lanes odd =
      (((((r2 * (1.0 / 6227020800) + 1.0 / 39916800) * r2 + 1.0 / 362880) * r2 + 1.0 / 5040) * r2 + 1.0 / 120) * r2 +
       1.0 / 6) *
          r2 +
      1.0;
  const Lanes sum = 1.0 + (r2 * even + r * odd);
  const LaneBits power = (__builtin_convertvector(n, LaneBits) + 1023) << 52;
  return sum * std::bit_cast<Lanes>(power);
}

/// Exponential of a small argument, |x| <= 1/256 in all lanes, or it takes the time of `exponential`. Relative error
/// below 4e-16; the remainder of the polynomial is 5e-18.
template <class T>
T exponential_of_small(T x) {
  constexpr double limit = 1.0 / 256;
  const T x2 = x * x;
  if (any(is_less(T{} + limit * limit, x2))) [[unlikely]]
    return exponential<T>(x);
  return 1.0 + (x2 * (x2 * (1.0 / 24) + 0.5) + x * ((x2 * (1.0 / 120) + 1.0 / 6) * x2 + 1.0));
}

/// Hyperbolic functions of y by y^2.
template <class T>
struct Hyperbolic {
  T cosh, sinh_over_y;
};

/// cosh(y) and sinh(y)/y as functions of y^2, for any y^2 >= 0; relative errors below 2e-15.
template <class T>
Hyperbolic<T> hyperbolic(T y2) {
  constexpr double series_limit = 0.1;  // remainders of the series 1e-18
  T cosh{}, sinh{};
  for (const double factorial : {479001600.0, 3628800.0, 40320.0, 720.0, 24.0, 2.0, 1.0})
    cosh = cosh * y2 + 1.0 / factorial;
  for (const double factorial : {6227020800.0, 39916800.0, 362880.0, 5040.0, 120.0, 6.0, 1.0})
    sinh = sinh * y2 + 1.0 / factorial;
  const auto is_large = is_less(T{} + series_limit, y2);
  if (!any(is_large)) [[likely]]
    return {cosh, sinh};
  const T y = square_root<T>(select(is_large, y2, T{} + series_limit)), up = exponential<T>(y), down = 1.0 / up;
  return {select(is_large, 0.5 * (up + down), cosh), select(is_large, 0.5 * (up - down) / y, sinh)};
}

/// The same of small arguments, |y| <= 1/256 in all lanes, or it takes the time of `hyperbolic`. Relative errors below
/// 4e-16; the remainders of the series are 5e-18.
template <class T>
Hyperbolic<T> hyperbolic_of_small(T y2) {
  constexpr double limit = 1.0 / 256;
  if (any(is_less(T{} + limit * limit, y2))) [[unlikely]]
    return hyperbolic<T>(y2);
  return {(y2 * (1.0 / 24) + 0.5) * y2 + 1.0, (y2 * (1.0 / 120) + 1.0 / 6) * y2 + 1.0};
}

/// artanh(z)/z as a function of z^2 in [0, 1); relative error below 4e-15.
template <class T>
T artanh_over(T z2) {
  constexpr double series_limit = 0.0294;
  const T series = 0.5 * twice_artanh_over_small<T>(z2);
  const auto is_large = is_less(T{} + series_limit, z2);
  if (!any(is_large)) [[likely]]
    return series;
  z2 = select(is_large, z2, T{} + series_limit);
  const T z = square_root<T>(z2);
  return select(is_large, 0.5 * natural_log<T>((1.0 + z) * (1.0 + z) / (1.0 - z2)) / z, series);
}

}  // namespace pliant
