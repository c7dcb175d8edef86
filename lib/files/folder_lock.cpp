#include "files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/errors.hpp"

namespace pliant {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& folder) {
  throw OutputError(fmt::format("{}: another run is writing to it; wait for its end or choose another folder (--out)",
                                folder.string()));
}

/// The lock's file may have been removed between its opening and its locking.
bool still_there(int descriptor, const std::filesystem::path& file) {
  struct stat open{}, named{};
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : path_(folder / "run.lock") {
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw OutputError(fmt::format("{}: cannot be created: {}; check the folder and its permissions", path_.string(),
                                    std::strerror(errno)));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor_);
      refuse(folder);
    }
  } while (!still_there(descriptor_, path_));
}

FolderLock::~FolderLock() {
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

void FolderLock::refuse_taken(const std::filesystem::path& folder) {
  const int descriptor = ::open((folder / "run.lock").c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return;
  const bool taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  if (taken) refuse(folder);
}

}  // namespace pliant
