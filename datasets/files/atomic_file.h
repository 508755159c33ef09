// datasets: output files that are either complete or not there. The bytes go to a temporary file
// beside the target, reach the disk, and only then take the target's name; a crash, a full disk or
// an error half way leaves the old file as it was and no temporary behind.
#pragma once

#include <string>
#include <string_view>

#include "datasets/files/error.h"

namespace pushid {

// A file that is written in pieces:
//
//   AtomicFile file;
//   if (MaybeError failed = file.Open(path)) return failed;
//   file.Append(text);           // may be repeated; errors are kept until Commit
//   return file.Commit();        // without it the destructor discards everything
//
// A target that is no regular file (/dev/stdout, a pipe) is written directly.
class AtomicFile {
 public:
  AtomicFile() = default;
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Errors: the folder does not exist or may not be written, the target is a folder or protected.
  MaybeError Open(const std::string& path);
  void Append(std::string_view bytes);
  MaybeError Commit();

 private:
  void Flush();
  void Discard();

  std::string path_;       // as the caller named it, for messages
  std::string target_;     // with symbolic links followed, so that a link stays a link
  std::string temporary_;  // empty when the target is written directly
  std::string pending_;
  int descriptor_ = -1;
  MaybeError error_;
};

MaybeError WriteFileAtomically(const std::string& path, std::string_view contents);

// Checks, before a long computation, that its result can be written to `path`: makes and removes a
// temporary file beside it, and leaves the target untouched.
MaybeError CheckWritable(const std::string& path);

// A folder of files that belong together: written beside the target, and renamed at last.
class AtomicFolder {
 public:
  AtomicFolder() = default;
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  // Errors: a file of that name, or the folder above cannot be written.
  MaybeError Open(const std::string& folder);
  // The folder to write to until Commit.
  const std::string& path() const { return temporary_; }
  // Replaces what was there.
  MaybeError Commit();

 private:
  std::string target_, temporary_;
};

// Folders that outputs need.

// Makes the folder and all folders above it; one that is there already is no error.
MaybeError MakeFolder(const std::string& folder);

// The folder in which a file is to be written.
MaybeError MakeFolderOf(const std::string& file);

}  // namespace pushid
