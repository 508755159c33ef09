// residuals: where lanes are kept between frames. For person_lanes_loops.h, after its scalar.
#pragma once

#include <Eigen/Core>

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
  Lanes* by_column;  // P x 8: [q, qd]
  Lanes* before;     // P x 2: of the cart's velocity, one frame earlier
  Lanes* rows;       // (P + 1) x kFrameResiduals: [J r] of one frame
  Lanes* plain;      // (P + 1) x (P + 1)
  Lanes* robust;     // the same
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

}  // namespace
}  // namespace pushid
