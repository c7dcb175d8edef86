#pragma once

#include <cstdint>
#include <cstring>

#include "contact/projection.hpp"
#include "core/lanes.hpp"

namespace pliant {

/// Sets whole lanes to zero.
inline void clear(LinedNumbers& numbers, std::size_t count) {
  if (numbers.size() < count) numbers.resize(count);
  for (std::size_t i = 0; i < count; i += lane_count) store(&numbers[i], Lanes{});
}

/// Reactions on the master's segments: x and y on their first nodes and on their second nodes, adjacent in memory.
class Reactions {
 public:
  void clear(int rows) {
    rows_ = rows;
    pliant::clear(entries_, static_cast<std::size_t>(padded(4 * (rows + 2))));
  }

  /// Adds the reactions to forces that are 0 without contact. The couple balances the moment of a shear that acts at
  /// the gap's distance. It makes the force the exact conjugate of the slip.
  void add(const Projection& p, Lanes fx, Lanes fy, Lanes couple) {
    const Lanes bx = -p.xi * fx + couple * p.tangent_y, by = -p.xi * fy - couple * p.tangent_x;
    double reaction[lane_count][4];
    put_side_by_side(-fx - bx, -fy - by, bx, by, reaction);
    std::int64_t row[lane_count];
    const LaneBits rows = __builtin_convertvector(max(p.row, Lanes{}), LaneBits);
    std::memcpy(row, &rows, sizeof row);
    double* first = entries_.data() + 4;
    for (int lane = 0; lane < lane_count; ++lane) {
      double* at = first + 4 * row[lane];
      Four sum, more;
      std::memcpy(&sum, at, sizeof sum);
      std::memcpy(&more, reaction[lane], sizeof more);
      sum += more;
      std::memcpy(at, &sum, sizeof sum);
    }
  }

  /// Adds the reactions to nodes, from the window's first node on.
  void add_to(double* x, double* y) const {
    const double* first = entries_.data() + 4;
    for (int row = 0; row <= rows_; ++row, first += 4) {
      Two of_row, of_last;
      std::memcpy(&of_row, first, sizeof of_row), std::memcpy(&of_last, first - 2, sizeof of_last);
      const Two sum = of_row + of_last;
      x[row] += sum[0], y[row] += sum[1];
    }
  }

 private:
  using Two = double __attribute__((vector_size(16)));
  using Four = double __attribute__((vector_size(32)));

  /// to[lane] = {a, b, c, d} of the lane.
  static void put_side_by_side(Lanes a, Lanes b, Lanes c, Lanes d, double (&to)[lane_count][4]) {
    const Lanes even[2] = {__builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14),
                           __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14)},
                odd[2] = {__builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15),
                          __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15)};
    const auto put = [&](const Lanes(&of)[2], int lane) {
      const Lanes near = __builtin_shufflevector(of[0], of[1], 0, 1, 8, 9, 2, 3, 10, 11),
                  far = __builtin_shufflevector(of[0], of[1], 4, 5, 12, 13, 6, 7, 14, 15);
      const auto quarter = [](Lanes from, int half, double* out) {
        std::memcpy(out, reinterpret_cast<const char*>(&from) + 32 * half, 32);
      };
      quarter(near, 0, to[lane]), quarter(near, 1, to[lane + 2]);
      quarter(far, 0, to[lane + 4]), quarter(far, 1, to[lane + 6]);
    };
    put(even, 0), put(odd, 1);
  }

  int rows_ = 0;
  LinedNumbers entries_;  ///< [rows and one before][4]
};

}  // namespace pliant
