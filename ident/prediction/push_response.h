// ident: what a model says of pushes that nobody gave: who steps, and where the hip ends.
//
// For the person of the settling simulations (80 kg, rod 0.95 m, upright), pushed at the hip by
// half-sines, as a measured (external) push would.
#pragma once

#include <vector>

#include "ident/model/identified_model.h"

namespace pushid {

struct PushResponse {
  std::vector<double> impulse_per_mass;  // m/s
  std::vector<double> duration_s;        // of pushes forwards
  std::vector<double> direction_deg;     // from forwards to the left; of 0.7 s
  // P(step), 1 where the person falls; [impulse][duration or direction].
  std::vector<std::vector<double>> step_by_duration, step_by_direction;
  // m along the push, 6 s after it; NaN where the person falls.
  std::vector<std::vector<double>> end_by_direction;
};

// Of a model with a step_probability.
PushResponse ComputePushResponse(const IdentifiedModel& model);

}  // namespace pushid
