#include "files/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/errors.hpp"
#include "files/write_all.hpp"

namespace pliant {
namespace {

/// Bytes that are handed to the system at a time.
constexpr std::size_t block = 1 << 20;

/// Makes a rename itself durable. Some file systems cannot sync a folder; the file is whole all the same.
void sync_folder(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

int write_all(int descriptor, const std::string& content) {
  std::size_t done = 0;
  while (done < content.size()) {
    const ssize_t count = ::write(descriptor, content.data() + done, content.size() - done);
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return 0;
}

void refuse_file(const std::filesystem::path& file, const char* action, int error) {
  throw OutputError(fmt::format("{}: cannot {}: {}; check the folder, its permissions and the free disk space",
                                file.string(), action, std::strerror(error)));
}

AtomicFile::AtomicFile(const std::filesystem::path& file) : file_(file), temporary_(file) {
  temporary_ += fmt::format(".{}.tmp", ::getpid());
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) refuse_file(file, "be created", errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::append(const char* bytes, std::size_t count) {
  pending_.append(bytes, count);
  if (pending_.size() >= block) flush();
}

void AtomicFile::flush() {
  if (const int error = write_all(descriptor_, pending_); error != 0) refuse_file(file_, "be written", error);
  pending_.clear();
}

void AtomicFile::commit() {
  flush();
  if (::fsync(descriptor_) != 0) refuse_file(file_, "be written", errno);
  int error = ::close(std::exchange(descriptor_, -1)) != 0 ? errno : 0;
  if (error == 0 && ::rename(temporary_.c_str(), file_.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary_.c_str());
    refuse_file(file_, "be written", error);
  }
  sync_folder(file_);
}

void write_file_atomically(const std::filesystem::path& file, const std::string& content) {
  AtomicFile whole(file);
  whole.append(content.data(), content.size());
  whole.commit();
}

}  // namespace pliant
