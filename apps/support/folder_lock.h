// apps: one process at a time in a folder. The lock goes with the process, however it ends, and
// leaves no file behind. Processes on other machines are not seen.
#pragma once

#include <string>
#include <utility>

#include "datasets/files/error.h"

namespace pushid {

class FolderLock {
 public:
  FolderLock() = default;
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FolderLock();

  // False where another process has it. Errors: the folder cannot be opened.
  Result<bool> Take(const std::string& folder);

 private:
  int descriptor_ = -1;
};

}  // namespace pushid
