#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/archive.hpp"
#include "files/atomic_file.hpp"

namespace pliant {

/// One binary file, whole or not at all, written as it comes: the line "pliant checkpoint 4", a line of JSON (for
/// people and scripts), the content, and 16 hexadecimal digits of the FNV-1a hash of all before.
class CheckpointFile {
 public:
  /// The last good file stays until the new one is committed. Throws OutputError.
  CheckpointFile(const std::filesystem::path& file, const std::string& header_line);
  void append(const char* bytes, std::size_t count);
  void commit();

 private:
  AtomicFile file_;
  Fnv1a hash_;
};

/// A checkpoint that was read.
struct CheckpointText {
  std::string bytes;
  std::size_t header_begin = 0, content_begin = 0, content_end = 0;
  std::string_view header() const;
  std::string_view content() const;
};

/// Throws OutputError for a file that is missing, unreadable, cut short or otherwise damaged, with advice at its end.
CheckpointText read_checkpoint_file(const std::filesystem::path& file,
                                    const char* advice = "; the run can only start anew (--force)");

}  // namespace pliant
