#include "files/checkpoint_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/errors.hpp"

namespace pliant {
namespace {

constexpr std::string_view magic = "pliant checkpoint 4\n";
constexpr std::size_t digits = 16;  ///< of the hash at the end

std::string text_of(const Fnv1a& hash) { return fmt::format("{:016x}", hash.value()); }

std::string hash_of(std::string_view bytes) {
  Fnv1a hash;
  hash.add(bytes.data(), bytes.size());
  return text_of(hash);
}

/// All of a file, or what can be read of it.
std::string read_all(std::ifstream& stream) {
  std::string bytes;
  stream.seekg(0, std::ios::end);
  if (const std::streamoff size = stream.tellg(); size > 0) bytes.resize(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace

CheckpointFile::CheckpointFile(const std::filesystem::path& file, const std::string& header_line) : file_(file) {
  const std::string head = std::string(magic) + header_line + "\n";
  append(head.data(), head.size());
}

void CheckpointFile::append(const char* bytes, std::size_t count) {
  hash_.add(bytes, count);
  file_.append(bytes, count);
}

void CheckpointFile::commit() {
  const std::string end = text_of(hash_);
  file_.append(end.data(), end.size());
  file_.commit();
}

std::string_view CheckpointText::header() const {
  return std::string_view(bytes).substr(header_begin, content_begin - 1 - header_begin);
}

std::string_view CheckpointText::content() const {
  return std::string_view(bytes).substr(content_begin, content_end - content_begin);
}

CheckpointText read_checkpoint_file(const std::filesystem::path& file, const char* advice) {
  const auto refuse = [&](const std::string& why) -> void {
    throw OutputError(fmt::format("{}: {}", file.string(), why));
  };
  CheckpointText text;
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  text.bytes = read_all(stream);
  if (!stream.is_open() || stream.bad()) refuse(fmt::format("cannot be read: {}{}", std::strerror(errno), advice));
  const std::string_view all = text.bytes;
  if (!all.starts_with(magic.substr(0, magic.size() - 2))) refuse("is not a checkpoint");
  if (!all.starts_with(magic)) refuse("is a checkpoint of another version of the program; use that one");
  const std::size_t line_end = all.find('\n', magic.size());
  if (line_end == all.npos || all.size() < line_end + 1 + digits ||
      hash_of(all.substr(0, all.size() - digits)) != all.substr(all.size() - digits))
    refuse(fmt::format("is damaged: it was cut short or changed{}", advice));
  text.header_begin = magic.size();
  text.content_begin = line_end + 1;
  text.content_end = all.size() - digits;
  return text;
}

}  // namespace pliant
