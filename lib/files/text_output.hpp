#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace pliant {

/// How an output file is opened: anew, or to go on with what a checkpoint knows of it.
enum class Opening { create, resume };

/// A CSV file that grows by rows, flushed when asked. Numbers are written so that they read back exactly;
/// NaN is written as an empty cell. Throws OutputError on a full disk or an unwritable folder.
class CsvFile {
 public:
  /// A file to resume must be there and have these columns.
  CsvFile(const std::filesystem::path& file, const std::vector<std::string>& columns,
          Opening opening = Opening::create);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;
  void row(const std::vector<double>& values);
  void flush();
  /// After a flush: makes sure that the rows are on the disk.
  void sync();

  /// Flush first: what is pending is not enumerated.
  template <class Visitor>
  void visit(Visitor&& visitor) {
    visitor("written", written_);
  }
  /// Cuts off the rows after those that were read by visit. Throws OutputError when the file holds less.
  void loaded();

 private:
  void write_header(const std::string& header);
  void require_header(const std::string& header);

  std::filesystem::path path_;
  std::FILE* file_ = nullptr;
  std::size_t columns_ = 0;
  std::string pending_;      ///< whole rows not yet handed to the system, so that a killed run leaves no torn row
  std::size_t written_ = 0;  ///< bytes of whole rows in the file
};

}  // namespace pliant
