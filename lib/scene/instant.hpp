#pragma once

#include "scene/scene.hpp"

namespace pliant {

/// A time, and from which side a step looks at it. What sets in or ends just then has not done so yet for the step that
/// ends there, and has for the next one.
struct Instant {
  double time = 0;         ///< s
  bool ends_step = false;  ///< else it begins one
};

/// Whether something acts at an instant.
inline bool contains(const Window& window, const Instant& at) {
  return at.ends_step ? window.from < at.time && at.time <= window.until : window.contains(at.time);
}

/// 1/s; at a kink that of the piece on the step's side.
double slope(const History& history, const Instant& at);

}  // namespace pliant
