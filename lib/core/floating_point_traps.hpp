#pragma once

#include <cfenv>

namespace pliant {

/// In builds with assertions an invalid operation stops the program at its place: a division by zero, an overflow, or a
/// number that is not finite, made or compared. Threads that start later inherit this from the thread that starts them.
inline void trap_floating_point_errors() {
#ifndef NDEBUG
  feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
#endif
}

/// Switches traps off during its lifetime: for input, which may contain any number and is checked.
class Untrapped {
 public:
  Untrapped() { std::feholdexcept(&before_); }
  ~Untrapped() { std::fesetenv(&before_); }
  Untrapped(const Untrapped&) = delete;
  Untrapped& operator=(const Untrapped&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace pliant
