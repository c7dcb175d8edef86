#include "run/default_threads.hpp"

#include <gtest/gtest.h>

#include <omp.h>
#include <sched.h>
#include <cstdlib>
#include <fstream>
#include <map>

#include "files/temporary_folder.hpp"

namespace pliant {
namespace {

using Files = std::map<std::string, std::string>;

class DefaultThreads : public testing::TemporaryFolder {
 protected:
  /// Of a machine with these files, for four processors.
  int threads_with(const Files& files) {
    std::filesystem::remove_all(folder_);
    for (const auto& [name, text] : files) {
      const std::filesystem::path file = folder_ / name;
      std::filesystem::create_directories(file.parent_path());
      std::ofstream(file) << text << '\n';
    }
    return threads_for({0, 1, 2, 3}, folder_);
  }
};

std::string siblings(int cpu) {
  return "sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/topology/thread_siblings_list";
}

// All EXACT.
TEST_F(DefaultThreads, OneForEachProcessorWhereNothingIsKnown) { EXPECT_EQ(threads_with({}), 4); }

TEST_F(DefaultThreads, OneForEachCore) {
  EXPECT_EQ(threads_with({{siblings(0), "0,2"}, {siblings(1), "1,3"}, {siblings(2), "0,2"}, {siblings(3), "1,3"}}), 2);
  EXPECT_EQ(threads_with({{siblings(0), "0,8"}, {siblings(1), "1,9"}, {siblings(2), "2,10"}, {siblings(3), "3,11"}}),
            4);
}

TEST_F(DefaultThreads, GroupsOfVersion2AndThoseAboveThem) {
  const std::string own = "0::/system/box";
  EXPECT_EQ(threads_with({{"proc/self/cgroup", own}, {"sys/fs/cgroup/system/box/cpu.max", "max 100000"}}), 4);
  EXPECT_EQ(threads_with({{"proc/self/cgroup", own}, {"sys/fs/cgroup/system/box/cpu.max", "150000 100000"}}), 2);
  EXPECT_EQ(threads_with({{"proc/self/cgroup", own},
                          {"sys/fs/cgroup/system/box/cpu.max", "300000 100000"},
                          {"sys/fs/cgroup/system/cpu.max", "100000 100000"}}),
            1);
  EXPECT_EQ(threads_with({{"proc/self/cgroup", "0::/"}, {"sys/fs/cgroup/cpu.max", "20000 100000"}}), 1);
}

TEST_F(DefaultThreads, GroupsOfVersion1) {
  const Files unlimited{{"proc/self/cgroup", "4:memory:/a\n1:cpuacct,cpu:/box"},
                        {"sys/fs/cgroup/cpu/box/cpu.cfs_quota_us", "-1"},
                        {"sys/fs/cgroup/cpu/box/cpu.cfs_period_us", "100000"}};
  EXPECT_EQ(threads_with(unlimited), 4);
  Files limited = unlimited;
  limited["sys/fs/cgroup/cpu/box/cpu.cfs_quota_us"] = "300000";
  EXPECT_EQ(threads_with(limited), 3);
}

/// Places that OpenMP makes by itself are no request.
TEST_F(DefaultThreads, AreThoseOfTheProcessors) {
  cpu_set_t set;
  ASSERT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
  std::vector<int> processors;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(cpu, &set)) processors.push_back(cpu);
  const int before = omp_get_max_threads();
  const char* named = std::getenv("OMP_NUM_THREADS");
  const std::string kept = named ? named : "";
  ::unsetenv("OMP_NUM_THREADS");
  set_threads(0);
  if (!std::getenv("OMP_PLACES")) EXPECT_EQ(omp_get_max_threads(), threads_for(processors));
  set_threads(3);
  EXPECT_EQ(omp_get_max_threads(), 3);
  if (named) ::setenv("OMP_NUM_THREADS", kept.c_str(), 1);
  omp_set_num_threads(before);
}

TEST_F(DefaultThreads, UnreadableNumbersDoNotLimit) {
  EXPECT_EQ(threads_with({{"proc/self/cgroup", "no groups\n0::/"}, {"sys/fs/cgroup/cpu.max", "?"}}), 4);
}

}  // namespace
}  // namespace pliant
