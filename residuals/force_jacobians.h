// residuals: derivatives that are written out: of a person's own force, of the tail and of the
// equations of motion, for rollouts in lanes (lanes/person_lanes_loops.h). Everything else is
// differentiated by jets. These stay because they pay: the self force's take a thirtieth of the
// time that jets need, the tail's two fifths (tests/benchmarks, Jacobian_OfSelfForce,
// Jacobian_OfTail); a whole fit of people alone less than half of that of jets (speed.py
// derivatives). Tests hold them against automatic ones.
#pragma once

#include "models/jet.h"
#include "models/push.h"
#include "models/self_terms.h"

namespace pushid {

// Derivatives of a person's own force, without that of the cart's derivative. by_state: 4 x 8 over
// [q, qd], added to; by_parameter: 4 x kNumParameters, of which the same entries are always
// written, and the rest stay zero, since to clear them takes as long as the derivatives.
template <typename T>
struct SelfJacobian {
  Eigen::Matrix<T, 4, 8> by_state = Eigen::Matrix<T, 4, 8>::Zero();
  Eigen::Matrix<T, 4, kNumParameters> by_parameter = Eigen::Matrix<T, 4, kNumParameters>::Zero();
};

namespace {

// Friction's own parameters as inputs of a jet, by Parameter.
template <typename Jet>
struct FrictionInputs {
  std::array<Jet, kKpX - kMu> own;
  const Jet& operator[](int id) const { return own[id - kMu]; }
};

}  // namespace

// Derivatives of friction, by a jet over its own few inputs, so that a law of friction is its
// formula and its row; flattened, so that they stay in registers. p: by Parameter, of friction's
// own at least.
template <typename L, typename Set, typename T>
[[gnu::flatten]] void AddFrictionJacobian(const SelfTerms<L>& self, const Set& p,
                                          const Vector4<T>& qd, SelfJacobian<T>* jacobian) {
  // By the cart's velocity and by friction's own parameters.
  constexpr int kParameters = kKpX - kMu;
  using Jet = JetOf<T, 2 + kParameters>;
  FrictionInputs<Jet> parameters;
  Vector4<Jet> velocity;
  for (int i = 0; i < 2; ++i) velocity[i] = Jet::Input(qd[i], i);
  for (int i = 0; i < kParameters; ++i) parameters.own[i] = Jet::Input(p[kMu + i], 2 + i);
  const Vector4<Jet> force = self.Friction(parameters, velocity);
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 2; ++i) jacobian->by_state(row, 4 + i) += force[row].Slope(i);
    for (int i = 0; i < kParameters; ++i) {
      jacobian->by_parameter(row, kMu + i) = force[row].Slope(2 + i);
    }
  }
}

// Derivatives of balance and the linear terms.
template <typename L, typename Set, typename T>
void AddControlJacobian(const SelfTerms<L>& self, const Set& p, const PendulumState<T>& state,
                        SelfJacobian<T>* jacobian) {
  auto& by_state = jacobian->by_state;
  auto& by_parameter = jacobian->by_parameter;
  const auto& scale = self.scale;
  const T xd = state.qd[0], yd = state.qd[1], thd = state.qd[2], phd = state.qd[3];
  const T e_th = state.q[2] - self.posture[0], e_ph = state.q[3] - self.posture[1];
  by_state(0, 4) -= scale.force * p[kKpX];
  by_state(1, 5) -= scale.force * p[kKpY];
  by_state(2, 2) -= scale.stiffness * p[kKpTheta];
  by_state(2, 6) -= scale.damping * p[kKdTheta];
  by_state(3, 3) -= scale.stiffness * p[kKpPhi];
  by_state(3, 7) -= scale.damping * p[kKdPhi];
  by_parameter(0, kKpX) = -scale.force * xd;
  by_parameter(1, kKpY) = -scale.force * yd;
  by_parameter(2, kKpTheta) = -scale.stiffness * e_th;
  by_parameter(2, kKdTheta) = -scale.damping * thd;
  by_parameter(3, kKpPhi) = -scale.stiffness * e_ph;
  by_parameter(3, kKdPhi) = -scale.damping * phd;
  const L mass = self.body.mass, ml2 = self.PointInertia();
  by_state(0, 2) += mass * p[kAx];
  by_state(0, 6) += mass * p[kBx];
  by_state(1, 3) -= mass * p[kAy];
  by_state(1, 7) -= mass * p[kBy];
  by_state(2, 4) += mass * p[kTx];
  by_state(3, 5) -= mass * p[kTy];
  by_parameter(0, kAx) = mass * e_th;
  by_parameter(0, kBx) = mass * thd;
  by_parameter(1, kAy) = -mass * e_ph;
  by_parameter(1, kBy) = -mass * phd;
  by_parameter(2, kTx) = mass * xd;
  by_parameter(3, kTy) = -mass * yd;

  const T speed = self.SmoothNorm(xd, yd);
  const T drag = mass * p[kCq], over_speed = drag / speed;
  by_state(0, 4) -= drag * speed + over_speed * xd * xd;
  by_state(0, 5) -= over_speed * xd * yd;
  by_state(1, 4) -= over_speed * xd * yd;
  by_state(1, 5) -= drag * speed + over_speed * yd * yd;
  by_parameter(0, kCq) = -mass * speed * xd;
  by_parameter(1, kCq) = -mass * speed * yd;
  const T rate_th = self.SmoothNorm(thd, T(0.0)), rate_ph = self.SmoothNorm(phd, T(0.0));
  by_state(2, 6) -= ml2 * p[kDq] * (rate_th + thd * thd / rate_th);
  by_state(3, 7) -= ml2 * p[kDq] * (rate_ph + phd * phd / rate_ph);
  by_parameter(2, kDq) = -ml2 * rate_th * thd;
  by_parameter(3, kDq) = -ml2 * rate_ph * phd;
}

// Adds those of TailOf::Force by the parameters to a 4 x kNumParameters matrix.
template <typename L, typename T, typename Matrix>
void AddTailJacobian(const TailOf<L>& tail, const ParameterSet<T>& p, const T& rate, const T& decay,
                     Matrix* by_parameter) {
  const T share = tail.BaseShare(p, rate);
  const T by_base = tail.mass_per_force * rate;  // of the share
  const T per_time = 1.0 / p[kTailTime];
  // d decay / d log tau = decay elapsed / tau, d share / d log tau = -share.
  const T decay_by_tau = decay * tail.elapsed * rate;
  const T gain_by_tau = (p[kTailGain] + share) * decay_by_tau - share * decay;
  const T torque_by_tau = p[kTailTorque] * ((1.0 + share) * decay_by_tau - share * decay);
  for (int row = 0; row < 4; ++row) {
    const L& mean = tail.mean[row];
    const T by_tau = (row < 2 ? gain_by_tau : torque_by_tau) * mean;
    if (row < 2) {
      (*by_parameter)(row, kTailGain) += decay * mean;
      (*by_parameter)(row, kTailBase) += decay * by_base * mean;
    } else {
      (*by_parameter)(row, kTailTorque) += decay * (1.0 + share) * mean;
      (*by_parameter)(row, kTailBase) += p[kTailTorque] * decay * by_base * mean;
    }
    (*by_parameter)(row, kTailTime) += by_tau * per_time;
    (*by_parameter)(row, kTailExponent) += by_tau * tail.log_duration;
  }
}

// d(M a + C + G)/d(theta, phi, thetad, phid) at fixed acceleration a.
template <typename T>
Matrix4<T> InverseDynamicsJacobian(const BodyOf<T>& body, const Angles<T>& angles,
                                   const Vector4<T>& qd, const Vector4<T>& a) {
  const double g = kGravity;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const T l = body.pendulum_length(), ml = body.point_mass() * l;
  const T thd = qd[2], phd = qd[3], both = thd * thd + phd * phd;
  const T s2 = 2.0 * s_th * c_th, c2 = c_th * c_th - s_th * s_th;
  const T s_s = s_th * s_ph, s_c = s_th * c_ph, c_s = c_th * s_ph, c_c = c_th * c_ph;
  Matrix4<T> by;  // rows x, y, theta, phi; by theta, phi and their rates
  by << -s_th * a[2] - c_th * thd * thd, T(0.0), -2.0 * s_th * thd, T(0.0),  //
      c_s * a[2] + s_c * a[3] + 2.0 * c_c * thd * phd - s_s * both,
      s_c * a[2] + c_s * a[3] - 2.0 * s_s * thd * phd + c_c * both, 2.0 * (s_c * phd + c_s * thd),
      2.0 * (s_c * thd + c_s * phd),  //
      -s_th * a[0] + c_s * a[1] + l * c2 * phd * phd - g * c_c, s_c * a[1] + g * s_s, T(0.0),
      l * s2 * phd,  //
      s_c * a[1] - l * s2 * a[3] - 2.0 * l * c2 * thd * phd + g * s_s, c_s * a[1] - g * c_c,
      -l * s2 * phd, -l * s2 * thd;
  return ml * by;
}

}  // namespace pushid
