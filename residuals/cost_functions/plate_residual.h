// residuals: what force platforms measured against what a rollout asks of the ground.
//
// The shear and the centre of pressure of models/ground_reaction.h, a = (qd(t+1) - qd(t)) / dt, the
// centre less that of the start posture at rest:
//   r = w [ (shear - measured) / s_shear, (centre - measured) / s_centre ]
// with the robust weight of frames (frame_residual.h), of these four rows alone. Nothing of the
// model's control is in them: platforms measure inverse dynamics.
#pragma once

#include "datasets/loading/pendulum_recording.h"
#include "models/ground_reaction.h"
#include "models/net_force.h"
#include "residuals/frame_residual.h"

namespace pushid {

inline constexpr int kPlateResiduals = 4;

template <typename T>
using PlateVector = GroundReactionOf<T>;

// Of one person at one frame.
struct PlatePlace {
  const Scene* scene;
  const ModelOptions* options;
  int person = 0, frame = 0;

  // A push that stands for all forces while it lasts hides what the ground did.
  bool Known() const {
    return ForcesAt(*scene, options->push, person, frame) == ActiveForces::kAll;
  }
};

// r before the robust weight; next_qd: the velocity one frame on.
template <typename T>
PlateVector<T> RawPlateResidual(const PlatePlace& place, const ParameterSet<T>& p,
                                const PendulumState<T>& state, const Vector4<T>& next_qd,
                                const PlateFrame& measured, const ResidualSigmas& sigmas) {
  const Scene& scene = *place.scene;
  const ScenePerson& person = scene.people[place.person];
  const BodyOf<T> body =
      DynamicBody<T>(*place.options, person.body, p, place.options->stance == Stance::kFixed);
  GroundStep ground;
  if (scene.ground.moves()) ground = scene.ground.steps[place.frame];
  Vector4<T> push = PushForceAt(scene, place.person, place.frame).template cast<T>();
  if (place.options->body == BodyModel::kTable) push *= p[kPushGain];
  const Vector4<T> a = (next_qd - state.qd) * T(1.0 / scene.dt);
  PendulumState<T> rest;
  rest.q = person.start.q.template cast<T>();
  const Vector4<T> none = Vector4<T>::Zero();
  const PlateVector<T> now = GroundReaction<T>(body, state, a, ground, push);
  const PlateVector<T> before = GroundReaction<T>(body, rest, none, GroundStep{}, none);
  PlateVector<T> r;
  for (int i = 0; i < 2; ++i) {
    r[i] = (now[i] - measured.shear[i]) / sigmas.shear;
    r[2 + i] = (now[2 + i] - before[2 + i] - measured.centre[i]) / sigmas.centre;
  }
  return r;
}

template <typename T>
PlateVector<T> PlateResidual(const PlatePlace& place, const ParameterSet<T>& p,
                             const PendulumState<T>& state, const Vector4<T>& next_qd,
                             const PlateFrame& measured, const ResidualSigmas& sigmas) {
  const PlateVector<T> r = RawPlateResidual<T>(place, p, state, next_qd, measured, sigmas);
  const double weight = place.Known() ? measured.weight : 0.0;
  return T(weight) * RobustWeight<T>(r.squaredNorm(), sigmas.robust) * r;
}

// Parameters that decide a body, and hence what platforms see of its motion.
inline constexpr Parameter kPlateParameters[] = {kComHeight, kCartMassShare, kGyrationRadius,
                                                 kPushGain};
inline constexpr int kNumPlateParameters = 4;
// Columns: q, qd, the next qd, then kPlateParameters.
inline constexpr int kPlateColumns = 12 + kNumPlateParameters;
using PlateJacobian = Eigen::Matrix<double, kPlateResiduals, kPlateColumns, Eigen::RowMajor>;

// PlateResidual with its derivatives.
PlateVector<double> PlateResidualWithJacobian(
    const PlatePlace& place, const ParameterSet<double>& p, const PendulumState<double>& state,
    const Vector4<double>& next_qd, const PlateFrame& measured, const ResidualSigmas& sigmas,
    PlateJacobian* jacobian);

}  // namespace pushid
