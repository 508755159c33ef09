// apps: what the report page's explorable person is given, in the page (explore.cc) and by the
// program that writes the page (explore_section.cc).
#pragma once

#include <algorithm>
#include <cmath>

#include "models/scene.h"

namespace pushid {

struct ExploredPush {
  double mass = 0.0, rod = kReferenceRod;  // kg, m
  double impulse = 80.0;                   // N s, along x at the hip, in kPushSeconds
  double dt = 1.0 / 60.0, frames = 360.0;  // s
  double draws = 0.0;                      // how many the band is made of; 0: no band
  // Of ModelOptions.
  double posture = 0, gain_scaling = 0, friction = 0, cart_derivative = 0, stance = 0, delay = 0;
  double body = 0;
  double others = 0;  // whether the model is of people who touch (models/stance.h)
};

// Each choice of ModelOptions beside its number in the push: visit(choice, number).
template <typename Options, typename Push, typename Visit>
void ForEachChoice(Options& options, Push& push, const Visit& visit) {
  visit(options.posture, push.posture);
  visit(options.gain_scaling, push.gain_scaling);
  visit(options.friction, push.friction);
  visit(options.cart_derivative, push.cart_derivative);
  visit(options.stance, push.stance);
  visit(options.delay, push.delay);
  visit(options.body, push.body);
}

inline constexpr int kMostDraws = 60;
inline constexpr double kPushSeconds = 0.2;

// One person who stands upright.
inline Scene SceneOf(const ExploredPush& push) {
  Scene scene;
  scene.dt = push.dt;
  scene.people.resize(1);
  scene.people[0].body = {push.mass, push.rod, 0.0};
  const int rows = std::max(1, static_cast<int>(std::lround(kPushSeconds / push.dt)));
  scene.pushes.push_back(MakeScenePush(
      0, 0, PushKind::kExternal, HalfSinePush(scene.people[0].body, push.impulse, rows, push.dt)));
  return scene;
}

}  // namespace pushid
