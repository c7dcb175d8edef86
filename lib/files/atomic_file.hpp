#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace pliant {

/// A file that is whole or absent: it grows under a temporary name until it is committed. Nothing is left of one that
/// is not. Throws OutputError on a full disk or an unwritable folder.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& file);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  void append(const char* bytes, std::size_t count);
  /// Makes sure that all is on the disk, and gives the file its name.
  void commit();

 private:
  void flush();

  std::filesystem::path file_, temporary_;
  int descriptor_ = -1;
  std::string pending_;  ///< not yet handed to the system
};

/// The same at once.
void write_file_atomically(const std::filesystem::path& file, const std::string& content);

}  // namespace pliant
