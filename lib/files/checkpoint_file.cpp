#include "files/checkpoint_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "core/archive.hpp"
#include "core/errors.hpp"
#include "files/text_files.hpp"

namespace pliant {
namespace {

constexpr std::string_view magic = "pliant checkpoint 1\n";
constexpr std::size_t digits = 16;  ///< of the hash at the end

std::string hash_text(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes.data(), bytes.size());
  return fmt::format("{:016x}", hash.value());
}

}  // namespace

CheckpointFile::CheckpointFile(const std::string& header_line) : bytes(magic) { bytes += header_line + "\n"; }

void CheckpointFile::write(const std::filesystem::path& file) {
  bytes += hash_text(bytes);
  write_file_atomically(file, bytes);
}

std::string_view CheckpointText::header() const {
  return std::string_view(bytes).substr(header_begin, content_begin - 1 - header_begin);
}

std::string_view CheckpointText::content() const {
  return std::string_view(bytes).substr(content_begin, content_end - content_begin);
}

CheckpointText read_checkpoint_file(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& why) -> void {
    throw OutputError(fmt::format("{}: {}", file.string(), why));
  };
  CheckpointText text;
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  text.bytes.assign(std::istreambuf_iterator<char>(stream), {});
  if (!stream.is_open() || stream.bad())
    refuse(fmt::format("cannot be read: {}; without a checkpoint a run can only start anew (--force)",
                       std::strerror(errno)));
  const std::string_view all = text.bytes;
  if (!all.starts_with(magic.substr(0, magic.size() - 2))) refuse("is not a checkpoint");
  if (!all.starts_with(magic)) refuse("is a checkpoint of another version of the program; use that one");
  const std::size_t line_end = all.find('\n', magic.size());
  if (line_end == all.npos || all.size() < line_end + 1 + digits ||
      hash_text(all.substr(0, all.size() - digits)) != all.substr(all.size() - digits))
    refuse("is damaged: it was cut short or changed; the run can only start anew (--force)");
  text.header_begin = magic.size();
  text.content_begin = line_end + 1;
  text.content_end = all.size() - digits;
  return text;
}

}  // namespace pliant
