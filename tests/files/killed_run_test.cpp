#include <hdf5.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/core.h>

#include "files/frame_file.hpp"
#include "temporary_folder.hpp"

// A run may be killed at any moment. Here it is killed at every moment that matters: before its 1st, 2nd, 3rd ... write
// to the file, so that no timing is left to chance. EXACT: all frames that were complete read back.

namespace {

/// Writes left until the process dies; negative: it lives.
int writes_left = -1;

void count_write() {
  if (writes_left == 0) ::_exit(1);
  if (writes_left > 0) --writes_left;
}

}  // namespace

// HDF5 calls these instead of the C library's. They do the same, but count first.
extern "C" ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  count_write();
  return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}

extern "C" ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  count_write();
  return ::syscall(SYS_pwrite64, descriptor, data, size, offset);
}

extern "C" int ftruncate64(int descriptor, off64_t size) noexcept {
  count_write();
  return static_cast<int>(::syscall(SYS_ftruncate, descriptor, size));
}

namespace pliant {
namespace {

constexpr int points = 30, frames = 4;

std::vector<float> positions(int index) { return std::vector<float>(2 * points, static_cast<float>(index)); }

/// Of both grids.
std::vector<Parts<GridFrame>> frame(int index) {
  const Parts<GridFrame> parts = whole(GridFrame{positions(index), {positions(-index)}});
  return {parts, parts};
}

Parts<GridTopology> one_cell(const std::vector<int>& nodes) { return whole(GridTopology{nodes, {}}); }

class KilledRun : public testing::TemporaryFolder {
 protected:
  /// A run that dies before write `last` after its first frame; the first frame's index has no older one to protect.
  /// True when it came to its end.
  bool run_until(int last) const {
    const pid_t writer = testing::forked();
    if (writer == 0) {
      const std::vector<Field> fields = {{"velocity", Field::Centre::point, 2}};
      FrameFile file(folder_, {{"bodies", points, 3, 1, {}, fields}, {"outlines", points, 2, 1, {}, fields}},
                     {one_cell({0, 1, 2}), one_cell({0, 1})});
      file.append(0, frame(0));
      writes_left = last;
      for (int i = 1; i < frames; ++i) file.append(i, frame(i));
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(writer, &status, 0);
    return WEXITSTATUS(status) == 0;
  }

  /// All values of a dataset; empty when it cannot be read.
  static std::vector<float> read_array(hid_t file, const std::string& name) {
    const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    if (set < 0) return {};
    const hid_t space = H5Dget_space(set);
    std::vector<float> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    if (H5Dread(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) values.clear();
    H5Sclose(space);
    H5Dclose(set);
    return values;
  }

  static void check_frame(hid_t file, const std::string& grid, int index) {
    const std::string group = fmt::format("/{}/{:06}", grid, index);
    EXPECT_EQ(read_array(file, group + "/position"), positions(index)) << group;
    EXPECT_EQ(read_array(file, group + "/velocity").size(), 3U * points) << group;
  }

  /// Number of listed frames. All of them, and whatever else can be seen, must be there.
  int check_file() const {
    const hid_t file = H5Fopen((folder_ / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    EXPECT_GE(file, 0);
    const int count = static_cast<int>(read_array(file, "/times").size());
    for (int i = 0; i < frames; ++i) {
      for (const std::string grid : {"bodies", "outlines"}) {
        const bool seen = H5Lexists(file, fmt::format("/{}/{:06}", grid, i).c_str(), H5P_DEFAULT) > 0;
        EXPECT_TRUE(seen || i >= count);
        if (seen) check_frame(file, grid, i);
      }
    }
    H5Fclose(file);
    return count;
  }
};

TEST_F(KilledRun, StaysReadableWhereverItStops) {
  int killed = 0, before = 1;
  while (!run_until(killed)) {
    const int count = check_file();
    ASSERT_GE(count, before) << "killed before write " << killed;
    ASSERT_FALSE(HasFailure()) << "killed before write " << killed;
    before = count;
    ++killed;
  }
  EXPECT_EQ(check_file(), frames);
  EXPECT_GE(killed, 10 * (frames - 1)) << "the writes of HDF5 were not intercepted";
}

}  // namespace
}  // namespace pliant
