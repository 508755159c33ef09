// ident: how recordings differ from what the same push does to the mean person, and how much the
// first frames tell of it.
//
// Every recording i has its own log factor b on the tail; all else is held at the fit (freed
// together with it, parameters run away on real recordings):
//
//   y = f(b) + s g a e,   b ~ N(0, w^2)
//
// y: the hip; f: the rollout; g: the speed that the push gives the person with its tail, over 1
// m/s; a: 1 along the push, 0.3 across and upwards; e: recording_filter.h on every axis. w and s by
// maximum marginal likelihood (expectation maximization) over fixed nodes of b: one rollout a node,
// then no more. b acts where one person alone is pushed and the push has a tail. People who touch
// have e alone: b changed nothing there (README.md of ident/prediction).
//
// After k frames b has the posterior over the nodes; its mean makes one rollout, to which the
// expectation of e is added. (The mean, not the mode: the posterior is skewed.) That is one of the
// forecasts that are put together (forecast_stack.h).
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/model/identified_model.h"

namespace pushid {

inline constexpr int kEffectNodes = 33;
inline constexpr double kWidestEffect = 1.6;

inline constexpr double EffectNode(int node) {
  return kWidestEffect * (2.0 * node / (kEffectNodes - 1) - 1.0);
}

// Weights of the nodes that sum to 1; misfit: -2 s^2 log likelihood of each, infinite where its
// rollout left the domain.
std::vector<double> EffectWeights(const std::vector<double>& misfit, double spread,
                                  double error_scale);

// Whether the recording alone would have an effect as far out as is looked, or farther.
inline bool AtEffectEdge(const EffectOfRecording& effect) {
  return std::abs(effect.alone) >= kWidestEffect;
}

struct EffectEstimate {
  double mean = 0.0, error = 0.0;
};
// Of weighted nodes.
EffectEstimate MeanEffect(const std::vector<double>& weights);

// Whether b acts on a recording.
bool EffectActs(const ModelOptions& model, const PendulumRecording& recording);

// After the trajectories; nothing where the model has no tail, or no recording stays in its domain.
std::optional<RecordingEffect> FitRecordingEffect(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings,
                                                  int num_threads = 1);

}  // namespace pushid
