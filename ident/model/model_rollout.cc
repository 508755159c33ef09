// ident: parameters of a rollout, and where it ended.
#include "ident/model/model_rollout.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/own_axes.h"
#include "models/learned_terms.h"
#include "models/rollout.h"
#include "residuals/rollout_residual.h"

namespace pushid {
namespace {

// A push gives nobody more momentum for the mass than any that the model was fitted to: beyond
// those, nothing is known of tails, and in proportion to the rows
// they run away. Rows are measured and stay. Of several pushes on a person the strongest counts.
void BoundTails(const PushRange& range, const PendulumRecording& recording,
                std::vector<ParameterSet<double>>* sets) {
  if (range.impulse_per_mass.empty()) return;
  const double dt = recording.scene.dt;
  for (const ScenePush& push : recording.scene.pushes) {
    ParameterSet<double>& p = (*sets)[push.person];
    const double mass = recording.scene.people[push.person].body.mass;
    const double tail = TailImpulse(push, mass, p, dt);
    const double rows = WholeImpulse(push, mass, p, dt) - tail;
    const double most = std::max(0.0, range.impulse_per_mass.upper * mass - rows);
    if (tail > most) ScaleTail(most / tail, &p);
  }
}

}  // namespace

std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording) {
  std::vector<ParameterSet<double>> sets;
  const ParameterMap map = model.table.Map();
  const std::vector<std::vector<double>> covariates = CovariatesOf(recording, map.covariates);
  for (const std::string& unit : PoolingUnits(recording, model.pool_by)) {
    sets.push_back(model.For(unit));
    if (!covariates.empty()) map.Shift(covariates[sets.size() - 1], &sets.back());
  }
  if (model.options.push_tail != PushTail::kNone && model.push_range) {
    BoundTails(*model.push_range, recording, &sets);
  }
  return sets;
}

HipPaths HipsOfRollout(const IdentifiedModel& model, const PendulumRecording& recording,
                       int frames) {
  const std::vector<ParameterSet<double>> parameters = PeoplesParameters(model, recording);
  RolloutPath<double> path;
  HipPaths hips;
  if (!RolloutInOwnAxes(recording, model.options, parameters, frames, &path).ok) return hips;
  for (int n = 0; n < recording.num_people(); ++n) {
    const Body& body = recording.scene.people[n].body;
    hips.emplace_back();
    for (int t = 0; t < frames; ++t) {
      const PendulumState<double>& state = path.At(t, n);
      hips[n].push_back(HipPosition(
          RodMoves(model.options) ? BodyNow(body, state.rod, parameters[n][kRodLift]) : body,
          state.q));
    }
  }
  return hips;
}

std::string OutsideText(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

}  // namespace pushid
