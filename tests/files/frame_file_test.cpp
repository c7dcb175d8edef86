#include "files/frame_file.hpp"

#include <hdf5.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>
#include <utility>

#include "core/errors.hpp"
#include "files/hdf5_file.hpp"
#include "temporary_folder.hpp"

// All checks here are EXACT: arrays read back as they were given.
namespace pliant {
namespace {

namespace fs = std::filesystem;

/// Two triangles over four points, and two segments over three points.
std::vector<Grid> small_grids() {
  return {{"bodies",
           4,
           3,
           2,
           {{"kind", Field::Centre::cell, 1}},
           {{"velocity", Field::Centre::point, 2}, {"von_mises", Field::Centre::cell, 1}}},
          {"outlines", 3, 2, 2, {{"body", Field::Centre::cell, 1}}, {{"contact_pressure", Field::Centre::point, 1}}}};
}

std::vector<Parts<GridTopology>> small_topologies() {
  return {whole(GridTopology{{0, 1, 2, 0, 2, 3}, {{0, 1}}}), whole(GridTopology{{0, 1, 1, 2}, {{7, 8}}})};
}

using Frame = std::vector<Parts<GridFrame>>;

Frame small_frame(float shift) {
  return {whole(GridFrame{{0, 0, 1, 0, 1, 1, 0, 1 + shift}, {{1, 2, 3, 4, 5, 6, 7, 8 + shift}, {1e6F, 2e6F}}}),
          whole(GridFrame{{0, 0, 1, 0, 2, shift}, {{0, 1, 2}}})};
}

/// A grid that a megabyte of incompressible numbers makes large.
std::vector<Grid> large_grids(int points) { return {{"bodies", points, 3, 1, {}, {}}}; }

std::vector<Parts<GridTopology>> one_triangle() { return {whole(GridTopology{{0, 1, 2}, {}})}; }

std::vector<float> noise(int points) {
  std::mt19937 generator(1);
  std::vector<float> positions;
  for (int i = 0; i < 2 * points; ++i) positions.push_back(static_cast<float>(generator()));
  return positions;
}

class FrameFiles : public testing::TemporaryFolder {
 protected:
  std::vector<double> read_array(const std::string& name) const {
    const hid_t file = H5Fopen((folder_ / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    const hid_t space = H5Dget_space(set);
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Sclose(space);
    H5Dclose(set);
    H5Fclose(file);
    return values;
  }
  /// Exit status of the independent reader.
  int check_xdmf() const {
    const std::string command = "/usr/bin/python3 " PLIANT_SOURCE_DIR "/tests/files/check_xdmf.py ";
    return WEXITSTATUS(std::system((command + folder_.string()).c_str()));
  }
};

TEST_F(FrameFiles, ArraysReadBack) {
  FrameFile file(folder_, small_grids(), small_topologies());
  file.append(0.5, small_frame(0));
  file.append(1.5, small_frame(0.25));
  EXPECT_EQ(file.count(), 2);
  EXPECT_EQ(read_array("/times"), (std::vector<double>{0.5, 1.5}));
  EXPECT_EQ(read_array("/bodies/cells"), (std::vector<double>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(read_array("/outlines/body"), (std::vector<double>{7, 8}));
  EXPECT_EQ(read_array("/bodies/000001/position"), (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1.25}));
  EXPECT_EQ(read_array("/bodies/000001/velocity"), (std::vector<double>{1, 2, 0, 3, 4, 0, 5, 6, 0, 7, 8.25, 0}));
  EXPECT_EQ(read_array("/outlines/000000/contact_pressure"), (std::vector<double>{0, 1, 2}));
}

TEST_F(FrameFiles, IndependentReaderResolvesTheXdmfAfterEveryFrame) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "no python3-h5py here";
  FrameFile file(folder_, small_grids(), small_topologies());
  EXPECT_EQ(check_xdmf(), 0);
  for (int i = 0; i < 3; ++i) {
    file.append(i, small_frame(0));
    EXPECT_EQ(check_xdmf(), 0) << "after frame " << i;
  }
}

TEST_F(FrameFiles, IndependentReaderSeesAWrongShape) {
  if (std::system("/usr/bin/python3 -c 'import h5py' 2>/dev/null") != 0) GTEST_SKIP() << "no python3-h5py here";
  FrameFile(folder_, small_grids(), small_topologies()).append(0, small_frame(0));
  std::string text = read(folder_ / "frames.xdmf");
  text.replace(text.find("\"4 2\""), 5, "\"5 2\"");
  std::ofstream(folder_ / "frames.xdmf") << text;
  EXPECT_EQ(check_xdmf(), 1);
}

TEST_F(FrameFiles, TablesHaveOtherLengthsInEveryFrame) {
  FrameFile file(folder_, small_grids(), small_topologies(), Opening::create, {"contacts"});
  file.append(0, small_frame(0), {{"contacts", {{"force", 2, {1, 2, 3, 4}}, {"length", 1, {5, 6}}}}});
  file.append(1, small_frame(0), {{"contacts", {{"force", 2, {}}, {"length", 1, {}}}}});
  EXPECT_EQ(read_array("/contacts/000000/force"), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(read_array("/contacts/000000/length"), (std::vector<double>{5, 6}));
  EXPECT_TRUE(read_array("/contacts/000001/force").empty());
  EXPECT_EQ(check_xdmf(), 0);
  const FrameTable ragged{"contacts", {{"force", 2, {1, 2}}, {"length", 1, {1, 2}}}};
  EXPECT_THROW(file.append(2, small_frame(0), {ragged}), OutputError);
  EXPECT_THROW(file.append(2, small_frame(0), {{"others", {}}}), OutputError);
  EXPECT_THROW(file.append(2, small_frame(0)), OutputError);
  EXPECT_EQ(read_array("/times"), (std::vector<double>{0, 1}));
}

TEST_F(FrameFiles, EmptyGridsAreFine) {
  const Grid empty{"bodies", 0, 3, 0, {{"kind", Field::Centre::cell, 1}}, {}};
  FrameFile file(folder_, {empty}, {whole(GridTopology{{}, {{}}})});
  file.append(0, {whole(GridFrame{})});
  EXPECT_TRUE(read_array("/bodies/000000/position").empty());
}

TEST_F(FrameFiles, SameFramesGiveTheSameBytes) {
  const auto bytes = [this] {
    FrameFile(folder_, small_grids(), small_topologies()).append(1, small_frame(0));
    return read(folder_ / "frames.h5");
  };
  const std::string first = bytes();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts the times of objects in seconds
  EXPECT_TRUE(first == bytes());
}

/// Longer than a chunk of HDF5, cut anywhere.
TEST_F(FrameFiles, PartsFollowEachOther) {
  const int points = 200000, cells = 70000;
  std::vector<int> nodes(3 * cells);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<int>((7 * i) % points);
  const std::vector<float> positions = noise(points), values(positions.begin(), positions.begin() + cells);
  const auto part = [](const auto& all, int size, int first, int end) {
    return std::remove_cvref_t<decltype(all)>(all.begin() + size * first, all.begin() + size * end);
  };
  const Grid grid{"bodies",
                  points,
                  3,
                  cells,
                  {{"kind", Field::Centre::cell, 1}},
                  {{"velocity", Field::Centre::point, 2}, {"jacobian", Field::Centre::cell, 1}}};
  const auto topology = [&](const std::function<void(const GridTopology&)>& take) {
    for (const auto& [first, end] : {std::pair(0, 1), {1, 66000}, {66000, 66000}, {66000, cells}})
      take({part(nodes, 3, first, end), {part(values, 1, first, end)}});
  };
  const auto frame = [&](const std::function<void(const GridFrame&)>& take) {
    take({part(positions, 2, 0, 150000), {part(positions, 2, 0, 3), part(values, 1, 0, cells)}});
    take({part(positions, 2, 150000, points), {part(positions, 2, 3, points), {}}});
  };
  FrameFile(folder_, {grid}, {topology}).append(0, {frame});
  const auto same = [&](const std::string& name, const auto& wanted) {
    EXPECT_TRUE(std::ranges::equal(read_array(name), wanted)) << name;
  };
  same("/bodies/cells", nodes), same("/bodies/kind", values);
  same("/bodies/000000/position", positions), same("/bodies/000000/jacobian", values);
  const std::vector<double> velocity = read_array("/bodies/000000/velocity");
  ASSERT_EQ(velocity.size(), 3U * points);
  for (std::size_t i = 0; i < points; ++i) {
    ASSERT_EQ(velocity[3 * i], positions[2 * i]);
    ASSERT_EQ(velocity[3 * i + 1], positions[2 * i + 1]);
    ASSERT_EQ(velocity[3 * i + 2], 0);
  }
}

TEST_F(FrameFiles, WrongShapesAreRefused) {
  FrameFile file(folder_, small_grids(), small_topologies());
  const auto refuses = [&](const std::vector<float>& positions, const std::vector<std::vector<float>>& values,
                           const std::string& said) {
    const Frame frame = {whole(GridFrame{positions, values}), small_frame(0)[1]};
    const std::string message = testing::message_of<OutputError>([&] { file.append(0, frame); });
    EXPECT_NE(message.find("frames.h5"), std::string::npos) << message;
    EXPECT_NE(message.find(said), std::string::npos) << message;
  };
  const std::vector<float> eight(8), two(2);
  refuses(eight, {eight, {1}}, "'bodies/von_mises' has 1 values");
  refuses(eight, {eight, {1, 2, 3}}, "'bodies/von_mises' has 3 values");
  refuses({1, 2}, {eight, two}, "'bodies/position' has 2 values");
  refuses(eight, {eight}, "1 fields");
  const auto in_pieces = [&](const std::function<void(const GridFrame&)>& take) {
    take({eight, {{1, 2, 3}, two}});
    take({{}, {{4, 5, 6, 7, 8}, {}}});
  };
  EXPECT_NE(
      testing::message_of<OutputError>([&] { file.append(0, {in_pieces, small_frame(0)[1]}); }).find("components"),
      std::string::npos);
  EXPECT_THROW(file.append(0, {}), OutputError);
  EXPECT_TRUE(read_array("/times").empty());
  file.append(0, small_frame(0));
  EXPECT_EQ(read_array("/bodies/000000/position"), (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1}));
  EXPECT_EQ(check_xdmf(), 0);

  std::vector<Parts<GridTopology>> topologies = small_topologies();
  topologies[1] = whole(GridTopology{{3, 1, 1, 2}, {{7, 8}}});
  const auto make = [&] { FrameFile(folder_, small_grids(), topologies); };
  EXPECT_NE(testing::message_of<OutputError>(make).find("'outlines'"), std::string::npos);
  std::vector<Grid> grids = small_grids();
  grids[1].cell_size = 0;
  EXPECT_THROW(FrameFile(folder_, grids, small_topologies()), OutputError);
  grids = small_grids();
  grids[0].fields[0].components = 4;
  EXPECT_THROW(FrameFile(folder_, grids, small_topologies()), OutputError);
}

TEST_F(FrameFiles, MissingFolderIsNamed) {
  const auto make = [this] { FrameFile(folder_ / "none", small_grids(), small_topologies()); };
  EXPECT_NE(testing::message_of<OutputError>(make).find("none/frames.h5"), std::string::npos);
}

TEST_F(FrameFiles, AReaderDoesNotStopTheRun) {
  FrameFile file(folder_, small_grids(), small_topologies());
  const pid_t reader = testing::forked();
  if (reader == 0) {  // holds the file open, locked as readers do, until it is killed
    H5Fopen((folder_ / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    std::ofstream(folder_ / "reading") << "now";
    while (true) ::pause();
  }
  while (!fs::exists(folder_ / "reading")) ::usleep(1000);
  EXPECT_NO_THROW(file.append(0, small_frame(0)));
  ::kill(reader, SIGKILL);
  ::waitpid(reader, nullptr, 0);
}

/// In a process of its own: a file size limit stands for a full disk.
int append_beyond_a_limit(const fs::path& folder, int points) {
  ::signal(SIGXFSZ, SIG_IGN);
  FrameFile file(folder, large_grids(points), one_triangle());
  const Frame frame = {whole(GridFrame{noise(points), {}})};
  file.append(0, frame);
  const rlimit limit = {fs::file_size(folder / "frames.h5") + 100000, RLIM_INFINITY};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  try {
    file.append(1, frame);
  } catch (const OutputError& error) {
    return std::string(error.what()).find("frames.h5") != std::string::npos ? 0 : 1;
  }
  return 2;
}

TEST_F(FrameFiles, AFullDiskIsAnErrorAndEarlierFramesStay) {
  const int points = 100000;
  const pid_t writer = testing::forked();
  if (writer == 0) std::exit(append_beyond_a_limit(folder_, points));  // exit: HDF5 closes what it left open
  int status = 0;
  ::waitpid(writer, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: the message does not name the file, 2: no error";
  EXPECT_EQ(read_array("/times"), std::vector<double>{0});
  const std::vector<double> positions = read_array("/bodies/000000/position");
  ASSERT_EQ(positions.size(), 2U * points);
  EXPECT_EQ(positions.back(), noise(points).back());
}

/// The same limit, met by HDF5 itself.
int write_beyond_a_limit(const fs::path& file) {
  ::signal(SIGXFSZ, SIG_IGN);
  Hdf5File(file, Hdf5File::Mode::create).close();
  const rlimit limit = {10000, RLIM_INFINITY};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  try {
    Hdf5File heavy(file, Hdf5File::Mode::append);
    heavy.new_group().write("noise", noise(100000), 2);
    heavy.close();
  } catch (const OutputError& error) {
    return std::string(error.what()).find("File too large") != std::string::npos ? 0 : 1;
  }
  return 2;
}

TEST_F(FrameFiles, AFailedWriteIsAMessageAndNotACrashAtExit) {
  const pid_t writer = testing::forked();
  if (writer == 0) std::exit(write_beyond_a_limit(folder_ / "a.h5"));
  int status = 0;
  ::waitpid(writer, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: the message does not tell the cause, 2: no error";
}

}  // namespace
}  // namespace pliant
