// models: what the window network sees of a person at one frame, and what it says.
//
// Everything in the frame of the heading at frame 0, lengths in m, angles in rad:
//   the pendulum (not with the view `pose`)
//     per lag of 0, +-2, 4, 6, 8, 12, 16, 24 frames (at 60 Hz; by time at other rates):
//       cart x, y against now (at lag 0: against frame 0), theta, phi against frame 0      60
//     per lag of 0, +-6, +-12: rates of x, y, theta, phi                                   20
//   the person
//     time since the push begins (at most 2 s), mass, rod length, leg length                4
//     of frame 0: theta, phi, and knees, ankles, wrists, head against the hip              23
//   the neighbours (`neighbours`): neighbour_features.h                                   104
//   the push (`pose`): impulse over the mass of who is pushed (x, y), m/s; its duration, s; the hip
//     of who is pushed against the person's, at frame 0 (x, y)                              5
// Lags beyond an end see the end. No number depends on where the person stands or on what the
// network said before.
//
// The output, 63: every other joint against the hip, less the same at frame 0; with `pose` also the
// way of the hip since frame 0, 3, which otherwise goes with the rod's tip.
#pragma once

#include <vector>

#include "models/restoration/neighbour_features.h"
#include "models/restoration/restoration.h"
#include "models/restoration/restoration_view.h"

namespace pushid {

int WindowInputRows(RestorationView view);
int WindowOutputRows(RestorationView view);

// A column per frame, of person n.
Eigen::MatrixXf WindowInputs(const std::vector<RestorationInput>& people, int n,
                             RestorationView view);

// The true outputs of a recorded motion (as many frames as q has, or fewer).
Eigen::MatrixXf WindowTargets(const RestorationInput& person, const BodyMotion& motion,
                              RestorationView view);

// From outputs to a motion.
BodyMotion MotionFromOutputs(const RestorationInput& person, const Eigen::MatrixXf& outputs,
                             RestorationView view);

}  // namespace pushid
