// datasets: output files that are either complete or not there.
#include "datasets/files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr std::size_t kPendingLimit = 1 << 18;  // bytes gathered before they go to the system

Error SystemError(const std::string& path, const std::string& what) {
  return {what + ": " + std::strerror(errno), path, 0};
}

// A name no other process and no other thread of this one uses.
std::string TemporaryName(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return StrCat(target, ".tmp.", ::getpid(), ".", counter++);
}

}  // namespace

AtomicFile::~AtomicFile() { Discard(); }

void AtomicFile::Discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

MaybeError AtomicFile::Open(const std::string& path) {
  namespace fs = std::filesystem;
  path_ = target_ = path;
  if (path.empty()) return Error{"the name of the output file is empty", "", 0};

  mode_t mode = 0666;  // the user's umask takes its share
  bool exists = false;
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0) {
    if (S_ISDIR(info.st_mode)) {
      return Error{"this is a folder; name a file in it for the output", path, 0};
    }
    if (!S_ISREG(info.st_mode)) {
      descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
      if (descriptor_ < 0) return SystemError(path, "cannot write to it");
      return std::nullopt;
    }
    if (::access(path.c_str(), W_OK) != 0) return SystemError(path, "cannot overwrite it");
    exists = true;
    mode = info.st_mode & 07777;
    std::error_code ignored;
    const fs::path real = fs::canonical(path, ignored);
    if (!ignored) target_ = real.string();
  }

  const fs::path folder = fs::path(target_).parent_path();
  std::error_code ignored;
  if (!folder.empty() && !fs::is_directory(folder, ignored)) {
    return Error{"cannot write it: the folder " + folder.string() +
                     " does not exist; create it or name another",
                 path, 0};
  }
  temporary_ = TemporaryName(target_);
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    temporary_.clear();
    return SystemError(path, "cannot write it");
  }
  if (exists && ::fchmod(descriptor_, mode) != 0) {
    // A file system without modes is not worth failing for.
  }
  return std::nullopt;
}

void AtomicFile::Append(std::string_view bytes) {
  pending_.append(bytes);
  if (pending_.size() >= kPendingLimit) Flush();
}

void AtomicFile::Flush() {
  std::size_t written = 0;
  while (!error_ && written < pending_.size()) {
    const ssize_t count =
        ::write(descriptor_, pending_.data() + written, pending_.size() - written);
    if (count >= 0) {
      written += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      error_ = SystemError(path_, "cannot write it");
    }
  }
  pending_.clear();
}

MaybeError AtomicFile::Commit() {
  if (descriptor_ < 0) return Error{"it is not open for writing", path_, 0};
  Flush();
  if (!error_ && !temporary_.empty() && ::fsync(descriptor_) != 0) {
    error_ = SystemError(path_, "cannot write it");
  }
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (!error_ && closed != 0) error_ = SystemError(path_, "cannot write it");
  if (!error_ && !temporary_.empty()) {
    if (std::rename(temporary_.c_str(), target_.c_str()) == 0) {
      temporary_.clear();
    } else {
      error_ = SystemError(path_, "cannot replace it");
    }
  }
  Discard();
  return error_;
}

MaybeError WriteFileAtomically(const std::string& path, std::string_view contents) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append(contents);
  return file.Commit();
}

MaybeError CheckWritable(const std::string& path) {
  AtomicFile file;
  return file.Open(path);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove_all(temporary_, ignored);
}

MaybeError AtomicFolder::Open(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failed;
  target_ = fs::absolute(folder).lexically_normal().string();
  while (target_.size() > 1 && target_.back() == '/') target_.pop_back();
  if (fs::exists(target_, failed) && !fs::is_directory(target_, failed)) {
    return Error{"this is a file; name a folder for the output", folder};
  }
  temporary_ = TemporaryName(target_);
  return MakeFolder(temporary_);
}

MaybeError AtomicFolder::Commit() {
  const std::string before = TemporaryName(target_);
  const bool exists = std::rename(target_.c_str(), before.c_str()) == 0;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) {
    const Error error = SystemError(target_, "cannot replace it");
    if (exists) std::rename(before.c_str(), target_.c_str());
    return error;
  }
  temporary_.clear();
  std::error_code ignored;
  if (exists) std::filesystem::remove_all(before, ignored);
  return std::nullopt;
}

MaybeError MakeFolder(const std::string& folder) {
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) return Error{"cannot make this folder: " + failed.message(), folder};
  return std::nullopt;
}

MaybeError MakeFolderOf(const std::string& file) {
  return MakeFolder(std::filesystem::path(file).parent_path().string());
}

}  // namespace pushid
