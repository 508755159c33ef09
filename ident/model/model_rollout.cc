// ident: parameters of a rollout, and where it ended.
#include "ident/model/model_rollout.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/own_axes.h"
#include "models/learned_terms.h"
#include "models/turn.h"
#include "residuals/cost_functions/lane_tables.h"
#include "residuals/cost_functions/rollout_problem.h"

namespace pushid {
namespace {

// A push gives nobody more momentum for the mass than any that the model was fitted to, before the
// recording's own effect: beyond those, nothing is known of tails, and in proportion to the rows
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

HipPaths HipsOf(const Scene& scene, const ModelOptions& options,
                const std::vector<ParameterSet<double>>& parameters, int frames) {
  RolloutPath<double> path;
  HipPaths hips;
  if (!Rollout<double>(scene, options, parameters, InitialVelocities(scene), frames, &path).ok) {
    return hips;
  }
  const bool moves = RodMoves(options);
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

}  // namespace

std::vector<ParameterSet<double>> PeoplesParameters(const IdentifiedModel& model,
                                                    const PendulumRecording& recording,
                                                    double effect) {
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
  for (ParameterSet<double>& set : sets) ApplyEffect(effect, &set);
  return sets;
}

void ApplyEffect(double effect, ParameterSet<double>* parameters) {
  for (Parameter id : {kTailGain, kTailBase}) (*parameters)[id] *= std::exp(effect);
}

std::vector<HipPaths> HipsOfRollouts(const IdentifiedModel& model,
                                     const PendulumRecording& recording,
                                     const std::vector<double>& effects, int frames) {
  const double angle = OwnAxes(recording, model.options.directions);
  const TurnedAxes back(-angle);
  const Scene scene = SceneInOwnAxes(recording, model.options);
  const std::vector<ParameterSet<double>> without = PeoplesParameters(model, recording);
  std::vector<std::vector<ParameterSet<double>>> parameters;
  for (double effect : effects) {
    parameters.push_back(without);
    for (ParameterSet<double>& set : parameters.back()) ApplyEffect(effect, &set);
  }
  std::vector<HipPaths> all;
  if (HasLanes(scene, model.options)) {
    std::vector<ParameterSet<double>> of_person;
    for (const auto& sets : parameters) of_person.push_back(sets[0]);
    for (HipPath& path : HipsSideBySide(scene, model.options, of_person, frames)) {
      all.push_back(path.empty() ? HipPaths() : HipPaths{std::move(path)});
    }
  } else {
    for (const auto& sets : parameters) all.push_back(HipsOf(scene, model.options, sets, frames));
  }
  for (HipPaths& hips : all) {
    for (HipPath& path : hips) {
      for (Vector3<double>& hip : path) hip = back.Point(hip);
    }
  }
  return all;
}

std::string OutsideText(const RolloutStatus& status) {
  return std::string(status.quantity) + " of person " + std::to_string(status.person) +
         " leaves the model's domain at frame " + std::to_string(status.frame);
}

}  // namespace pushid
