// ident: the most probable of sampled futures that end where one wants (SDE's Fig. 5).
//
// Among futures whose last pose is near a target, the one whose transitions have the largest
// likelihood: the least action of the sampled paths. With few samples the true optimum is not among
// them; more samples come nearer to it.
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

}  // namespace pushid
