#pragma once

#include <cstddef>

namespace pliant {

/// Asks for numbers before they are looked at, by whole lanes: those that begin within a line end in the next.
inline void prefetch_run(const double* numbers, int count) {
  constexpr int per_line = 8;
  for (int i = 0; i < count; i += per_line) __builtin_prefetch(numbers + i);
  __builtin_prefetch(numbers + (count + per_line - 1) / per_line * per_line - 1);
}

/// Of a field's x and y, from one on.
template <class Field>
void prefetch_run(const Field& field, int first, int count) {
  prefetch_run(field.x.data() + first, count);
  prefetch_run(field.y.data() + first, count);
}

/// Lanes that are looked at after a loop, in an order that no processor foresees. Two are asked for in each of its
/// rounds: all at once would hold it up.
template <bool to_be_written>
class Upcoming {
 public:
  Upcoming(const void* first, int count) : first_(static_cast<const char*>(first)), rounds_(first ? count / 2 : 0) {}
  void ask(int round) const {
    if (round >= rounds_) return;
    const char* at = first_ + 2 * line * static_cast<std::size_t>(round);
    __builtin_prefetch(at, to_be_written);
    __builtin_prefetch(at + line, to_be_written);
  }

 private:
  static constexpr std::size_t line = 64;

  const char* first_;
  int rounds_;
};

}  // namespace pliant
