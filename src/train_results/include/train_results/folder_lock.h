#pragma once

#include <filesystem>

namespace train_results {

/// Locks a folder against other runs. The system releases the lock when the process ends, however it ends.
///
/// On a file system without locks there is none.
class FolderLock {
 public:
  /// @throws std::runtime_error if another run has it
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace train_results
