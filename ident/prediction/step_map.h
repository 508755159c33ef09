// ident: who steps after which push: the probability of a step over the push's impulse per mass and
// its duration, for the person of the settling simulations (80 kg, rod 0.95 m, upright), pushed
// along +x at the hip by half-sines: as a measured (external) push would.
#pragma once

#include <vector>

#include "ident/results/identified_model.h"

namespace pushid {

struct StepMap {
  std::vector<double> duration_s, impulse_per_mass;  // s; m/s
  std::vector<std::vector<double>> probability;  // [impulse][duration]; 1 where the person falls
};

// Empty where the model says nothing of steps.
StepMap ComputeStepMap(const IdentifiedModel& model);

}  // namespace pushid
