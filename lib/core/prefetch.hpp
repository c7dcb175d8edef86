#pragma once

namespace pliant {

/// Asks for numbers of a field's x and y, from one on, before they are looked at.
template <class Field>
void prefetch_run(const Field& field, int first, int count) {
  constexpr int per_line = 8;
  for (int i = 0; i < count; i += per_line) {
    __builtin_prefetch(field.x.data() + first + i);
    __builtin_prefetch(field.y.data() + first + i);
  }
}

}  // namespace pliant
