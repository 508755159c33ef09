// residuals: what one step of a person whose feet stand and step (models/stance.h) passes on of
// derivatives, by jets in the vectors of a processor: once for each width, in the files of
// person_lanes.h.
#pragma once

#include <cstddef>

#include "models/support.h"

namespace pushid {

// The hip as ankles or steps perceive it.
struct PerceivedHip {
  double s_th, c_th, s_ph, c_ph;  // of its two angles
  double qd[4];
};

inline constexpr int kFeetStates = 4;  // apart, clock, swing_time
inline constexpr int kHipInputs = 6;   // two angles, four rates

struct StanceJetInputs {
  StanceBody body;
  double feet[kFeetStates];
  signed char swings, landed;
  bool fresh;
  PerceivedHip ankle, step;
  double parameters[StanceParameters<double>::kCount];
  // Derivatives of all that by the columns of a fit, a multiple of kGramBlock: a row for each of
  // the feet's, of the angles and rates that ankles and steps perceive, and of the parameters.
  std::ptrdiff_t columns;
  const double* by_feet;
  const double* by_ankle;
  const double* by_step;  // null where steps perceive what ankles do
  const double* by_parameter;
};

// Derivatives by the same columns. of_forces: rows of the cart's velocity (2) and the torques (2);
// of_feet: of the feet after the step.
using StanceJetFunction = void (*)(const StanceJetInputs& in, double* of_forces, double* of_feet);

}  // namespace pushid
