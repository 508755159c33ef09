// datasets: XXH3-128 of file contents, for provenance: a result names the data it came from.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "datasets/files/error.h"

namespace pushid {

// Hashes what is fed to it piece by piece; how the pieces are cut makes no difference.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void Add(std::string_view bytes);
  std::string Hex() const;  // 32 lower-case hexadecimal digits, as `xxh128sum` prints them

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The hash of a file's bytes, equal to `xxhsum -H2`; an Error when it cannot be read.
Result<std::string> HashFile(const std::string& path);

}  // namespace pushid
