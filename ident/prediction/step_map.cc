// ident: the probability of a step over a grid of pushes.
#include "ident/prediction/step_map.h"

#include <cmath>

#include "ident/problem/behaviour.h"

namespace pushid {
namespace {

constexpr double kDurations[] = {0.1, 0.2, 0.3, 0.5, 0.7, 1.0};                              // s
constexpr double kImpulses[] = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.8};  // m/s
constexpr double kWatched = 1.5;  // s after the push's end

double ProbabilityAfter(const IdentifiedModel& model, double impulse, double duration) {
  Scene scene = SettlingScene(kSettlingMass, 0.0);
  const Body& body = scene.people[0].body;
  const int rows = static_cast<int>(std::lround(duration / scene.dt));
  scene.pushes = {MakeScenePush(0, 0, PushKind::kExternal,
                                HalfSinePush(body, impulse * body.mass, rows, scene.dt))};
  const int frames = rows + static_cast<int>(std::lround(kWatched / scene.dt));
  RolloutPath<double> path;
  const RolloutStatus status = Rollout<double>(scene, model.options, {model.parameters},
                                               InitialVelocities(scene), frames, &path);
  if (!status.ok) return 1.0;
  return model.step_probability->At(
      StepMargin(model.options, model.parameters, scene.people[0], path, 0));
}

}  // namespace

StepMap ComputeStepMap(const IdentifiedModel& model) {
  StepMap map;
  if (!model.step_probability) return map;
  map.duration_s.assign(std::begin(kDurations), std::end(kDurations));
  map.impulse_per_mass.assign(std::begin(kImpulses), std::end(kImpulses));
  for (double impulse : kImpulses) {
    map.probability.emplace_back();
    for (double duration : kDurations) {
      map.probability.back().push_back(ProbabilityAfter(model, impulse, duration));
    }
  }
  return map;
}

}  // namespace pushid
