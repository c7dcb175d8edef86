#pragma once

#include <sys/resource.h>

namespace pliant {

/// Largest resident memory of this process so far, bytes.
inline long peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * 1024L;
}

}  // namespace pliant
