#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pliant {

/// One binary file, whole or not at all: the line "pliant checkpoint 1", a line of JSON (for people and scripts), the
/// content, and 16 hexadecimal digits of the FNV-1a hash of all before.
class CheckpointFile {
 public:
  /// Starts a file: append the content to `bytes`, then write. The last good file stays until the new one is whole on
  /// the disk. Throws OutputError.
  explicit CheckpointFile(const std::string& header_line);
  std::string bytes;
  void write(const std::filesystem::path& file);
};

/// A checkpoint that was read.
struct CheckpointText {
  std::string bytes;
  std::size_t header_begin = 0, content_begin = 0, content_end = 0;
  std::string_view header() const;
  std::string_view content() const;
};

/// Throws OutputError for a file that is missing, unreadable, cut short or otherwise damaged.
CheckpointText read_checkpoint_file(const std::filesystem::path& file);

}  // namespace pliant
