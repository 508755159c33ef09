// ident: The contact energy balance along a rollout: work and impulse on each person.
//
// Work on a person between two frames: (Q_t + Q_t+1) / 2 . (q_t+1 - q_t), the trapezoid of the
// generalized force along the path, so that a spring alone gives back what it took, whatever the
// step. Of each step's total over people the negative part is absorbed by contact (stored or lost),
// the positive part returned; contact still loaded at the last frame has not returned its share.
#pragma once

#include <vector>

#include "models/rollout.h"

namespace pushid {

struct ContactEnergyBalance {
  std::vector<double> work;               // J, on each person
  std::vector<Vector4<double>> impulse;   // integral of the generalized force
  double absorbed = 0.0, returned = 0.0;  // J

  double TotalWork() const { return returned - absorbed; }
};

// forces: those that drove the path (Rollout's trace); its last frame must hold them too.
ContactEnergyBalance BalanceContactEnergy(const RolloutPath<double>& path, const ForceTrace& forces,
                                          double dt);

// The integral of all pushes on a person, tails included, over the path's steps.
Vector4<double> PushImpulse(const ForceTrace& forces, int person, double dt);

}  // namespace pushid
