// apps: OpenBLAS by name: which BLAS stands behind libblas.so is the system's choice at run time.
#include "apps/support/blas_threads.h"

#include <dlfcn.h>

#include <cstdlib>

namespace pushid {
namespace {

template <typename Function>
Function* Loaded(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

void SetBlasThreads(int num_threads) {
  auto* const set = Loaded<void(int)>("openblas_set_num_threads");
  if (set == nullptr || std::getenv("OPENBLAS_NUM_THREADS") != nullptr) return;
  set(num_threads);
  // Ends those that look for work; the next product that wants them starts them again.
  auto* const end_threads = Loaded<int()>("blas_thread_shutdown_");
  if (num_threads == 1 && end_threads != nullptr) end_threads();
}

}  // namespace pushid
