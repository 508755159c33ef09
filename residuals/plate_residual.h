// residuals: what force platforms measured against what a rollout asks of the ground.
//
// The shear and the centre of pressure of models/ground.h, a = (qd(t+1) - qd(t)) / dt, the
// centre less that of the start posture at rest:
//   r = w [ (shear - measured) / s_shear, (centre - measured) / s_centre ]
// with the robust weight of frames (frame_residual.h), of these four rows alone. Nothing of the
// model's control is in them: platforms measure inverse dynamics.
#pragma once

#include "datasets/loading/pendulum_recording.h"
#include "models/ground.h"
#include "models/step.h"
#include "residuals/frame_residual.h"

namespace pushid {

inline constexpr int kPlateResiduals = 4;

template <typename T>
using PlateVector = GroundReactionOf<T>;

// One person at one frame.
struct PlatePlace {
  const Scene* scene;
  const ModelOptions* options;
  int person = 0, frame = 0;
};

// A person as platforms see it in all frames of a rollout alike: the body, and where the centre
// of pressure is at rest in the start posture.
template <typename T>
struct BodyOnPlates {
  BodyOf<T> body;
  GroundReactionOf<T> at_rest;

  BodyOnPlates(const Scene& scene, const ModelOptions& options, int person,
               const ParameterSet<T>& p)
      : body(DynamicBody<T>(options, scene.people[person].body, p,
                            options.stance == Stance::kFixed)) {
    const Vector4<T> none = Vector4<T>::Zero();
    PendulumState<T> rest;
    rest.q = scene.people[person].start.q.template cast<T>();
    at_rest = GroundReaction<T>(body, rest, none, GroundStep{}, none);
  }
};

// next_qd: the velocity one frame on.
template <typename T>
PlateVector<T> PlateResidual(const PlatePlace& place, const BodyOnPlates<T>& on_plates,
                             const ParameterSet<T>& p, const PendulumState<T>& state,
                             const Vector4<T>& next_qd, const PlateFrame& measured,
                             const ResidualSigmas& sigmas) {
  const auto& [scene, options, person, frame] = place;
  Vector4<T> push = PushForceAt(*scene, person, frame).template cast<T>();
  if (options->body == BodyModel::kTable) push *= p[kPushGain];
  const Vector4<T> a = (next_qd - state.qd) * T(1.0 / scene->dt);
  const PlateVector<T> now =
      GroundReaction<T>(on_plates.body, state, a, scene->ground.StepAt(frame), push);
  PlateVector<T> r;
  for (int i = 0; i < 2; ++i) {
    r[i] = (now[i] - measured.shear[i]) / sigmas.shear;
    r[2 + i] = (now[2 + i] - on_plates.at_rest[2 + i] - measured.centre[i]) / sigmas.centre;
  }
  // A push that stands for all forces while it lasts hides what the ground did.
  const bool known = ForcesAt(*scene, options->push, person, frame) == ActiveForces::kAll;
  return T(known ? measured.weight : 0.0) * RobustWeight<T>(r.squaredNorm(), sigmas.robust) * r;
}

}  // namespace pushid
