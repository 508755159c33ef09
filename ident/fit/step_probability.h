// ident: how probable it is that a pushed person steps.
//
// The margin of a person who is pushed is by how much the support in front, b, might be larger, and
// the person would still just step:
//   margin = b (f - 1 - (1/f - 1) / 500)           f: the largest factor on the support
//   feet that step (models/stance.h)  f by rollouts with other supports, between 1/1000 and 4 times
//     that of the model; who steps with one support is taken to step with every smaller one
//   else  f = max over frames of rho: how far the capture point gets, in supports that go with the
//     cart
//   P(step) = 1 / (1 + exp(-(a + margin / w)))
// So P(step) is how probable it is that somebody's support is smaller than f b, where supports are
// spread by w (a logistic distribution) about a mean of b - a w. The part with 1/f, which is small
// beyond a twentieth, keeps supports positive: without it people whom nothing moves would step as
// often as negative ones are drawn, 6 % in groups. Rejected: margins of b log f, worse for single
// people who step after hardly a push (Brier score 0.089, not 0.079).
//
// a, w by maximum likelihood over everybody in the fitted recordings, after the trajectories, with
// a weak prior that holds them finite where a margin tells all who step from all who do not.
// Margins below -0.1 m count as that: of w, who is not moved at all tells no more than who hardly
// is. Errors are clustered by person (CR1), and those of a probability are by the delta method.
// People who would step after the recording's end count as standing. So w holds all that makes
// people do otherwise than the margin says, errors of the recorded pushes among it; of a push that
// is known less well than those, P(step) is too sure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"

namespace pushid {

// f: the factor on a support of so many m that somebody would just step with.
double StepMargin(double support, double factor);

// One person in one recording.
struct StepOutcome {
  double margin = 0.0;
  bool stepped = false;
  std::string person;  // id
};

// Each person asks for a dozen rollouts of all: seconds at this number, hours in a crowd.
inline constexpr int kMostPeopleWithMargins = 20;

// The margin of everybody in a recording; path: the model's own rollout of it. None where more
// people than that have feet that step.
std::vector<double> StepMargins(const ModelOptions& options,
                                const std::vector<ParameterSet<double>>& parameters,
                                const PendulumRecording& recording,
                                const RolloutPath<double>& path);

// Nothing where no steps are known; where all do the same, what the prior leaves of it.
std::optional<StepProbability> FitStepProbability(const std::vector<StepOutcome>& outcomes);
// After the trajectories of a model.
std::optional<StepProbability> FitStepProbability(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings);

}  // namespace pushid
