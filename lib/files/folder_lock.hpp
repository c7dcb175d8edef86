#pragma once

#include <filesystem>

namespace pliant {

/// Keeps a second process out of an output folder: `run.lock` in it, locked as long as the object lives (and no longer
/// than the process), removed afterwards. Throws OutputError when another process holds it.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Throws OutputError when a process holds the lock of a folder; the folder need not be there. Changes nothing.
  static void refuse_taken(const std::filesystem::path& folder);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace pliant
