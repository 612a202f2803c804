// Who works in a results folder.
#pragma once

#include "experiments/record.h"

namespace textonbench {

/// Held by every process that makes files in a results folder, and by its children, whom a fork gives the same lock:
/// it is free only when the last of them has ended, however it ended. Whoever finds it free removes the files that
/// killed processes left half made (".draft_…" in pictures/, logs/ and provenance/).
class FolderLock {
 public:
  /// Throws std::runtime_error naming the lock file when it cannot be opened.
  explicit FolderLock(const ResultsFolder& results);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_ = -1;
};

}  // namespace textonbench
