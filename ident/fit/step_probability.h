// ident: how probable it is that a pushed person steps.
//
// The margin of a person in a predicted motion is how far the capture point (models/stance.h) gets
// beyond the edge of the feet's support, at most, as if it were in front:
//   margin = b (max over frames of rho - 1)      m; negative while it stays inside, -b at rest
//   P(step) = 1 / (1 + exp(-(a + margin / w)))
// a, w by maximum likelihood over everybody in the fitted recordings, after the trajectories, with
// a weak prior that holds them finite where a margin tells all who step from all who do not. Errors
// are clustered by person (CR1), and those of a probability are by the delta method. What is known
// of a person is what was recorded: who would step after the recording's end counts as standing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"
#include "models/rollout.h"

namespace pushid {

// One person in one recording.
struct StepOutcome {
  double margin = 0.0;
  bool stepped = false;
  std::string person;  // PersonKey
};

double StepMargin(const ModelOptions& options, const ParameterSet<double>& parameters,
                  const ScenePerson& person, const RolloutPath<double>& path, int index);

// Of everybody, in order; none where the model's rollout of the recording leaves its domain.
std::vector<StepOutcome> StepOutcomes(const IdentifiedModel& model,
                                      const PendulumRecording& recording);

// Nothing where no steps are known; where all do the same, what the prior leaves of it.
std::optional<StepProbability> FitStepProbability(const std::vector<StepOutcome>& outcomes);
// After the trajectories of a model.
std::optional<StepProbability> FitStepProbability(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
