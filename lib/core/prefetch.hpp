#pragma once

#include <cstddef>
#include <cstdint>

namespace pliant {

/// Purpose of prefetched numbers.
enum class Access { read, write };

/// Prefetches all cache lines of a range of numbers, rounded up to whole lanes.
template <Access access = Access::read>
void prefetch_run(const double* numbers, int count) {
  if (count == 0) return;
  constexpr std::uintptr_t line = 64;
  const auto first = reinterpret_cast<std::uintptr_t>(numbers),
             end = first + (sizeof(double) * static_cast<unsigned>(count) + line - 1) / line * line;
  for (std::uintptr_t at = first / line * line; at < end; at += line)
    __builtin_prefetch(reinterpret_cast<const void*>(at), access == Access::write);
}

/// Prefetches a field's x and y from `first` on.
template <Access access = Access::read, class Field>
void prefetch_run(const Field& field, int first, int count) {
  prefetch_run<access>(field.x.data() + first, count);
  prefetch_run<access>(field.y.data() + first, count);
}

/// Prefetches lanes that are needed after a loop, in an order that no processor foresees. Each round of the loop
/// requests two of them: all at once would stall it.
template <Access access>
class Upcoming {
 public:
  Upcoming(const void* first, int count) : first_(static_cast<const char*>(first)), rounds_(first ? count / 2 : 0) {}
  void ask(int round) const {
    if (round >= rounds_) return;
    const char* at = first_ + 2 * line * static_cast<std::size_t>(round);
    __builtin_prefetch(at, access == Access::write);
    __builtin_prefetch(at + line, access == Access::write);
  }

 private:
  static constexpr std::size_t line = 64;

  const char* first_;
  int rounds_;
};

}  // namespace pliant
