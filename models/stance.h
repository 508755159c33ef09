// models: feet that stand, and feet that step.
//
// Capture point, seen from where it rests over the ankles (m), with omega = sqrt(g / l):
//   xi = (hip - cart) - (hip - cart in the rest posture) + hip velocity / omega
//   rho^2 = (xi_x / b)^2 + (xi_y / b_side)^2,   b_back instead of b where xi_x < 0
//
// The step state s of a person, 0 standing, 1 stepping, follows whether rho is beyond 1:
//   s' = beyond (1 - s) / t_on - (1 - beyond) s / t_off,   beyond = 1 / (1 + exp((1 - rho) / 0.05))
// implicit in s, so that it stays between 0 and 1. It is a latch: a step lasts t_off longer than
// what caused it, and a push that is over before t_on hardly lets go.
//
// With the cart's own forces F_c of self_force.h (friction, Kp_x, Kp_y, cart rows of the linear
// terms) these act:
//   ground  -D v on the cart's velocity v after the step, D = (1 - s)^2 M / 5.6 ms, limited by the
//           velocity before the step to about mu_s M g
//   ankles  (1 - s) (hold - lim(Kp e + Kd e')) about each axis; lim keeps the torque, smoothly,
//           to r_a m g times the support: the ground presses no farther out than the toes
//   feet    s F_c, and s times the torque between legs and trunk that takes the cart's velocity to
//           kappa omega xi within 20 ms: the feet go where the person would come to rest
// A torque inside the body moves the feet and leaves the momentum to F_c, to pushes and to gravity.
//
// While a `net` push lasts none of it acts: its rows hold the feet's reaction. From a
// `net_without_friction` push LDP's friction of 100 N s/m was taken out, and it gets that back.
//
// Sources: capture point, Hof 2008 and Pratt et al. 2006; the rest was chosen by how well it
// predicts recordings (tests/studies/stance.py compares it with feet that slide). Rejected: feet
// that are let go to slide under the forces of sliding feet (those who step stop too early); feet
// drawn to a target that was fixed when the step began (it fits worse, and nothing follows it when
// the first step was too short).
#pragma once

#include <cmath>

#include "models/reaction_delay.h"
#include "models/self_force.h"

namespace pushid {

inline constexpr double kSupportEdge = 0.05;         // of rho: where feet begin to let go
inline constexpr double kGroundTime = 1.0 / 180.0;   // s, in which standing feet stop
inline constexpr double kPublishedFriction = 100.0;  // N s/m, taken out of net_without_friction

// The parameters of stance, which derivatives are taken by.
template <typename T>
struct StanceParameters {
  static constexpr Parameter kIds[] = {kKpTheta,      kKpPhi,       kKdTheta,     kKdPhi,
                                       kSupportFront, kSupportBack, kSupportSide, kAnkleReach,
                                       kStepGain,     kStepOnset,   kStepRelease, kStaticFriction};
  static constexpr int kCount = sizeof(kIds) / sizeof(kIds[0]);
  T Kp[2], Kd[2], front, back, side, ankle_reach, gain, onset, release, static_friction;

  // value(id): of a parameter.
  template <typename Value>
  explicit StanceParameters(const Value& value)
      : Kp{value(kKpTheta), value(kKpPhi)},
        Kd{value(kKdTheta), value(kKdPhi)},
        front(value(kSupportFront)),
        back(value(kSupportBack)),
        side(value(kSupportSide)),
        ankle_reach(value(kAnkleReach)),
        gain(value(kStepGain)),
        onset(value(kStepOnset)),
        release(value(kStepRelease)),
        static_friction(value(kStaticFriction)) {}
};

// What standing and stepping do to a person in one step.
template <typename T>
struct StanceForces {
  Eigen::Matrix<T, 2, 1> torque;  // N m, of ankles and legs
  T ground;                       // N s/m, of the ground on the cart's velocity after the step
  T next_step;                    // the step state after the step
};

// xi above; of the rod of frame 0.
template <typename T>
Eigen::Matrix<T, 2, 1> CaptureOffset(const SelfForce& self, const Angles<T>& angles,
                                     const Vector4<T>& qd) {
  const double l = self.body.rod_length, inverse = 1.0 / self.capture_rate;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const T vx = qd[0] + l * c_th * qd[2];
  const T vy = qd[1] + l * (s_th * s_ph * qd[2] - c_th * c_ph * qd[3]);
  return {l * s_th - self.rest_offset[0] + inverse * vx,
          -l * c_th * s_ph - self.rest_offset[1] + inverse * vy};
}

// rho above: how far the capture point has left the support; 1 at its edge.
template <typename T>
T SupportRatio(const StanceParameters<T>& p, const Eigen::Matrix<T, 2, 1>& capture) {
  using std::sqrt;
  constexpr double kTiny = 1e-12;  // a derivative also at rest
  const T x = capture[0] / (RealPart(capture[0]) < 0.0 ? p.back : p.front);
  const T y = capture[1] / p.side;
  return sqrt(x * x + y * y + kTiny);
}

// x limited to -most .. most: smooth, and within 9 % of x up to 0.8 most.
template <typename T>
T SmoothLimit(const T& x, const T& most) {
  using std::sqrt;
  const T x2 = x * x, most2 = most * most;
  return x * most / sqrt(sqrt(x2 * x2 + most2 * most2));
}

// (s + dt beyond / t_on) / (1 + dt beyond / t_on + dt (1 - beyond) / t_off), written with a single
// division; `within` is exp((1 - rho) / 0.05) of beyond = 1 / (1 + within), at most e^20.
template <typename T>
T NextStepState(const StanceParameters<T>& p, const T& rho, const T& step, double dt) {
  using std::exp;
  const T within = exp((1.0 - rho) * (1.0 / kSupportEdge));
  const T times = p.onset * p.release * (1.0 + within), on = dt * p.release;
  return (step * times + on) / (times + on + dt * p.onset * within);
}

template <typename T>
T GroundResistance(const StanceParameters<T>& p, double mass, const PendulumState<T>& state) {
  using std::sqrt;
  const T stands = 1.0 - state.step;
  const T firm = stands * stands * (mass / kGroundTime);
  const T over = firm / (p.static_friction * (mass * kGravity));
  const T speed2 = state.qd[0] * state.qd[0] + state.qd[1] * state.qd[1];
  return firm / sqrt(1.0 + over * over * speed2);
}

// The torques about the ankles that hold the posture.
template <typename T>
Eigen::Matrix<T, 2, 1> AnkleTorque(const SelfForce& self, const StanceParameters<T>& p,
                                   const PendulumState<T>& state) {
  const double weight = self.body.point_mass() * kGravity;
  Eigen::Matrix<T, 2, 1> torque;
  for (int i = 0; i < 2; ++i) {
    const T wanted = self.scale.stiffness * p.Kp[i] * (state.q[2 + i] - self.posture[i]) +
                     self.scale.damping * p.Kd[i] * state.qd[2 + i];
    const T& reach = i == 1 ? p.side : RealPart(wanted) < 0.0 ? p.back : p.front;
    const T most = weight * p.ankle_reach * reach;
    torque[i] = self.hold[i] - SmoothLimit(wanted, most);
  }
  return torque;
}

// The torques between legs and trunk under which, with the cart's own forces, the cart's velocity
// goes to kappa omega xi.
template <typename T>
Eigen::Matrix<T, 2, 1> FootTorque(const SelfForce& self, const StanceParameters<T>& p,
                                  const Angles<T>& angles, const Vector4<T>& qd,
                                  const Eigen::Matrix<T, 2, 1>& capture,
                                  const Eigen::Matrix<T, 2, 1>& cart_force) {
  const Body& body = self.body;
  const Matrix4<T> mass = MassMatrix(body, angles);
  const Vector4<T> coriolis = Coriolis(body, angles, qd), gravity = Gravity(body, angles);
  const T speed = self.capture_rate * p.gain;
  Vector4<T> qdd;
  for (int i = 0; i < 2; ++i) qdd[i] = self.foot_rate * (speed * capture[i] - qd[i]);
  // The cart's rows of M qdd + C = F, solved for the angles.
  const T x = cart_force[0] - coriolis[0] - body.mass * qdd[0];
  const T y = cart_force[1] - coriolis[1] - body.mass * qdd[1];
  qdd[2] = x / mass(0, 2);
  qdd[3] = (y - mass(1, 2) * qdd[2]) / mass(1, 3);
  const T theta = mass(2, 0) * qdd[0] + mass(2, 1) * qdd[1] + mass(2, 2) * qdd[2];
  const T phi = mass(3, 1) * qdd[1] + mass(3, 3) * qdd[3];
  return {theta + coriolis[2] + gravity[2], phi + coriolis[3] + gravity[3]};
}

// cart_force: F_c above, not yet times s. perceived: by ankles and by what steps.
template <typename T>
StanceForces<T> StanceAt(const SelfForce& self, const StanceParameters<T>& p,
                         const Angles<T>& angles, const PendulumState<T>& state,
                         const Perceived<T>& perceived, const Eigen::Matrix<T, 2, 1>& cart_force) {
  const Eigen::Matrix<T, 2, 1> capture =
      CaptureOffset(self, Angles<T>(perceived.step.q), perceived.step.qd);
  const T& s = state.step;
  StanceForces<T> forces;
  forces.torque = (1.0 - s) * AnkleTorque(self, p, perceived.ankle) +
                  s * FootTorque(self, p, angles, state.qd, capture, cart_force);
  forces.ground = GroundResistance(p, self.body.mass, state);
  forces.next_step = NextStepState<T>(p, SupportRatio(p, capture), s, self.dt);
  return forces;
}

}  // namespace pushid
