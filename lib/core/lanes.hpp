#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace pliant {

/// Eight doubles handled as one vector: a lane is one body of a batch (bodies/) or one outline node (contact/).
inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(64)));
using LaneBits = std::int64_t __attribute__((vector_size(64)));  ///< comparison results and bit patterns

/// Allocator for arrays whose vectors begin at cache lines: others take two lines each. New entries have no value, so
/// that the threads that use them write them first: the system then gives out pages to all of them at once, near to
/// each.
template <class T>
struct LineAllocator : std::allocator<T> {
  LineAllocator() = default;
  template <class Other>
  explicit LineAllocator(const LineAllocator<Other>&) {}
  T* allocate(std::size_t count) {
    void* memory = ::operator new(count * sizeof(T), alignment);
#ifndef NDEBUG
    std::memset(memory, 0xff, count * sizeof(T));  // NaN, for what is read before it is written
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, alignment); }
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Arguments>
  void construct(U* at, Arguments&&... arguments) {
    std::construct_at(at, std::forward<Arguments>(arguments)...);
  }

 private:
  static constexpr std::align_val_t alignment{64};
};
using LinedNumbers = std::vector<double, LineAllocator<double>>;

/// This count rounded up to whole lanes.
inline int padded(int count) { return (count + lane_count - 1) / lane_count * lane_count; }

inline Lanes broadcast(double value) { return value - Lanes{}; }

inline Lanes load(const double* from) {
  Lanes value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

inline LaneBits load(const std::int64_t* from) {
  LaneBits value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

inline void store(double* to, Lanes value) { std::memcpy(to, &value, sizeof value); }

inline Lanes select(LaneBits mask, Lanes yes, Lanes no) { return mask ? yes : no; }
inline bool any(bool mask) { return mask; }
template <class T>
T select(bool mask, T yes, T no) {
  return mask ? yes : no;
}
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

/// 1 / sqrt(a) with a relative error of 2e-16, for a > 0.
inline Lanes inverse_sqrt(Lanes a) {
#if defined(__AVX512F__)
  Lanes y = reinterpret_cast<Lanes>(_mm512_rsqrt14_pd(reinterpret_cast<__m512d>(a)));  // 14 bits, doubled twice
  const Lanes half = 0.5 * a;
  y += y * (0.5 - half * y * y);
  return y + y * (0.5 - half * y * y);
#else
  return 1.0 / sqrt(a);
#endif
}

/// Applies a function of one number to each lane, one after the other.
template <class Function>
Lanes in_each_lane(Lanes a, Function&& function) {
  for (int lane = 0; lane < lane_count; ++lane) a[lane] = function(a[lane]);
  return a;
}
template <class Function>
double in_each_lane(double a, Function&& function) {
  return function(a);
}

/// Nearest integer for |a| < 2^51, ties to even.
inline Lanes round_to_integer(Lanes a) {
  constexpr double magic = 6755399441055744.0;  // 1.5 x 2^52: the sum's last bit is the unit
  const Lanes shifted = a + magic;
  return shifted - magic;
}

/// Exponents of powers of two below 2^52.
inline Lanes exponent_of(LaneBits power) {
  return __builtin_convertvector((std::bit_cast<LaneBits>(__builtin_convertvector(power, Lanes)) >> 52) - 1023, Lanes);
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

/// One bit per lane, lane 0 the lowest.
inline unsigned bits(LaneBits mask) {
#if defined(__clang__)
  using Bools = bool __attribute__((ext_vector_type(8)));
  return __builtin_bit_cast(unsigned char, __builtin_convertvector(mask != 0, Bools));
#else
  unsigned result = 0;
  for (unsigned lane = 0; lane < lane_count; ++lane) result |= (mask[lane] != 0) << lane;
  return result;
#endif
}

/// Calls visit(lane) for the lanes that are set, in order.
template <class Visit>
void for_each_lane(LaneBits mask, Visit&& visit) {
  for (unsigned left = bits(mask); left != 0; left &= left - 1) visit(std::countr_zero(left));
}

/// Adds one lane after the other, so that a sum depends on the order of its terms and not on the start of each eight.
inline void add_in_order(Lanes terms, double& sum) {
  for_each_lane(terms != 0.0, [&](int lane) { sum += terms[lane]; });
}

/// Mask of the first `count` lanes.
inline LaneBits first_lanes(int count) {
  const LaneBits index = {0, 1, 2, 3, 4, 5, 6, 7};
  return index < static_cast<std::int64_t>(count);
}

/// columns[i][j] = rows[j][i].
inline void transpose(const Lanes (&rows)[8], Lanes (&columns)[8]) {
  Lanes pairs[8], quads[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < 8; i += 4)
    for (int j = 0; j < 2; ++j) {
      quads[i + j] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      quads[i + j + 2] = __builtin_shufflevector(pairs[i + j], pairs[i + j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int j = 0; j < 4; ++j) {
    columns[j] = __builtin_shufflevector(quads[j], quads[j + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    columns[j + 4] = __builtin_shufflevector(quads[j], quads[j + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// Entries of a table of 16 numbers, one per lane; indices in [0, 16).
inline Lanes look_up(const double* table, LaneBits index) {
#if defined(__AVX512F__)
  return reinterpret_cast<Lanes>(_mm512_permutex2var_pd(reinterpret_cast<__m512d>(load(table)),
                                                        reinterpret_cast<__m512i>(index),
                                                        reinterpret_cast<__m512d>(load(table + lane_count))));
#else
  Lanes result;
  for (int lane = 0; lane < lane_count; ++lane) result[lane] = table[index[lane]];
  return result;
#endif
}

/// Entries of any table, one per lane.
inline Lanes gather(const double* table, LaneBits index) {
#if defined(__AVX512F__)
  return reinterpret_cast<Lanes>(_mm512_i64gather_pd(reinterpret_cast<__m512i>(index), table, sizeof(double)));
#else
  Lanes result;
  for (int lane = 0; lane < lane_count; ++lane) result[lane] = table[index[lane]];
  return result;
#endif
}

/// Sum in a fixed order: ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7)).
inline double sum(Lanes a) {
  a += __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6);
  a += __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5);
  return a[0] + a[4];
}

inline double largest(Lanes a) {
  a = max(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
  a = max(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
  return a[0] > a[1] ? a[0] : a[1];
}

/// Largest of these values and `least`, none of them NaN.
inline double largest(std::span<const double> values, double least) {
  Lanes worst = broadcast(least);
  std::size_t i = 0;
  for (; i + lane_count <= values.size(); i += lane_count) worst = max(load(&values[i]), worst);
  double result = largest(worst);
  for (; i < values.size(); ++i) result = values[i] > result ? values[i] : result;
  return result;
}

}  // namespace pliant
