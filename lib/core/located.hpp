#pragma once

#include <string>
#include <utility>

#include "core/errors.hpp"

namespace pliant {

/// What `make` returns; an InputError from it gets the place in the user's file before its message. `where`: as
/// "scene.toml:12:1"; empty: not known, as of scenes put together in code.
template <class Make>
decltype(auto) located(const std::string& where, Make&& make) {
  try {
    return std::forward<Make>(make)();
  } catch (const InputError& error) {
    throw where.empty() ? error : InputError(where + ": " + error.what());
  }
}

}  // namespace pliant
