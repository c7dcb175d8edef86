#include "run/default_threads.hpp"

#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::string line_of(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream(file) >> std::ws, line);
  return line;
}

double cores_by_quota(double quota, double period) {
  return quota > 0 && period > 0 ? quota / period : std::numeric_limits<double>::infinity();
}

/// Processors' time that a control group grants in each period: cpu.max of version 2, two files of version 1.
double granted(const fs::path& group) {
  double quota = 0, period = 0;
  if (std::istringstream(line_of(group / "cpu.max")) >> quota >> period) return cores_by_quota(quota, period);
  quota = std::atof(line_of(group / "cpu.cfs_quota_us").c_str());
  return cores_by_quota(quota, std::atof(line_of(group / "cpu.cfs_period_us").c_str()));
}

/// The least that this process's groups and those above them grant.
double least_granted(const fs::path& root) {
  double least = std::numeric_limits<double>::infinity();
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (controllers != ",," && controllers.find(",cpu,") == std::string::npos) continue;
    const fs::path mount = root / "sys/fs/cgroup" / (controllers == ",," ? "" : "cpu");
    fs::path group = fs::path(line.substr(second + 1)).relative_path();
    for (; !group.empty(); group = group.parent_path()) least = std::min(least, granted(mount / group));
    least = std::min(least, granted(mount));
  }
  return least;
}

std::vector<int> processors_of_process() {
  cpu_set_t set;
  std::vector<int> processors;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return processors;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &set)) processors.push_back(cpu);
  return processors;
}

}  // namespace

int threads_for(const std::vector<int>& processors, const fs::path& root) {
  std::set<std::string> cores;
  for (int cpu : processors) {
    const std::string name = "cpu" + std::to_string(cpu);
    const std::string siblings = line_of(root / "sys/devices/system/cpu" / name / "topology/thread_siblings_list");
    cores.insert(siblings.empty() ? name : siblings);
  }
  const double most = std::ceil(least_granted(root));
  return std::max(1, static_cast<int>(std::min<double>(static_cast<double>(cores.size()), most)));
}

void set_threads(int threads) {
  if (threads > 0) return omp_set_num_threads(threads);
  if (std::getenv("OMP_NUM_THREADS") || std::getenv("OMP_PLACES")) return;  // OpenMP has read them
  const std::vector<int> processors = processors_of_process();  // unknown where there are too many for the set
  if (!processors.empty()) omp_set_num_threads(threads_for(processors));
}

}  // namespace pliant
