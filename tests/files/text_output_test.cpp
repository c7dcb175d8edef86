#include "files/text_output.hpp"
#include "files/atomic_file.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "core/errors.hpp"
#include "files/output_folder.hpp"
#include "temporary_folder.hpp"

// All checks here are EXACT: bytes and messages.
namespace pliant {
namespace {

namespace fs = std::filesystem;

class TextFiles : public testing::TemporaryFolder {
 protected:
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
};

TEST_F(TextFiles, AtomicWriteReplacesAndLeavesNothingBeside) {
  write_file_atomically(folder_ / "a.json", "first, and longer");
  write_file_atomically(folder_ / "a.json", "second");
  EXPECT_EQ(read(folder_ / "a.json"), "second");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(TextFiles, AtomicWriteThatFailsKeepsTheOldFile) {
  fs::create_directory(folder_ / "taken");
  write_file_atomically(folder_ / "taken" / "inside", "kept");
  const auto write = [this] { write_file_atomically(folder_ / "taken", "new"); };  // a folder cannot be replaced
  EXPECT_NE(testing::message_of<OutputError>(write).find((folder_ / "taken").string()), std::string::npos);
  EXPECT_EQ(read(folder_ / "taken" / "inside"), "kept");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(TextFiles, MissingFolderIsNamed) {
  const auto write = [this] { write_file_atomically(folder_ / "none" / "a", "x"); };
  EXPECT_NE(testing::message_of<OutputError>(write).find("none/a"), std::string::npos);
  EXPECT_THROW(CsvFile(folder_ / "none" / "a.csv", {"x"}), OutputError);
}

TEST_F(TextFiles, CsvNumbersReadBackExactly) {
  const std::vector<double> values = {0.1, -1.0 / 3.0, 5e-324, std::numeric_limits<double>::max(), 1e22, -0.0, 3};
  {
    CsvFile file(folder_ / "n.csv", {"a", "b", "c", "d", "e", "f", "g"});
    file.row(values);
  }
  std::istringstream text(read(folder_ / "n.csv"));
  std::string line, cell;
  std::getline(text, line);
  EXPECT_EQ(line, "a,b,c,d,e,f,g");
  for (const double value : values) {
    std::getline(text, cell, value == 3 ? '\n' : ',');
    EXPECT_EQ(std::strtod(cell.c_str(), nullptr), value) << cell;
  }
}

TEST_F(TextFiles, CsvNotSampledIsEmptyAndHeadersAreQuoted) {
  {
    CsvFile file(folder_ / "n.csv", {"time [s]", "a,b", "say \"x\""});
    file.row({1, std::nan(""), std::nan("")});
  }
  EXPECT_EQ(read(folder_ / "n.csv"), "time [s],\"a,b\",\"say \"\"x\"\"\"\n1,,\n");
}

TEST_F(TextFiles, CsvHasWholeRowsAtAnyTime) {
  CsvFile file(folder_ / "n.csv", {"a", "b"});
  for (int i = 0; i < 20000; ++i) file.row({i + 0.125, 1.0 / (i + 1)});
  const std::string before = read(folder_ / "n.csv");
  EXPECT_GT(before.size(), 100000U);
  EXPECT_EQ(before.back(), '\n');
  file.flush();
  EXPECT_NE(read(folder_ / "n.csv").find("19999.125"), std::string::npos);
}

TEST_F(TextFiles, CsvRefusesARowOfAnotherLength) {
  CsvFile file(folder_ / "n.csv", {"a", "b"});
  const std::string message = testing::message_of<OutputError>([&] { file.row({1}); });
  EXPECT_NE(message.find("n.csv"), std::string::npos);
  EXPECT_NE(message.find("2 columns"), std::string::npos);
}

TEST_F(TextFiles, CsvOnAFullDiskSaysSo) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const std::string message = testing::message_of<OutputError>([] { CsvFile("/dev/full", {"a"}); });
  EXPECT_NE(message.find("/dev/full"), std::string::npos);
  EXPECT_NE(message.find("No space left"), std::string::npos);
}

TEST_F(TextFiles, OutputFolderIsCreatedAndNotTakenTwice) {
  const fs::path out = folder_ / "deep" / "out";
  prepare_output_folder(out, false);
  EXPECT_TRUE(fs::is_empty(out));
  prepare_output_folder(out, false);  // empty: may be used
  write_file_atomically(out / "summary.json", "{}");
  EXPECT_NE(testing::message_of<OutputError>([&] { prepare_output_folder(out, false); }).find(out.string()),
            std::string::npos);
  EXPECT_TRUE(fs::exists(out / "summary.json"));
}

TEST_F(TextFiles, OverwriteEmptiesAFolderOfResults) {
  for (const char* name : {"summary.json", "scene.toml", "frames.h5", "probes.csv", "grains.png", "frame_000001.vtu"}) {
    write_file_atomically(folder_ / name, "x");
  }
  prepare_output_folder(folder_, true);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(TextFiles, OverwriteNeverRemovesWhatNoRunWrote) {
  write_file_atomically(folder_ / "thesis.tex", "years of work");
  EXPECT_THROW(prepare_output_folder(folder_, true), OutputError);
  write_file_atomically(folder_ / "scene.toml", "x");
  const std::string message = testing::message_of<OutputError>([&] { prepare_output_folder(folder_, true); });
  EXPECT_NE(message.find("thesis.tex"), std::string::npos);
  EXPECT_EQ(entries(), 2U);
}

TEST_F(TextFiles, AFolderOfScenesIsNotAResult) {
  write_file_atomically(folder_ / "scene.toml", "x");
  write_file_atomically(folder_ / "other.toml", "x");
  EXPECT_THROW(prepare_output_folder(folder_, true), OutputError);
  EXPECT_EQ(entries(), 2U);
}

// EXACT: the lock, and what the new run wrote already, stay; files that were never put in place are nobody's.
TEST_F(TextFiles, EmptyingKeepsTheLockAndWhatIsNamed) {
  for (const char* name : {"summary.json", "checkpoint.bin", "scene.toml", "run.lock", "checkpoint.bin.17.tmp"})
    write_file_atomically(folder_ / name, "x");
  empty_output_folder(folder_, {"scene.toml"});
  EXPECT_EQ(entries(), 2U);
  EXPECT_TRUE(fs::exists(folder_ / "run.lock") && fs::exists(folder_ / "scene.toml"));
}

TEST_F(TextFiles, AKilledRunIsKnownByItsLockOrAnEmptyFolder) {
  const fs::path out = folder_ / "out";
  EXPECT_TRUE(begins_anew(out)) << "no folder";
  fs::create_directory(out);
  EXPECT_TRUE(begins_anew(out)) << "before its first file";
  write_file_atomically(out / "trial.17.tmp", "x");
  EXPECT_TRUE(begins_anew(out));
  prepare_output_folder(out, false);
  write_file_atomically(out / "notes.tmp", "somebody's");
  EXPECT_FALSE(begins_anew(out)) << "not a name that a run gives";
  EXPECT_THROW(prepare_output_folder(out, false), OutputError);
  write_file_atomically(out / "run.lock", "");
  EXPECT_TRUE(begins_anew(out));
  write_file_atomically(out / "checkpoint.bin", "x");
  EXPECT_FALSE(begins_anew(out));
}

TEST_F(TextFiles, AFileIsNoOutputFolder) {
  write_file_atomically(folder_ / "file", "x");
  EXPECT_THROW(prepare_output_folder(folder_ / "file", true), OutputError);
  EXPECT_THROW(prepare_output_folder(folder_ / "file" / "below", true), OutputError);
}

}  // namespace
}  // namespace pliant
