// datasets: XXH3-128 of file contents.
#include "datasets/files/content_hash.h"

#include <xxhash.h>

#include <cstdio>
#include <new>
#include <utility>

#include "datasets/files/input_file.h"

namespace pushid {

struct ContentHash::State {
  XXH3_state_t* xxh = XXH3_createState();
  State() {
    if (xxh == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(xxh);
  }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {}
ContentHash::~ContentHash() = default;

void ContentHash::Add(std::string_view bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  char hex[33];
  std::snprintf(hex, sizeof(hex), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return hex;
}

Result<std::string> HashFile(const std::string& path) {
  InputFile file;
  if (MaybeError failed = file.Open(path)) return *std::move(failed);
  ContentHash hash;
  std::string buffer(1 << 16, '\0');
  while (true) {
    Result<std::size_t> count = file.Read(buffer.data(), buffer.size());
    if (!count.ok()) return count.error();
    if (count.value() == 0) return hash.Hex();
    hash.Add({buffer.data(), count.value()});
  }
}

}  // namespace pushid
