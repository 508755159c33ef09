// residuals: where lanes are kept between frames, and their sums of products. For
// person_lanes_loops.h, after its scalar.
#pragma once

#include <Eigen/Core>

#include "residuals/frame_residual.h"

namespace pushid {
namespace {

constexpr int kWidth = PUSHID_VECTOR_DOUBLES;

template <int kSize>
Eigen::Matrix<Lanes, kSize, 1> LoadVector(const double* from) {
  Eigen::Matrix<Lanes, kSize, 1> vector;
  for (int i = 0; i < kSize; ++i) vector[i] = LoadLanes(from + i * kWidth);
  return vector;
}

// The derivatives that are carried from step to step, and what they are summed up to.
struct Carried {
  Lanes* by_column = nullptr;   // P x 8: [q, qd]
  Lanes* before = nullptr;      // P x 2: of the cart's velocity, one frame earlier
  Lanes* rows = nullptr;        // (P + 1) x kFrameResiduals: [J r] of one frame
  Lanes* plain = nullptr;       // (P + 1) x (P + 1)
  Lanes* robust = nullptr;      // the same
  Lanes* tails = nullptr;       // rate and decay of each
  double* residuals = nullptr;  // of LaneOutputs
  double* states = nullptr;     // the same
};

// Lanes of which storage has room for, one after the other.
class Room {
 public:
  explicit Room(double* storage) {
    const auto address = reinterpret_cast<unsigned long long>(storage);
    at_ = reinterpret_cast<Lanes*>((address + sizeof(Lanes) - 1) / sizeof(Lanes) * sizeof(Lanes));
  }
  Lanes* Take(int count) {
    Lanes* const taken = at_;
    at_ += count;
    return taken;
  }

 private:
  Lanes* at_;
};

// gram, of size x size, grows by the products of kLeft columns of kFrameResiduals rows each, from
// column i on, with kRight from j on; upper: those on and above its diagonal alone.
template <int kLeft, int kRight, bool kUpper = false>
void AddGramBlock(const Lanes* rows, int size, int i, int j, Lanes* gram) {
  const Lanes* const left = rows + kFrameResiduals * i;
  const Lanes* const right = rows + kFrameResiduals * j;
  Lanes sum[kLeft][kRight];
  const auto each = [](const auto& does) {
    for (int a = 0; a < kLeft; ++a) {
      for (int b = kUpper ? a : 0; b < kRight; ++b) does(a, b);
    }
  };
  each([&](int a, int b) { sum[a][b] = gram[(i + a) * size + j + b]; });
#pragma GCC unroll 9
  for (int k = 0; k < kFrameResiduals; ++k) {
    each([&](int a, int b) {
      sum[a][b] += left[kFrameResiduals * a + k] * right[kFrameResiduals * b + k];
    });
  }
  each([&](int a, int b) { gram[(i + a) * size + j + b] = sum[a][b]; });
}

// The upper triangle, by blocks whose sums stay in registers.
inline void AddGram(const Lanes* rows, int size, Lanes* gram) {
  constexpr int kBlock = 3;
  const int whole = size / kBlock * kBlock;
  for (int j = 0; j < whole; j += kBlock) {
    for (int i = 0; i < j; i += kBlock) AddGramBlock<kBlock, kBlock>(rows, size, i, j, gram);
    AddGramBlock<kBlock, kBlock, true>(rows, size, j, j, gram);
  }
  for (int j = whole; j < size; ++j) {
    for (int i = 0; i < whole; i += kBlock) AddGramBlock<kBlock, 1>(rows, size, i, j, gram);
    for (int i = whole; i <= j; ++i) AddGramBlock<1, 1>(rows, size, i, j, gram);
  }
}

}  // namespace
}  // namespace pushid
