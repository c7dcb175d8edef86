#pragma once

namespace pliant {

/// Asks for numbers before they are looked at.
inline void prefetch_run(const double* numbers, int count) {
  constexpr int per_line = 8;
  for (int i = 0; i < count; i += per_line) __builtin_prefetch(numbers + i);
}

/// Of a field's x and y, from one on.
template <class Field>
void prefetch_run(const Field& field, int first, int count) {
  prefetch_run(field.x.data() + first, count);
  prefetch_run(field.y.data() + first, count);
}

}  // namespace pliant
