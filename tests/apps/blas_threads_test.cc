// apps: how many threads the BLAS of a program has.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>

#include "apps/support/app_support.h"

namespace pushid {
namespace {

int NumThreads() {
  return static_cast<int>(
      std::distance(std::filesystem::directory_iterator("/proc/self/task"), {}));
}

class BlasThreads : public ::testing::Test {
 protected:
  void SetUp() override {
    if (dlopen("libopenblas.so.0", RTLD_NOW | RTLD_GLOBAL) == nullptr)
      GTEST_SKIP() << "no OpenBLAS";
    unsetenv("OPENBLAS_NUM_THREADS");
    SetBlasThreads(1);
  }
};

TEST_F(BlasThreads, OneHasNoneThatLooksForWork) {
  const int own = NumThreads();
  SetBlasThreads(3);
  EXPECT_EQ(NumThreads(), own + 2);
  SetBlasThreads(1);
  EXPECT_EQ(NumThreads(), own);
}

TEST_F(BlasThreads, WhatTheUserSaidStays) {
  const int own = NumThreads();
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  SetBlasThreads(4);
  EXPECT_EQ(NumThreads(), own);
}

}  // namespace
}  // namespace pushid
