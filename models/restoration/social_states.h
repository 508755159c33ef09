// models: what people in a crowd do, frame by frame, as one of six symbols:
//
//   3 * push + posture
//   posture  2 step: an ankle's horizontal speed is above 0.35 m/s; else
//            1 lean: the line from between the ankles to the hip has turned by more than 5 degrees
//              since frame 0; else
//            0 stand
//   push     1: a wrist is within 0.35 m of the upper spine of the person in front, and the
//            own hip goes forwards (+x) faster than 0.08 m/s
//
// Speeds are backward differences; frame 0 has the symbol of frame 1. In front stands the nearest
// at frame 0 with dx > 0 and |dy| < dx, hip from hip; people without anybody in front push nobody.
#pragma once

#include <functional>
#include <vector>

#include "models/particles.h"
#include "models/restoration/body.h"

namespace pushid {

// Symbols of a group, [person]; another set of symbols may be put in its place.
struct StateFunction {
  int num_symbols = 0;
  std::function<std::vector<Symbols>(const std::vector<BodyMotion>& people, double dt)> of;
};

enum SocialState { kStand, kLean, kStep, kPushStanding, kPushLeaning, kPushStepping };
inline constexpr int kSocialStates = 6;

std::vector<Symbols> SocialStates(const std::vector<BodyMotion>& people, double dt);
inline StateFunction SocialStateFunction() { return {kSocialStates, SocialStates}; }

}  // namespace pushid
