// residuals: what force platforms measured against what a rollout asks of the ground.
//
// With F = M (a + A) + C + (g_n / g) G - Q_push what the ground and the muscles do to a person at
// frame t (a = (qd(t+1) - qd(t)) / dt; A, g_n: ground.h), h the height of the ankles and F_z the
// vertical force,
//   shear   F_x, F_y
//   centre  p_x = x - (F_theta + h F_x) / F_z,   p_y = y + (F_phi - h F_y) / F_z
// less the centre of the start posture at rest: foot and ground hand on what the ankles ask for
// (Winter, Biomechanics and Motor Control of Human Movement, 2009, section 5.2; feet without mass).
//   r = w [ (shear - measured) / s_shear, (centre - measured) / s_centre ]
// with the robust weight of frames (frame_residual.h), of these four rows alone. Nothing of the
// model's control is in them: platforms measure inverse dynamics.
#pragma once

#include "datasets/loading/pendulum_recording.h"
#include "models/net_force.h"
#include "residuals/frame_residual.h"

namespace pushid {

inline constexpr int kPlateResiduals = 4;

template <typename T>
using PlateVector = Eigen::Matrix<T, kPlateResiduals, 1>;

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

// [F_x, F_y, p_x, p_y] for a pendulum that accelerates so; push: N, N m.
template <typename T>
PlateVector<T> GroundReaction(const BodyOf<T>& body, const PendulumState<T>& state,
                              const Vector4<T>& a, const GroundStep& ground,
                              const Vector4<T>& push) {
  const Angles<T> angles(state.q);
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const Vector4<T> felt = a + ground.acceleration.cast<T>();
  const Vector4<T> force = MassMatrix<T, T>(body, angles) * felt +
                           Coriolis<T, T>(body, angles, state.qd) +
                           T(ground.gravity / kGravity) * Gravity<T, T>(body, angles) - push;
  const T thd = state.qd[2], phd = state.qd[3];
  const T rise = -(c_th * c_ph) * (thd * thd + phd * phd) + 2.0 * s_th * s_ph * thd * phd -
                 s_th * c_ph * felt[2] - c_th * s_ph * felt[3];
  const T vertical =
      body.mass * T(ground.gravity) + body.point_mass() * body.pendulum_length() * rise;
  const T& h = body.cart_height;
  return {force[0], force[1], state.q[0] - (force[2] + h * force[0]) / vertical,
          state.q[1] + (force[3] - h * force[1]) / vertical};
}

// r before the robust weight; next_qd: the velocity one frame on.
template <typename T>
PlateVector<T> RawPlateResidual(const PlatePlace& place, const ParameterSet<T>& p,
                                const PendulumState<T>& state, const Vector4<T>& next_qd,
                                const PlateFrame& measured, const ResidualSigmas& sigmas) {
  const Scene& scene = *place.scene;
  const ScenePerson& person = scene.people[place.person];
  const BodyOf<T> body = DynamicBody<T>(*place.options, person.body, p,
                                        place.options->stance == Stance::kFixed);
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
PlateVector<double> PlateResidualWithJacobian(const PlatePlace& place,
                                              const ParameterSet<double>& p,
                                              const PendulumState<double>& state,
                                              const Vector4<double>& next_qd,
                                              const PlateFrame& measured,
                                              const ResidualSigmas& sigmas,
                                              PlateJacobian* jacobian);

}  // namespace pushid
