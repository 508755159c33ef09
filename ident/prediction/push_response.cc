// ident: rollouts of one person under pushes of all sizes, durations and directions.
#include <cmath>
#include <limits>

#include "ident/fit/step_probability.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/own_axes.h"
#include "models/crowd.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kDuration = 0.7;                        // s, of pushes in all directions
constexpr double kStepSeconds = 1.5, kEndSeconds = 6.0;  // after the push

class PushedPerson {
 public:
  PushedPerson(const IdentifiedModel& model, double impulse_per_mass, double duration,
               double degrees)
      : model_(model), degrees_(degrees) {
    recording_.scene = SettlingScene(kSettlingMass, 0.0);
    recording_.scene.pushes.clear();
    AddHipPush(0, {impulse_per_mass * kSettlingMass, 0.0, duration, degrees * M_PI / 180.0},
               &recording_.scene);
  }

  // In the first 1.5 s: later only who does not settle would step.
  double StepProbability() const {
    RolloutPath<double> path;
    if (!Roll(kStepSeconds, &path).ok) return 1.0;
    return model_.step_probability->At(
        StepMargins(model_.options, {model_.parameters}, recording_, path)[0]);
  }

  double End() const {
    RolloutPath<double> path;
    if (!Roll(kEndSeconds, &path).ok) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const Body& body = recording_.scene.people[0].body;
    const Vector3<double> way = HipPosition(body, path.At(path.num_frames() - 1, 0).q) -
                                HipPosition(body, recording_.scene.people[0].start.q);
    const double direction = degrees_ * M_PI / 180.0;
    return way.x() * std::cos(direction) + way.y() * std::sin(direction);
  }

 private:
  RolloutStatus Roll(double seconds, RolloutPath<double>* path) const {
    const Scene& scene = recording_.scene;
    const int frames =
        scene.pushes[0].EndFrame() + static_cast<int>(std::lround(seconds / scene.dt));
    return RolloutInOwnAxes(recording_, model_.options, {model_.parameters}, frames, path);
  }

  const IdentifiedModel& model_;
  PendulumRecording recording_;
  double degrees_;
};

}  // namespace

PushResponse ComputePushResponse(const IdentifiedModel& model) {
  PushResponse response;
  response.impulse_per_mass = {0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.8};
  response.duration_s = {0.1, 0.2, 0.3, 0.5, kDuration, 1.0};
  response.direction_deg = {0, 45, 90, 135, 180};
  for (double impulse : response.impulse_per_mass) {
    std::vector<double> by_duration, by_direction, ends;
    for (double duration : response.duration_s) {
      by_duration.push_back(PushedPerson(model, impulse, duration, 0.0).StepProbability());
    }
    for (double degrees : response.direction_deg) {
      const PushedPerson person(model, impulse, kDuration, degrees);
      by_direction.push_back(person.StepProbability());
      ends.push_back(person.End());
    }
    response.step_by_duration.push_back(std::move(by_duration));
    response.step_by_direction.push_back(std::move(by_direction));
    response.end_by_direction.push_back(std::move(ends));
  }
  return response;
}

}  // namespace pushid
