// ident: the most probable way to a pose (SDE's Fig. 5): among sampled futures, and by
// minimization.
//
// Among futures whose last pose is near a target, the one whose transitions have the largest
// likelihood: the least action of the sampled paths. With few samples the true optimum is not among
// them; more samples come nearer to it.
//
// Minimized: the action -log p of a path under the learned drift and noise (residuals/
// cost_functions/path_residual.h has that of the physics), with the end held. What was learned
// remembers all of the path, so that nodes of a path would all hang together; the noise that drives
// it is as good a coordinate, and the action is then
//   sum |e|^2 / 2 + sum log g(e),   rows e and sqrt(2 (sum log g + c)), and (S_T(e) - target) / w
// one residual block for Ceres, its derivatives by differences of futures rolled out side by side.
#pragma once

#include <vector>

#include "datasets/files/error.h"
#include "models/generators/motion_generator.h"

namespace pushid {

struct PathChoice {
  int future = 0;         // its index
  int near = 0;           // how many futures ended near enough
  double distance = 0.0;  // of its last pose from the target, mean of joints, m
  double log_likelihood = 0.0;
};

// Errors: no future ends within `distance` (m) of the target; the message says how near they come.
Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout);

struct MinimizedPath {
  Trajectories motion;
  double distance = 0.0;        // of its last pose from the target, mean of joints, m
  double log_likelihood = 0.0;  // of its transitions, with noise that is drawn anew every frame
  double of_forecast = 0.0;     // the same of the path that nothing drives, wherever it ends
  int iterations = 0;
};

// target: the last pose wanted. Errors: a kind without transitions; no optimum.
Result<MinimizedPath> PathToPose(const MotionGenerator& generator, const ObservedMotion& person,
                                 int frames, const Eigen::VectorXf& target);

}  // namespace pushid
