#pragma once

#include <filesystem>
#include <vector>

namespace pliant {

/// Number of threads that these processors can run well: one for each core, as hardware threads of a core share its
/// arithmetic units, and no more than the processor time that the control groups of this process grant, rounded up.
/// `root`: of the folders proc and sys. What cannot be read there does not limit.
int threads_for(const std::vector<int>& processors, const std::filesystem::path& root = "/");

/// Sets the number of threads of parallel regions: `threads`, or if it is 0 what OMP_NUM_THREADS or OMP_PLACES ask
/// for, or that for the processors of this process.
void set_threads(int threads);

}  // namespace pliant
