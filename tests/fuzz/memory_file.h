// A file in memory that a reader opens by its path like any other: what a fuzz target feeds.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>

namespace pushid {

class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("fuzz", 0)) {
    if (descriptor_ < 0) std::abort();
    path_ = "/proc/self/fd/" + std::to_string(descriptor_);
  }
  ~MemoryFile() { close(descriptor_); }

  const std::string& Fill(const std::uint8_t* data, std::size_t size) {
    if (ftruncate(descriptor_, 0) != 0 ||
        pwrite(descriptor_, data, size, 0) != static_cast<ssize_t>(size)) {
      std::abort();
    }
    return path_;
  }

 private:
  int descriptor_;
  std::string path_;
};

// Ends the program when an input took over three seconds of the processor: one, times what a build
// without optimization, which compiles in half the time, takes longer. libFuzzer's own -timeout
// counts time on the wall, which on a busy machine says little.
class CpuLimit {
 public:
  ~CpuLimit() {
    if (Now() - start_ > 3.0) std::abort();
  }

 private:
  static double Now() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  const double start_ = Now();
};

// A property that must hold for whatever was read.
inline void Demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace pushid
