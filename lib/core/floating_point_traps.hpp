#pragma once

#include <cfenv>

namespace pliant {

/// In builds with assertions a number that comes to nothing stops the program where it does: a division by zero, an
/// overflow, what is not a number made or compared. Threads that start later do as the one that starts them.
inline void trap_floating_point_errors() {
#ifndef NDEBUG
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
#endif
}

}  // namespace pliant
