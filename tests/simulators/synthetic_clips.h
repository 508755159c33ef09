// Synthetic clips of motion capture: a walking stick figure in the exponential-map text
// of the literature (loading/generator_data.h), for trying and testing generators without outside
// data.
//
//   phi' = 2 pi c(t)      c: the action's cadence times exp(0.1 n(t)), Hz
//   thighs, upper arms  swing about x by A sin(phi), -A sin(phi), the other side half a turn later
//   knees, elbows       bend by B (1 + sin(phi + pi / 2)) / 2
//   waist               sways about z by C sin(phi)
//
// Every clip has its own amplitudes (times exp(0.15 N(0, 1))), first phase, and slow noise n(t) of
// unit variance and 1 s memory in the cadence, and in all angles by 0.02 rad. 50 frames a second.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>

#include "datasets/files/error.h"
#include "datasets/files/random.h"
#include "models/enum_names.h"

namespace pushid {

struct SyntheticClipOptions {
  int clips = 4;     // of every action to learn from; one more is kept apart below test/
  int frames = 600;  // at 50 Hz
  uint64_t seed = 1;
};

// Slow noise of unit variance: n' = m n + sqrt(1 - m^2) N(0, 1), m = exp(-step / memory).
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
// actions: walking, running, strolling and waving. Errors: files that cannot be written.
MaybeError WriteSyntheticClips(const std::string& folder, const SyntheticClipOptions& options);

// Synthetic groups of three people who stand and talk in turns, with the true speaker, for tests of
// social states, their statistics, and forecasts of groups without pushes.
//
//   who speaks   a Markov chain from frame to frame: a turn, of 2 s on average, ends in a pause, in
//                which nobody speaks, with probability 0.4, otherwise one of the other two speaks;
//                after a pause, of 1 s on average, any of the three does
//   states       speak; listen, while another person speaks; rest, while nobody speaks. Those of
//                one person are a Markov chain too (TurnTransitions)
//   motion       listeners look at the speaker, the speaker looks at one of them for 1 s on
//                average, and in a pause all keep looking; heads follow within 0.15 s, shoulders
//                0.7 of the way within 0.35 s. The speaker's arms rise and beat at about 1.1 Hz,
//                listeners nod; all sway, and differ in size, place and liveliness
//
// Nobody is pushed and no feet move.

enum class TurnState { kSpeak, kListen, kRest };
constexpr EnumNames<TurnState, 3> Names(TurnState) {
  return {
      {{"speak", TurnState::kSpeak}, {"listen", TurnState::kListen}, {"rest", TurnState::kRest}}};
}

struct SyntheticTurnsOptions {
  int recordings = 12;
  int frames = 300;  // at 60 Hz
  uint64_t seed = 1;
};

// Share of one person's steps from state to state; all of them sum to 1.
Eigen::Matrix3d TurnTransitions();

// Writes folder/manifest.json, folder/bvh/<id>_<n>.bvh and folder/states.csv, the states of people
// (TurnState) and of the group (turn, pause); the manifest's key `synthetic` holds seed, names of
// the states and TurnTransitions. Errors: files that cannot be written.
MaybeError WriteSyntheticTurns(const std::string& folder, const SyntheticTurnsOptions& options);

}  // namespace pushid
