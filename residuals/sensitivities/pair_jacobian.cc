// residuals: derivatives of the interaction terms.
#include <ceres/jet.h>

#include "residuals/sensitivities/net_force_jacobian.h"

namespace pushid {
namespace {

// A person's contact point by [x, y, theta, phi, height], and its velocity by these and the rates.
struct PointJacobian {
  Eigen::Vector2d place, velocity;
  Eigen::Matrix<double, 2, 8> place_by_state, velocity_by_state;
  Eigen::Vector2d place_by_height, velocity_by_height;
};

// Written out: automatic derivatives of these took as long as all that contact does.
PointJacobian PointOf(const Body& body, const PosedPendulum<double>& state, double height) {
  const double l = body.rod_length, reach = height * l;
  PointJacobian point;
  const auto& [s_th, c_th, s_ph, c_ph] = state.angles;
  const double thd = state.qd[2], phd = state.qd[3];
  point.place = ContactPoint(body, state.q, state.angles, height);
  point.velocity = ContactVelocity(body, state.angles, state.qd, height);
  Eigen::Matrix2d turning;  // of the point by [theta, phi], and of its velocity by their rates
  turning << reach * c_th, 0.0, reach * s_th * s_ph, -reach * c_th * c_ph;
  point.place_by_state.setZero();
  point.place_by_state.leftCols<2>().setIdentity();
  point.place_by_state.middleCols<2>(2) = turning;
  point.velocity_by_state.setZero();
  point.velocity_by_state.middleCols<2>(2) << -reach * s_th * thd, 0.0,
      reach * (c_th * s_ph * thd + s_th * c_ph * phd),
      reach * (s_th * c_ph * thd + c_th * s_ph * phd);
  point.velocity_by_state.middleCols<2>(4).setIdentity();
  point.velocity_by_state.rightCols<2>() = turning;
  point.place_by_height << l * s_th, -l * c_th * s_ph;
  point.velocity_by_height << l * c_th * thd, l * (s_th * s_ph * thd - c_th * c_ph * phd);
  return point;
}

// The force on n's point by [r, v] and by the contact's parameters (height: only through r0).
struct ForceJacobian {
  Eigen::Vector2d force;
  Eigen::Matrix<double, 2, 2> by_place, by_velocity;
  Eigen::Matrix<double, 2, kContactParameters> by_parameter;
};

template <bool kSpring, bool kDamping>
ForceJacobian ForceOf(const Pair& pair, const ParameterSet<double>& p, const PointJacobian& n,
                      const PointJacobian& j) {
  using Jet = ceres::Jet<double, 4 + kContactParameters>;
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kContactParameters; ++i) {
    parameters[kContactStiffness + i] = Jet(p[kContactStiffness + i], 4 + i);
  }
  const Jet& height = parameters[kContactHeight];
  Vector2<Jet> r, v;
  for (int i = 0; i < 2; ++i) {
    r[i] = Jet(n.place[i] - j.place[i], i);
    v[i] = Jet(n.velocity[i] - j.velocity[i], 2 + i);
  }
  const Vector2<Jet> r0 = BetweenFirstContactPoints(pair, height);
  const Vector2<Jet> f = ContactForce<kSpring, kDamping, Jet>(parameters, r, v, r0);
  ForceJacobian result;
  for (int i = 0; i < 2; ++i) {
    result.force[i] = f[i].a;
    result.by_place.row(i) = f[i].v.head<2>().transpose();
    result.by_velocity.row(i) = f[i].v.segment<2>(2).transpose();
    result.by_parameter.row(i) = f[i].v.tail<kContactParameters>().transpose();
  }
  return result;
}

// The generalized force of (fx, fy) on one person by [fx, fy, theta, phi, height].
Eigen::Matrix<double, 4, 5> GeneralizedByForce(const Body& body, const Angles<double>& angles,
                                               double height, const Eigen::Vector2d& f) {
  const double l = body.rod_length, reach = height * l;
  const auto& [s_th, c_th, s_ph, c_ph] = angles;
  const double on_theta = f[0] * c_th + f[1] * s_th * s_ph, on_phi = -f[1] * c_th * c_ph;
  Eigen::Matrix<double, 4, 5> jacobian;
  jacobian << 1.0, 0.0, 0.0, 0.0, 0.0,  //
      0.0, 1.0, 0.0, 0.0, 0.0,          //
      reach * c_th, reach * s_th * s_ph, reach * (f[1] * c_th * s_ph - f[0] * s_th),
      reach * f[1] * s_th * c_ph, l * on_theta,  //
      0.0, -reach * c_th * c_ph, reach * f[1] * s_th * c_ph, reach * f[1] * c_th * s_ph, l * on_phi;
  return jacobian;
}

template <bool kSpring, bool kDamping>
PairJacobian ContactJacobian(const Pair& pair, const ParameterSet<double>& p,
                             const PosedPendulum<double>& n, const PosedPendulum<double>& j) {
  const double height = p[kContactHeight];
  const PointJacobian at_n = PointOf(pair.body_n, n, height);
  const PointJacobian at_j = PointOf(pair.body_j, j, height);
  const ForceJacobian f = ForceOf<kSpring, kDamping>(pair, p, at_n, at_j);

  Eigen::Matrix<double, 2, 16> f_by_states;
  f_by_states << f.by_place * at_n.place_by_state + f.by_velocity * at_n.velocity_by_state,
      -(f.by_place * at_j.place_by_state + f.by_velocity * at_j.velocity_by_state);
  Eigen::Matrix<double, 2, kContactParameters> f_by_parameter = f.by_parameter;
  f_by_parameter.col(kContactParameters - 1) +=
      f.by_place * (at_n.place_by_height - at_j.place_by_height) +
      f.by_velocity * (at_n.velocity_by_height - at_j.velocity_by_height);

  PairJacobian jacobian;
  jacobian.by_parameter.setZero();
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    const Eigen::Matrix<double, 4, 5> q = GeneralizedByForce(
        side == 0 ? pair.body_n : pair.body_j, (side == 0 ? n : j).angles, height, sign * f.force);
    auto by_states = jacobian.by_states.middleRows<4>(4 * side);
    by_states.noalias() = sign * (q.leftCols<2>() * f_by_states);
    by_states.middleCols<2>(8 * side + 2) += q.middleCols<2>(2);
    auto by_parameter =
        jacobian.by_parameter.middleRows<4>(4 * side).leftCols<kContactParameters>();
    by_parameter = sign * (q.leftCols<2>() * f_by_parameter);
    by_parameter.col(kContactParameters - 1) += q.col(4);
  }
  return jacobian;
}

// Jets over both states and all pair parameters, for terms other than contact.
PairJacobian OtherJacobian(const InteractionTerms& terms, const Pair& pair,
                           const ParameterSet<double>& p, const PendulumState<double>& n,
                           const PendulumState<double>& j) {
  using Jet = ceres::Jet<double, 16 + kNumPairParameters>;
  PendulumState<Jet> a, b;
  for (int i = 0; i < 4; ++i) {
    a.q[i] = Jet(n.q[i], i);
    a.qd[i] = Jet(n.qd[i], 4 + i);
    b.q[i] = Jet(j.q[i], 8 + i);
    b.qd[i] = Jet(j.qd[i], 12 + i);
  }
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumPairParameters; ++i) {
    parameters[kFirstPairParameter + i] = Jet(p[kFirstPairParameter + i], 16 + i);
  }
  const PairForce<Jet> force = InteractionBetween<Jet>(terms, pair, parameters, a, b);
  PairJacobian jacobian;
  for (int row = 0; row < 4; ++row) {
    jacobian.by_states.row(row) = force.on_n[row].v.head<16>().transpose();
    jacobian.by_states.row(4 + row) = force.on_j[row].v.head<16>().transpose();
    jacobian.by_parameter.row(row) = force.on_n[row].v.tail<kNumPairParameters>().transpose();
    jacobian.by_parameter.row(4 + row) = force.on_j[row].v.tail<kNumPairParameters>().transpose();
  }
  return jacobian;
}

}  // namespace

PairJacobian ComputePairJacobian(const InteractionTerms& terms, const Pair& pair,
                                 const ParameterSet<double>& p, const PosedPendulum<double>& n,
                                 const PosedPendulum<double>& j) {
  InteractionTerms others = terms;
  others.spring = others.damping = others.learned = false;
  PairJacobian jacobian;
  if (others.Any()) {
    jacobian = OtherJacobian(others, pair, p, n, j);
  } else {
    jacobian.by_states.setZero();
    jacobian.by_parameter.setZero();
  }
  const auto add = [&jacobian](const PairJacobian& contact) {
    jacobian.by_states += contact.by_states;
    jacobian.by_parameter += contact.by_parameter;
  };
  if (terms.spring && terms.damping) {
    add(ContactJacobian<true, true>(pair, p, n, j));
  } else if (terms.spring) {
    add(ContactJacobian<true, false>(pair, p, n, j));
  } else if (terms.damping) {
    add(ContactJacobian<false, true>(pair, p, n, j));
  }
  return jacobian;
}

}  // namespace pushid
