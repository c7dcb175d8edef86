#pragma once

#include <string>
#include <utility>

#include "core/errors.hpp"

namespace pliant {

/// Returns the result of `make`; an InputError from it gets the position in the user's file before its message.
/// `where`: as "scene.toml:12:1"; empty: unknown, as in scenes that code has made.
template <class Make>
decltype(auto) located(const std::string& where, Make&& make) {
  try {
    return std::forward<Make>(make)();
  } catch (const InputError& error) {
    throw where.empty() ? error : InputError(where + ": " + error.what());
  }
}

}  // namespace pliant
