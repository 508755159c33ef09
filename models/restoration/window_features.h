// models: what the window network sees of a person at one frame, and what it says.
//
// Everything in the frame of the heading at frame 0, lengths in m, angles in rad:
//   per lag of 0, +-2, 4, 6, 8, 12, 16, 24 frames (at 60 Hz; by time at other rates):
//     cart x, y against now (at lag 0: against frame 0), theta, phi against frame 0        60
//   per lag of 0, +-6, +-12: rates of x, y, theta, phi                                     20
//   time since the push begins (at most 2 s), mass, rod length, leg length                  4
//   of frame 0: theta, phi, and knees, ankles, wrists, head against the hip                23
// Lags beyond an end see the end. The output, 63: every other joint against the hip, less the same
// at frame 0. No number depends on where the person stands or on what the network said before.
#pragma once

#include <vector>

#include "models/restoration/restoration.h"

namespace pushid {

inline constexpr int kWindowInputs = 107;
inline constexpr int kWindowOutputs = 3 * (kBodyJoints - 1);

// A column per frame.
Eigen::MatrixXf WindowInputs(const RestorationInput& person);

// The true outputs of a recorded motion (as many frames as q has, or fewer).
Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion);

// From outputs to a motion whose hip goes with the rod's tip.
BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs);

}  // namespace pushid
