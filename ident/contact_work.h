// ident: the books of contact along a rollout: work and impulse on each person.
//
// Work on a person between two frames: (Q_t + Q_t+1) / 2 . (q_t+1 - q_t), the trapezoid of the
// generalized force along the path, so that a spring alone gives back what it took, whatever the
// step. Of each step's total over people the negative part is absorbed by contact (stored or lost),
// the positive part returned; contact still loaded at the last frame has not returned its share.
#pragma once

#include <vector>

#include "models/rollout.h"

namespace pushid {

// [frame][person]: the interaction force that acted. The one place that asks the model for it.
std::vector<std::vector<Vector4<double>>> InteractionAlong(
    const Scene& scene, const ModelOptions& options,
    const std::vector<ParameterSet<double>>& parameters, const RolloutPath<double>& path);

struct ContactBooks {
  std::vector<double> work;               // J, on each person
  std::vector<Vector4<double>> impulse;   // integral of the generalized force
  double absorbed = 0.0, returned = 0.0;  // J

  double TotalWork() const { return returned - absorbed; }
};

ContactBooks KeepBooks(const RolloutPath<double>& path,
                       const std::vector<std::vector<Vector4<double>>>& forces, double dt);

// The integral of all pushes on a person, tails included, over the path's steps.
Vector4<double> PushImpulse(const Scene& scene, const ModelOptions& options,
                            const ParameterSet<double>& parameters, int person, int num_frames);

}  // namespace pushid
