// datasets: synthetic clips of motion capture: a walking stick figure in the exponential-map text
// of the literature (loading/mocap_folder.h), for trying and testing generators without outside
// data.
//
//   phi' = 2 pi c(t)      c: the action's cadence times exp(0.1 n(t)), Hz
//   thighs and upper arms swing about x by A sin(phi) and -A sin(phi), the other side half a turn
//   on knees and elbows bend by B (1 + sin(phi + pi / 2)) / 2, the waist sways about z by C
//   sin(phi)
//
// Every clip has its own amplitudes (times exp(0.15 N(0, 1))), first phase, and slow noise n(t) of
// unit variance and 1 s memory in the cadence, and in all angles by 0.02 rad. 50 frames a second.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "datasets/files/error.h"
#include "datasets/files/random.h"

namespace pushid {

struct SyntheticClipOptions {
  int clips = 4;     // of every action to learn from; one more is kept apart below test/
  int frames = 600;  // at 50 Hz
  uint64_t seed = 1;
};

// Of synthetic people: slow noise of unit variance: n' = m n + sqrt(1 - m^2) N(0, 1), m = exp(-step
// / memory).
class SlowNoise {
 public:
  SlowNoise(Random* random, double step_s, double memory_s = 1.0)
      : random_(random), memory_(std::exp(-step_s / memory_s)), value_(random->Normal()) {}
  double Next() {
    value_ = memory_ * value_ + std::sqrt(1.0 - memory_ * memory_) * random_->Normal();
    return value_;
  }

 private:
  Random* random_;
  double memory_, value_;
};

// Writes FOLDER/skeleton.json, FOLDER/train/ACTION/ACTION_i.txt and FOLDER/test/... of four
// actions: walking, running, strolling and waving. Errors: what cannot be written.
MaybeError WriteSyntheticClips(const std::string& folder, const SyntheticClipOptions& options);

}  // namespace pushid
