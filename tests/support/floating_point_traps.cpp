#include "core/floating_point_traps.hpp"

// In builds with assertions a test program is trapped as the engine and the reference solver are.
namespace {
[[maybe_unused]] const bool trapped = (pliant::trap_floating_point_errors(), true);
}  // namespace
