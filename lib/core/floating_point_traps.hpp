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

/// While it lives, nothing is trapped: for input, which may hold any number and is checked.
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
