// tests: recordings made in memory: people who stand on ground that moves, or are pushed on and on.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "datasets/files/random.h"
#include "datasets/loading/pendulum_recording.h"
#include "models/ground.h"
#include "models/rollout.h"

namespace pushid {

inline ModelOptions StandingOptions(Delay delay = Delay::kNone) {
  ModelOptions options;
  options.stance = Stance::kFixed;
  options.posture = Posture::kUpright;
  options.delay = delay;
  return options;
}

inline ParameterSet<double> StandingGains(double kp, double kd, double delay = 0.0,
                                          double passive = 0.0) {
  ParameterSet<double> p{};
  p[kKpTheta] = p[kKpPhi] = kp, p[kKdTheta] = p[kKdPhi] = kd;
  p[kComHeight] = 1.09;
  p[kReactionDelay] = p[kStepDelay] = delay;
  p[kPassiveStiffness] = p[kPassiveDamping] = passive;
  return p;
}

// sum of sin(2 pi 0.1 k t + k^2) / k over k = 1, 3, 5, 9, 13, 17: repeats itself after 10 s.
inline double SumOfSines(double seconds) {
  double sum = 0.0;
  for (int k : {1, 3, 5, 9, 13, 17}) {
    sum += std::sin(2.0 * M_PI * 0.1 * k * seconds + k * k) / k;
  }
  return sum;
}

// Ground that moves by value(seconds) in one row of its pose.
template <typename Value>
GroundMotion OscillatingGround(int row, int frames, double dt, Value value) {
  std::vector<GroundPose> poses(frames, GroundPose::Zero());
  for (int t = 0; t < frames; ++t) poses[t][row] = value(t * dt);
  return GroundThrough(std::move(poses), dt);
}

// The recording of a rollout of people alone, each a recording's only one; with platforms, those of
// the model. noise: as in Rollout, may be null.
inline PendulumRecording RecordingOf(Scene scene, const ModelOptions& options,
                                     const ParameterSet<double>& p, int frames,
                                     const std::string& subject, bool platforms = false,
                                     const FrameTable<Vector4<double>>* noise = nullptr) {
  RolloutPath<double> path;
  EXPECT_TRUE(Rollout<double>(scene, options, {p}, InitialVelocities(scene), frames, &path, nullptr,
                              nullptr, noise)
                  .ok);
  PendulumRecording recording;
  recording.id = subject;
  recording.subject_ids = {subject};
  recording.states.resize(1), recording.hip.resize(1), recording.rod_length.resize(1);
  const Body& body = scene.people[0].body;
  for (int t = 0; t < frames; ++t) {
    recording.states[0].push_back(path.At(t, 0));
    recording.hip[0].push_back(HipPosition(body, path.At(t, 0).q));
    recording.rod_length[0].push_back(body.rod_length);
  }
  if (platforms) {
    recording.plates.resize(1);
    const BodyOf<double> turns =
        DynamicBody<double>(options, body, p, options.stance == Stance::kFixed);
    const GroundReactionOf<double> rest = GroundReaction<double>(
        turns, path.At(0, 0), Vector4<double>::Zero(), GroundStep{}, Vector4<double>::Zero());
    for (int t = 0; t < frames; ++t) {
      const int at = std::min(t, frames - 2);
      const PendulumState<double>& state = path.At(at, 0);
      const Vector4<double> a = (path.At(at + 1, 0).qd - state.qd) / scene.dt;
      const GroundReactionOf<double> f = GroundReaction<double>(
          turns, state, a, scene.ground.StepAt(at), PushForceAt(scene, 0, at));
      recording.plates[0].push_back({f.head<2>(), f.tail<2>() - rest.tail<2>(), 1.0});
    }
  }
  recording.scene = std::move(scene);
  return recording;
}

inline Scene StandingScene(double dt, const Body& body = Body{}) {
  Scene scene;
  scene.dt = dt;
  scene.people.push_back({body, {}});
  return scene;
}

}  // namespace pushid
