// datasets: reading files in pieces. Not by mapping them: the pages of a mapped file count as
// resident memory, and a recording of hours should need no more than its positions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "datasets/files/error.h"

struct XXH3_state_s;

namespace pushid {

// XXH3-128 of file contents, for provenance: a result names the data it came from.

// Hashes bytes piece by piece; how the pieces are cut makes no difference.
class ContentHash {
 public:
  ContentHash();

  void Add(std::string_view bytes);
  void Add(const double* numbers, std::size_t count) {
    Add({reinterpret_cast<const char*>(numbers), count * sizeof(double)});
  }
  std::string Hex() const;  // 32 lower-case hexadecimal digits, as `xxh128sum` prints them

 private:
  std::unique_ptr<XXH3_state_s, void (*)(XXH3_state_s*)> state_;
};

// The hash of a file's bytes, equal to `xxhsum -H2`; an Error when it cannot be read.
Result<std::string> HashFile(const std::string& path);

// A file opened for reading; closed with the object.
class InputFile {
 public:
  // Throws an Error: no such file, a folder, no permission.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  // Up to `capacity` bytes; 0 at the end of the file. Throws an Error.
  std::size_t Read(char* buffer, std::size_t capacity);

  std::int64_t size() const { return size_; }  // bytes; 0 for a pipe
  const std::string& path() const { return path_; }

 private:
  InputFile(const std::string& path, int descriptor) : descriptor_(descriptor), path_(path) {}

  const int descriptor_;
  std::int64_t size_ = 0;
  const std::string path_;
};

// Takes a byte order mark off the head of a text. An Error where the head is that of UTF-16 or
// UTF-32: it names the encoding and how to convert the file.
MaybeError CheckEncoding(const std::string& path, std::string_view* text);

// A text file line by line, hashed on the way; throws an Error where it cannot be read.
//
//   LineReader reader(path);
//   for (std::string_view line; reader.Next(&line);) ...
class LineReader {
 public:
  explicit LineReader(const std::string& path);

  // The next line without its end (LF or CRLF), valid until the next call; false at the end of the
  // file. A byte order mark at the start is skipped, other encodings are an Error.
  bool Next(std::string_view* line);
  // Like Next, but skips blank lines.
  bool NextNonBlank(std::string_view* line);
  // Like Next, but skips blank lines and comments, which start with #.
  bool NextRow(std::string_view* line);

  int line_number() const { return line_number_; }             // of the line last returned, 1-based
  bool ended_in_newline() const { return ended_in_newline_; }  // false: it is the file's last
  Error ErrorHere(std::string message) const { return {std::move(message), path(), line_number_}; }

  std::string HashHex() const { return hash_.Hex(); }  // of everything read so far
  std::int64_t file_size() const { return file_.size(); }
  const std::string& path() const { return file_.path(); }

 private:
  bool Refill();

  InputFile file_;
  ContentHash hash_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  // the unread part of buffer_
  bool ended_in_newline_ = false;
  int line_number_ = 0;
};

// A whole file in memory, for the small ones (manifests, models).
Result<std::string> ReadWholeFile(const std::string& path);

}  // namespace pushid
