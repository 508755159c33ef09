// residuals: derivatives of one step of one person whose feet stand and step (models/stance.h), by
// jets in the vectors of a processor: once for each width, in the files of person_lanes.h.
#pragma once

#include "models/support.h"

namespace pushid {

// The hip as ankles or steps perceive it.
struct PerceivedHip {
  double s_th, c_th, s_ph, c_ph;  // of its two angles
  double qd[4];
};

struct StanceJetInputs {
  StanceBody body;
  double feet[4];  // apart, clock, swing_time
  signed char swings, landed;
  bool fresh;
  PerceivedHip ankle, step;
  bool late;  // ankles and steps perceive different states
  double parameters[StanceParameters<double>::kCount];
};

// Inputs, in this order: the feet; the angles and the rates that ankles perceive; where late, those
// that steps perceive; the parameters.
inline constexpr int kFeetInputs = 4, kHipInputs = 6;
constexpr int StanceJetSize(bool late) {
  return kFeetInputs + (late ? 2 : 1) * kHipInputs + StanceParameters<double>::kCount;
}
inline constexpr int kMostStanceJets = StanceJetSize(true);

// Outputs: the cart's velocity (2), the torques (2), and the feet after the step (4).
inline constexpr int kStanceOutputs = 8;

// by_input: [input][output].
using StanceJetFunction = void (*)(const StanceJetInputs& in, double* by_input);

}  // namespace pushid
