// residuals: the chain rule through gate and layers.
#include "residuals/sensitivities/learned_pair_jacobian.h"

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

using Output = Eigen::Matrix<double, 4, Eigen::Dynamic, Eigen::RowMajor>;

// d(output)/d(inputs), and into by_weight, scaled, d(output)/d(weights).
Output Backward(const PairShape& shape, const double* weights, const PairLayers<double>& layers,
                double scale, Eigen::Ref<Output> by_weight) {
  int at = shape.num_weights();
  Output back = Output::Identity(4, 4);  // d(output)/d(sums of the layer)
  for (int i = static_cast<int>(shape.hidden.size()); i >= 0; --i) {
    const Eigen::VectorXd& from = layers.values[i];
    const int inputs = static_cast<int>(from.size()), rows = static_cast<int>(back.cols());
    at -= rows * (inputs + 1);
    if (by_weight.cols() > 0) {
      for (int row = 0; row < rows; ++row) {
        auto own = by_weight.middleCols(at + row * (inputs + 1), inputs + 1);
        own.leftCols(inputs).noalias() = scale * back.col(row) * from.transpose();
        own.col(inputs) = scale * back.col(row);
      }
    }
    const Output by_from = back * PairLayer(weights + at, rows, inputs).leftCols(inputs);
    if (i == 0) return by_from;
    const Eigen::VectorXd slope = shape.ldp ? (from.array() > 0.0).cast<double>().matrix().eval()
                                            : (1.0 - from.array().square()).matrix().eval();
    back = by_from * slope.asDiagonal();
  }
  return back;  // not reached: the inputs are the first layer's
}

// side: whose force it is, 0 of n and 1 of j.
void AddResponse(const PairShape& shape, const Pair& pair, const GateJacobian& gate, int side,
                 const PairResponse& response, PairJacobian* jacobian) {
  const double scale = shape.ForceUnit(side == 0 ? pair.body_n : pair.body_j);
  const Eigen::Matrix<double, 4, 16> own =
      scale * gate.gate * PairInputsByStates(response.by_input);
  auto by_states = jacobian->by_states.middleRows<4>(4 * side);
  by_states.leftCols<8>() += side == 0 ? own.leftCols<8>() : own.rightCols<8>();
  by_states.rightCols<8>() += side == 0 ? own.rightCols<8>() : own.leftCols<8>();
  const Vector4<double> output = scale * response.output;
  by_states.middleCols<4>(0) += output * gate.by_places.head<4>();
  by_states.middleCols<4>(8) += output * gate.by_places.tail<4>();
  jacobian->by_parameter.middleRows<4>(4 * side).leftCols<kContactParameters>() +=
      output * gate.by_parameter;
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

GateJacobian PairGateJacobian(const PairShape& shape, const Pair& pair,
                              const ParameterSet<double>& p, const Vector4<double>& q_n,
                              const Vector4<double>& q_j) {
  if (shape.ldp) {  // a hard switch
    return {PairGate<double>(shape, pair, p, q_n, q_j), Eigen::Matrix<double, 1, 8>::Zero(),
            Eigen::Matrix<double, 1, kContactParameters>::Zero()};
  }
  using Jet = ceres::Jet<double, 8 + kContactParameters>;
  Vector4<Jet> n, j;
  for (int i = 0; i < 4; ++i) {
    n[i] = Jet(q_n[i], i);
    j[i] = Jet(q_j[i], 4 + i);
  }
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kContactParameters; ++i) {
    parameters[kContactStiffness + i] = Jet(p[kContactStiffness + i], 8 + i);
  }
  const Jet gate = PairGate<Jet>(shape, pair, parameters, n, j);
  return {gate.a, gate.v.head<8>().transpose(), gate.v.tail<kContactParameters>().transpose()};
}

void AddLearnedPairJacobian(const PairShape& shape, const double* weights, const Pair& pair,
                            const ParameterSet<double>& p, const PendulumState<double>& n,
                            const PendulumState<double>& j, PairJacobian* jacobian,
                            PairByWeight* by_weight) {
  if (by_weight != nullptr) by_weight->setZero(8, shape.num_weights());
  const GateJacobian gate = PairGateJacobian(shape, pair, p, n.q, j.q);
  if (!(gate.gate > 0.0)) return;
  PairLayers<double> layers;
  Output unwanted(4, 0);
  for (int side = 0; side < 2; ++side) {
    const double unit = shape.ForceUnit(side == 0 ? pair.body_n : pair.body_j);
    RunPairNetwork(shape, weights, side == 0 ? n : j, side == 0 ? j : n, &layers);
    const Output by_input = by_weight == nullptr
                                ? Backward(shape, weights, layers, 0.0, unwanted)
                                : Backward(shape, weights, layers, unit * gate.gate,
                                           by_weight->middleRows<4>(4 * side));
    AddResponse(shape, pair, gate, side, {layers.output, by_input}, jacobian);
  }
}

HeldPairs::HeldPairs(const PairShape& shape, const double* weights)
    : shape_(shape), packed_(shape, BestVectorKernels()) {
  packed_.Start(weights);
}

void HeldPairs::Ask(const SceneForces<double>& forces) {
  gates_.clear();
  first_.clear();
  int columns = 0;
  for (const auto& [n, j] : forces.acting()) {
    gates_.push_back(PairGateJacobian(shape_, forces.pairs().Of(n, j), forces.Parameters(0),
                                      forces.state(n).q, forces.state(j).q));
    first_.push_back(columns);
    if (gates_.back().gate > 0.0) columns += 2;
  }
  inputs_.resize(PairShape::kInputs, columns);
  VectorX<double> u;
  for (size_t k = 0; k < gates_.size(); ++k) {
    if (!(gates_[k].gate > 0.0)) continue;
    const auto& [n, j] = forces.acting()[k];
    for (int side = 0; side < 2; ++side) {
      SetPairInputs<double>(forces.state(side == 0 ? n : j), forces.state(side == 0 ? j : n), &u);
      inputs_.col(first_[k] + side) = u;
    }
  }
  packed_.Forget();
  packed_.Forward(inputs_, &outputs_);
  packed_.Linearize(&by_input_);
}

void HeldPairs::AddTo(size_t k, const SceneForces<double>& forces, PairJacobian* jacobian) const {
  if (!(gates_[k].gate > 0.0)) return;
  const auto& [n, j] = forces.acting()[k];
  const Pair pair = forces.pairs().Of(n, j);
  for (int side = 0; side < 2; ++side) {
    const int column = first_[k] + side;
    AddResponse(shape_, pair, gates_[k], side,
                {outputs_.col(column), by_input_.middleCols<4>(4 * column).transpose()}, jacobian);
  }
}

}  // namespace pushid
