// models: siMLPe, a motion forecaster to compare with: no pendulum and no push, only the motion
// so far. In the manner of siMLPe (Guo et al., Back to MLP, WACV 2023): the cosine transform over
// time of 12 given frames, fully connected layers, 6 frames predicted as displacements from the
// last given one; again and again on its own output until all frames are there. Smaller than the
// published network: dense layers over all coefficients at once, as many as the window network has.
//
// Joints are seen against the hip of the last given frame and in its heading, at 60 Hz.
#pragma once

#include "models/restoration/body.h"
#include "models/restoration/dense_network.h"

namespace pushid {

inline constexpr int kGivenFrames = 12, kSimlpeFrames = 6;
inline constexpr int kSimlpeInputs = 3 * kBodyJoints * kGivenFrames;
inline constexpr int kSimlpeOutputs = 3 * kBodyJoints * kSimlpeFrames;

struct SimlpeWeights {
  Scaling inputs;
  DenseNetwork network;  // outputs in m
};

// Of the frames [last - 11, last] of a motion.
Eigen::VectorXf SimlpeInput(const BodyMotion& motion, int last);
// Of the frames [last + 1, last + 6].
Eigen::VectorXf SimlpeTarget(const BodyMotion& motion, int last);

// The first 12 frames as given, the rest predicted; `frames` in all.
BodyMotion ContinueMotion(const SimlpeWeights& weights, const BodyMotion& given, int frames);

}  // namespace pushid
