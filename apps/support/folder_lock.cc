// apps: a lock on a folder itself.
#include "apps/support/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace pushid {

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<bool> FolderLock::Take(const std::string& folder) {
  descriptor_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) return Error{"cannot be opened: " + std::string(strerror(errno)), folder};
  // A file system that knows no locks is no reason to do nothing.
  return flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace pushid
