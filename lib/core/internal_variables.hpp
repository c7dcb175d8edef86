#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "core/lanes.hpp"

namespace pliant {

/// Internal variable of a law, of a material or of contact, which each point keeps from one accepted step to the next.
/// A law lists its variables as `static constexpr InternalVariable internal_variables[]`; laws without them have no
/// record and no cost.
struct InternalVariable {
  const char* name;
  double initial;  ///< value at the start
};

template <class Law>
constexpr bool has_internal_variables = requires { Law::internal_variables; };
template <class Law>
constexpr std::size_t internal_variable_count = 0;
template <class Law>
  requires has_internal_variables<Law>
constexpr std::size_t internal_variable_count<Law> = std::size(Law::internal_variables);

/// Internal variables of one point (T: double), or of eight (Lanes).
template <class Law, class T = Lanes>
using Record = std::array<T, internal_variable_count<Law>>;

/// Index in the record of the variable with this name; -1: the law has none.
template <class Law>
constexpr int index_of_internal_variable(std::string_view name) {
  if constexpr (has_internal_variables<Law>)
    for (std::size_t k = 0; k < internal_variable_count<Law>; ++k)
      if (Law::internal_variables[k].name == name) return static_cast<int>(k);
  return -1;
}

}  // namespace pliant
