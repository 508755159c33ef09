// models: everything about a push event that is not a parameter: who stands where, and who is
// pushed.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "models/ground.h"
#include "models/ipm.h"
#include "models/options.h"
#include "models/push.h"

namespace pushid {

struct ScenePerson {
  Body body;
  PendulumState<double> start;  // at frame 0
};

struct Scene {
  double dt = 1.0 / 60.0;  // s
  std::vector<ScenePerson> people;
  std::vector<ScenePush> pushes;
  GroundMotion ground;  // people and pushes are as it sees them

  int num_people() const { return static_cast<int>(people.size()); }
  int LastPushEnd() const {
    int end = 0;
    for (const ScenePush& push : pushes) end = std::max(end, push.EndFrame());
    return end;
  }
  // The frame at which people who settle have settled.
  int SettledFrame(const ModelOptions& model) const;
};

// A scene with every push multiplied by `factor`.
inline Scene ScalePushes(Scene scene, double factor) {
  for (ScenePush& push : scene.pushes) {
    for (Vector4<double>& row : push.force) row *= factor;
    push.mean *= factor;
  }
  return scene;
}

// Settled: so slow and so near the rest posture, so long after the last push. People who touch and
// step need longer: in a row a push takes 0.25 s from one to the next, and everybody's second step,
// which brings the rear foot up, ends 1.2 s after the first began.
inline constexpr double kWaitSeconds = 2.0, kWaitSecondsInRows = 3.0;
inline double WaitSeconds(const ModelOptions& model) {
  return model.stance == Stance::kSteps && model.interaction.Any() ? kWaitSecondsInRows
                                                                   : kWaitSeconds;
}
inline constexpr double kSettledSpeed = 0.1;  // m/s
inline constexpr double kSettledLean = 0.05;  // rad

inline constexpr double kSettlingSpacing = 0.45;  // m

inline int Scene::SettledFrame(const ModelOptions& model) const {
  return LastPushEnd() + static_cast<int>(std::lround(WaitSeconds(model) / dt));
}

// People in a line along +x, upright, the first pushed along +x at the hip by a half-sine of 12
// frames (0.2 s at 60 Hz) with the named impulse (N s): the settling simulations by which a fit is
// held to settle. 0.45 m is how close people stand in the published group recordings.
inline Scene SettlingScene(double mass, double impulse, int num_people = 1) {
  constexpr int kPushFrames = 12;
  Scene scene;
  for (int n = 0; n < num_people; ++n) {
    ScenePerson person;
    person.body = {mass, kReferenceRod, 0.0};
    person.start.q[0] = kSettlingSpacing * n;
    scene.people.push_back(person);
  }
  scene.pushes.push_back(
      MakeScenePush(0, 0, PushKind::kExternal,
                    HalfSinePush(scene.people[0].body, impulse, kPushFrames, scene.dt)));
  return scene;
}

// Whether a rollout stayed in the model's domain, and if not, where it left it.
struct RolloutStatus {
  bool ok = true;
  int frame = 0;
  int person = 0;
  std::string_view quantity;  // theta, phi, rod or "state" (not finite)
};

}  // namespace pushid
