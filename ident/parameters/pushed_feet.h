// ident: what the feet of pushed people did, and which stance a fit takes from that.
//
//   PushedFeet feet = FeetOf(recordings);
//   StanceOf(feet, Stance::kSlide)  // kFixed: nobody's feet moved
//   FeetText(feet, stance)    // "feet hold (--stance=fixed; they moved in 0 of 24 pushes)"
#pragma once

#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/options.h"

namespace pushid {

// Pushed people whose feet were recorded; who is pushed in two recordings counts twice.
struct PushedFeet {
  int seen = 0;
  int moved = 0;    // stepped, or were elsewhere at the end (PersonSteps::Moved)
  int stepped = 0;  // a foot left the ground (foot_steps.h) while the other did not
};

// 1/s: in longer frames a foot is in the air for less than ten (models/stance.h).
inline constexpr double kLeastSteppingRate = 29.0;

PushedFeet FeetOf(const std::vector<PendulumRecording>& recordings);

// Nobody moved: fixed. Fewer than half of who moved lifted a foot, or nobody's feet were recorded:
// slide. Three in four moved: of_movers. Else: steps.
Stance StanceOf(const PushedFeet& feet, Stance of_movers);

// What the feet of a model do and what those of the recordings did; empty: none were recorded.
std::string FeetText(const PushedFeet& feet, Stance stance);

// What to warn of where the two contradict each other; empty: nothing.
std::string FeetWarning(const PushedFeet& feet, Stance stance);

}  // namespace pushid
