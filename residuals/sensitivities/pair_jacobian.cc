// residuals: derivatives of the interaction terms.
#include "residuals/sensitivities/pair_jacobian.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

// A person's contact point by [x, y, theta, phi, height], and its velocity by these and the rates.
struct PointJacobian {
  Eigen::Vector2d place, velocity;
  Eigen::Matrix<double, 2, 8> place_by_state, velocity_by_state;
  Eigen::Vector2d place_by_height, velocity_by_height;
};

PointJacobian PointOf(const Body& body, const PendulumState<double>& state, double height) {
  using Jet = ceres::Jet<double, 5>;  // theta, phi, thetad, phid, height
  PendulumState<Jet> jets;
  for (int i = 0; i < 2; ++i) {
    jets.q[i] = Jet(state.q[i]);
    jets.qd[i] = Jet(state.qd[i]);
    jets.q[2 + i] = Jet(state.q[2 + i], i);
    jets.qd[2 + i] = Jet(state.qd[2 + i], 2 + i);
  }
  const Jet h(height, 4);
  const Vector2<Jet> place = ContactPoint<Jet>(body, jets.q, h);
  const Vector2<Jet> velocity = ContactVelocity(body, jets, h);
  PointJacobian point;
  point.place_by_state.setZero();
  point.velocity_by_state.setZero();
  for (int i = 0; i < 2; ++i) {
    point.place[i] = place[i].a;
    point.velocity[i] = velocity[i].a;
    point.place_by_state(i, i) = point.velocity_by_state(i, 4 + i) = 1.0;
    point.place_by_state.row(i).segment<2>(2) = place[i].v.head<2>().transpose();
    point.velocity_by_state.row(i).segment<2>(2) = velocity[i].v.head<2>().transpose();
    point.velocity_by_state.row(i).segment<2>(6) = velocity[i].v.segment<2>(2).transpose();
    point.place_by_height[i] = place[i].v[4];
    point.velocity_by_height[i] = velocity[i].v[4];
  }
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
  const Vector2<Jet> r0 = ContactPoint<Jet>(pair.body_n, pair.q0_n.cast<Jet>(), height) -
                          ContactPoint<Jet>(pair.body_j, pair.q0_j.cast<Jet>(), height);
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
Eigen::Matrix<double, 4, 5> GeneralizedByForce(const Body& body, const Vector4<double>& q,
                                               double height, const Eigen::Vector2d& f) {
  using Jet = ceres::Jet<double, 5>;
  const Vector4<Jet> at{Jet(q[0]), Jet(q[1]), Jet(q[2], 2), Jet(q[3], 3)};
  const Vector4<Jet> force =
      ContactGeneralizedForce<Jet>(body, at, Jet(height, 4), Jet(f[0], 0), Jet(f[1], 1));
  Eigen::Matrix<double, 4, 5> jacobian;
  for (int row = 0; row < 4; ++row) jacobian.row(row) = force[row].v.transpose();
  return jacobian;
}

template <bool kSpring, bool kDamping>
PairJacobian ContactJacobian(const Pair& pair, const ParameterSet<double>& p,
                             const PendulumState<double>& n, const PendulumState<double>& j) {
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
        side == 0 ? pair.body_n : pair.body_j, side == 0 ? n.q : j.q, height, sign * f.force);
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
PairJacobian OtherJacobian(const InteractionTerms& terms, const InteractionNetwork* network,
                           const Pair& pair, const ParameterSet<double>& p,
                           const PendulumState<double>& n, const PendulumState<double>& j) {
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
  const PairForce<Jet> force = InteractionBetween(terms, network, pair, parameters, a, b);
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

PairJacobian ComputePairJacobian(const InteractionTerms& terms, const InteractionNetwork* network,
                                 const Pair& pair, const ParameterSet<double>& p,
                                 const PendulumState<double>& n, const PendulumState<double>& j) {
  InteractionTerms others = terms;
  others.spring = others.damping = others.learned = false;
  PairJacobian jacobian;
  if (others.Any()) {
    jacobian = OtherJacobian(others, network, pair, p, n, j);
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
