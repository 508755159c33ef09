// models: the net force on one person in one step, by parts (options.h), and which of them act.
//
// By push kind (push.h) and PushUse (options.h) a `net` push may replace all other forces, and a
// `net_without_friction` push all but the friction, while it lasts.
#pragma once

#include <array>
#include <vector>

#include "models/options.h"
#include "models/scene.h"
#include "models/self_force.h"

namespace pushid {

// The forces that act on a person during one step.
enum class ActiveForces { kAll, kPushAndFriction, kPushOnly };

ActiveForces ForcesAt(const Scene& scene, PushUse use, int person, int frame);

// The force of all pushes on a person in one step, without tails. Constant in the parameters.
Vector4<double> PushForceAt(const Scene& scene, int person, int frame);

// The parts of F_net on one person in one step (options.h).
template <typename T>
struct NetForce {
  std::array<Vector4<T>, kNumForceParts> parts;
  Angles<T> angles;  // of the state at which it acts
  // For feet that hold or step: the ground's resistance (N s/m) to the difference between the
  // cart's velocity after the step and that of the feet, added to the friction when the former is
  // known (AddGround); feet_velocity and, for feet that step, the feet after the step.
  T ground = T(0.0);
  Eigen::Matrix<T, 2, 1> feet_velocity{T(0.0), T(0.0)};  // m/s, of the middle between them
  FeetState<T> next_feet;

  NetForce() { parts.fill(Vector4<T>::Zero()); }
  Vector4<T>& operator[](ForcePart part) { return parts[static_cast<int>(part)]; }
  const Vector4<T>& operator[](ForcePart part) const { return parts[static_cast<int>(part)]; }

  Vector4<T> Total() const {
    Vector4<T> sum = parts[0];
    for (int i = 1; i < kNumForceParts; ++i) sum += parts[i];
    return sum;
  }

  // Whether the person is a body that turns about its ankles in this step (standing.h).
  bool HoldsFast(Stance stance) const { return stance == Stance::kFixed && RealPart(ground) > 0.0; }

  void AddGround(const Vector4<T>& next_qd) {
    for (int i = 0; i < 2; ++i) {
      (*this)[ForcePart::kFriction][i] -= ground * (next_qd[i] - feet_velocity[i]);
    }
  }
};

// The parts of the net force that drove a rollout, for reports; the last frame's drive no step.
using ForceTrace = FrameTable<NetForce<double>>;

// The parts that reports list: all but for noise, for a user's own laws where the model has none,
// and for inertia, which files list where the ground moves.
std::vector<ForcePart> ReportedParts(const ModelOptions& options);

// The self force of everybody in a scene.
std::vector<SelfForce> SelfForces(const Scene& scene, const ModelOptions& options);

}  // namespace pushid
