#pragma once

#include <filesystem>

namespace train_results {

/// Keeps other runs out of a folder. The system ends it with the process, however that ends.
///
/// Where a file system knows no locks, there is none.
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
