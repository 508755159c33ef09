// ident: parameters of a rollout, and where it ended.
#include "ident/fit/model_rollout.h"

#include <cmath>

#include "ident/problem/own_axes.h"
#include "models/learned_terms.h"
#include "residuals/cost_functions/rollout_problem.h"

namespace pushid {

std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording,
                                                    double effect) {
  std::vector<ParameterSet<double>> sets;
  const ParameterMap map = model.table.Map();
  const std::vector<std::vector<double>> covariates = CovariatesOf(recording, map.covariates);
  for (const std::string& unit : PoolingUnits(recording, model.pool_by)) {
    sets.push_back(model.For(unit));
    if (!covariates.empty()) map.Shift(covariates[sets.size() - 1], &sets.back());
    for (Parameter id : {kTailGain, kTailBase}) sets.back()[id] *= std::exp(effect);
  }
  return sets;
}

HipPaths HipsOfRollout(const IdentifiedModel& model, const PendulumRecording& recording,
                       double effect, int frames) {
  const Scene& scene = recording.scene;
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording, effect);
  RolloutPath<double> path;
  HipPaths hips;
  if (!RolloutInOwnAxes(recording, model.options, parameters, frames, &path).ok) {
    return hips;
  }
  const bool moves = RodMoves(model.options);
  for (int n = 0; n < scene.num_people(); ++n) {
    const Body& body = scene.people[n].body;
    hips.emplace_back();
    for (int t = 0; t < frames; ++t) {
      const PendulumState<double>& state = path.At(t, n);
      hips[n].push_back(
          HipPosition(moves ? BodyNow(body, state.rod, parameters[n][kRodLift]) : body, state.q));
    }
  }
  return hips;
}

std::string OutsideText(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

}  // namespace pushid
