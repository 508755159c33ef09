// models: a person whose feet hold, whatever happens: a body that turns about its ankles.
//
// The body above the ankles has the mass 0.97 M, its centre of mass at the height h = k l (l: the
// rod, from ankles to hip; k: com_height) and the moment of inertia 1.15 m h^2 about the ankles. It
// moves like the pendulum of ipm.h that has the same first moment and the same inertia,
//   rod 1.15 k l,   point mass 0.97 M / 1.15,
// on a cart that the ground holds. Sources: mass and k, Winter, Biomechanics and Motor Control of
// Human Movement, 2009, tables 4.1 (k 1.09; de Leva 1996: 1.12); 1.15, Peterka, J. Neurophysiol.
// 2002 (66 kg m^2 / 76 kg (0.87 m)^2), and de Leva's segments.
//
// With u the unit vector along the rod, u0 that of the reference posture and a the angle between
// them, the ankles' torque is, about each angle q_i,
//   -K t du/dq_i - Kd_i |du/dq_i|^2 q_i' + hold_i,   t = (a / sin a) (u cos a - u0), |t| = a,
//   K = diag(Kp_theta, Kp_phi, their mean),   hold_i: of a force that balances gravity at u0,
// which is the same in all directions where the gains are. Where the mass of a body is known by
// its segments (ipm.h), that is what turns, and k / 1.09 scales its height.
// Rejected: the mass at the hip (0.9 M, no inertia of its own): of one simulated rigid body whose
// pushes are known Kp comes out 10 to 16 % too low, and Kd as much too high.
#pragma once

#include "models/self_force.h"

namespace pushid {

inline constexpr double kMassAboveAnkles = 0.97;  // of the body's
inline constexpr double kInertiaRatio = 1.15;     // about the ankles, over m h^2
inline constexpr double kComOverHip = 1.09;       // k of an average body

inline bool IsPointAtHip(const Body& body) {
  return body.point_share == Body{}.point_share && body.pendulum_ratio == 1.0;
}

// The pendulum that moves like the body.
template <typename T>
BodyOf<T> StandingBody(const Body& body, const T& com_height) {
  if (IsPointAtHip(body)) {
    return {T(body.mass), T(body.rod_length), T(body.cart_height),
            T(kMassAboveAnkles / kInertiaRatio), kInertiaRatio * com_height};
  }
  return {T(body.mass), T(body.rod_length), T(body.cart_height), T(body.point_share),
          (body.pendulum_ratio / kComOverHip) * com_height};
}

// The body's first moment about the ankles per unit of com_height, kg m.
inline double MomentPerComHeight(const Body& body) {
  const double share =
      IsPointAtHip(body) ? kMassAboveAnkles : body.point_share * body.pendulum_ratio / kComOverHip;
  return share * body.mass * body.rod_length;
}

// asin(s) / s by s^2: within 1e-4 up to 0.6 rad.
template <typename T>
T AngleOverSine(const T& s2) {
  return 1.0 + s2 * (1.0 / 6.0 + s2 * (3.0 / 40.0 + s2 * (5.0 / 112.0 + s2 * (35.0 / 1152.0))));
}

// The torque that holds the posture, by com_height: N m over the sine of the lean.
inline double HoldPerComHeight(const SelfForce& self) {
  if (self.hold.isZero(0.0)) return 0.0;
  return kGravity * MomentPerComHeight(self.body) / self.rest_direction[2];
}

// About both axes, N m.
template <typename T>
Eigen::Matrix<T, 2, 1> StandingTorque(const SelfForce& self, const ParameterSet<T>& p,
                                      const Angles<T>& angles, const Vector4<T>& qd) {
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const Vector3<double>& u0 = self.rest_direction;
  const Vector3<T> u{s_th, -c_th * s_ph, c_th * c_ph};
  const Vector3<T> by[2] = {{c_th, s_th * s_ph, -s_th * c_ph},
                            {T(0.0), -c_th * c_ph, -c_th * s_ph}};
  const T cosine = u[0] * u0[0] + u[1] * u0[1] + u[2] * u0[2];
  const T stretch = self.scale.stiffness * AngleOverSine<T>(1.0 - cosine * cosine);
  const T &K_theta = p[kKpTheta], &K_phi = p[kKpPhi];
  const T gains[] = {stretch * K_theta, stretch * K_phi, stretch * 0.5 * (K_theta + K_phi)};
  const T moment = HoldPerComHeight(self) * p[kComHeight];
  Eigen::Matrix<T, 2, 1> torque;
  for (int i = 0; i < 2; ++i) {
    torque[i] = -moment * (u0[0] * by[i][0] + u0[1] * by[i][1]);
    for (int k = 0; k < 3; ++k) torque[i] -= gains[k] * (u[k] * cosine - u0[k]) * by[i][k];
  }
  torque[0] -= self.scale.damping * p[kKdTheta] * qd[2];
  torque[1] -= self.scale.damping * p[kKdPhi] * c_th * c_th * qd[3];
  return torque;
}

// The body of a rollout where the table has its masses (ipm.h).
template <typename T>
BodyOf<T> TableBody(const Body& body, const ParameterSet<T>& p) {
  return Distributed<T>(body, {p[kCartMassShare], p[kComHeight], p[kGyrationRadius]});
}

// The torque that holds a body with the table's masses, less that of its own masses.
template <typename T>
Eigen::Matrix<T, 2, 1> HoldOfTable(const SelfForce& self, const ParameterSet<T>& p) {
  const BodyOf<T> body = TableBody(self.body, p);
  const double own = self.body.point_share * self.body.pendulum_ratio;
  const T more = body.point_share * body.pendulum_ratio / own - 1.0;
  return {more * self.hold[0], more * self.hold[1]};
}

// The body whose equations of motion a step has.
template <typename T>
BodyOf<T> DynamicBody(const ModelOptions& options, const Body& body, const ParameterSet<T>& p,
                      bool holds_fast) {
  if (holds_fast) return StandingBody<T>(body, p[kComHeight]);
  if (options.body == BodyModel::kTable) return TableBody(body, p);
  return BodyNow<T>(body, T(0.0));
}

}  // namespace pushid
