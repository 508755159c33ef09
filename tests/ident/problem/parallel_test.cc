// Jobs over threads, and what they throw.
#include "ident/problem/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace pushid {
namespace {

TEST(ParallelForTest, EveryJobIsDoneOnceAndCounted) {
  for (int threads : {1, 3, 50}) {
    std::vector<int> done(20, 0);
    int told = 0;
    ParallelFor(
        20, threads, [&](int i) { ++done[i]; },
        [&](int count, int total) { told += count == told + 1 && total == 20; });
    EXPECT_EQ(done, std::vector<int>(20, 1)) << threads;
    EXPECT_EQ(told, 20) << threads;
  }
}

// Out of a thread of its own an exception would end the program.
TEST(ParallelForTest, WhatAJobThrowsComesBackAndNoOtherBegins) {
  for (int threads : {1, 4}) {
    std::atomic<int> begun{0};
    const auto job = [&](int) {
      ++begun;
      throw std::runtime_error("enough");
    };
    EXPECT_THROW(ParallelFor(1000, threads, job), std::runtime_error) << threads;
    EXPECT_LE(begun, threads);
  }
}

TEST(ParallelForTest, WhatProgressThrowsComesBack) {
  for (int threads : {1, 4}) {
    std::atomic<int> begun{0};
    const auto stop = [](int, int) { throw std::runtime_error("interrupted"); };
    EXPECT_THROW(ParallelFor(
                     1000, threads, [&](int) { ++begun; }, stop),
                 std::runtime_error);
    EXPECT_LT(begun, 1000) << threads;
  }
}

}  // namespace
}  // namespace pushid
