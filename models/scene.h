// models: everything about a push event that is not a parameter: who stands where, and who is
// pushed.
#pragma once

#include <vector>

#include "models/ipm.h"
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

  int num_people() const { return static_cast<int>(people.size()); }
  int LastPushEnd() const {
    int end = 0;
    for (const ScenePush& push : pushes) end = std::max(end, push.EndFrame());
    return end;
  }
};

// The same scene with every push multiplied by `factor`.
inline Scene ScalePushes(Scene scene, double factor) {
  for (ScenePush& push : scene.pushes) {
    for (Vector4<double>& row : push.force) row *= factor;
    push.mean *= factor;
  }
  return scene;
}

// One upright person pushed along +x at the hip by a half-sine of 12 frames (0.2 s at 60 Hz) with
// the named impulse (N s): the demonstration by which a fit is held to settle.
inline Scene DemonstrationScene(double mass, double impulse, double rod_length = kReferenceRod,
                                double dt = 1.0 / 60.0) {
  constexpr int kPushFrames = 12;
  Scene scene;
  scene.dt = dt;
  ScenePerson person;
  person.body = {mass, rod_length, 0.0};
  scene.people.push_back(person);
  scene.pushes.push_back(MakeScenePush(0, 0, PushKind::kExternal,
                                       HalfSinePush(person.body, impulse, kPushFrames, dt)));
  return scene;
}

}  // namespace pushid
