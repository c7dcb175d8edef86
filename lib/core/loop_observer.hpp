#pragma once

#include <source_location>

namespace pliant {

/// Where a loop stands in the source.
using LoopPlace = std::source_location;

/// How threads share the iterations of a loop (core/parallel.hpp).
struct LoopShares {
  int count = 0;              ///< iterations
  int turn = 0;               ///< threads take so many in turn; 0: one contiguous share each
  const int* cost = nullptr;  ///< [count + 1] sums of the cost of all iterations before; null: all cost the same
};

/// Sees the parallel loops of a program on one thread that measures them (benchmarks/scaling). Runs have none.
class LoopObserver {
 public:
  virtual ~LoopObserver() = default;
  /// A loop begins. Returns how many iterations make a chunk, at least 1, of a loop in contiguous shares; else a chunk
  /// is a turn.
  virtual int begin_loop(const LoopPlace& place, const LoopShares& shares) = 0;
  virtual void end_chunk() = 0;
  /// All loops since the last call ran in one parallel region.
  virtual void end_region() = 0;
};

inline LoopObserver* loop_observer = nullptr;

}  // namespace pliant
