// residuals: adjoints of a step.
#include "residuals/adjoint/step_adjoint.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

template <typename Jet>
Jet Dot(const Vector4<double>& adjoint, const Vector4<Jet>& of) {
  Jet sum = adjoint[0] * of[0];
  for (int i = 1; i < 4; ++i) sum += adjoint[i] * of[i];
  return sum;
}

// [q, qd] as inputs from `first` on.
template <typename Jet>
PosedPendulum<Jet> Inputs(const PendulumState<double>& state, int first) {
  PendulumState<Jet> inputs;
  for (int i = 0; i < 4; ++i) {
    inputs.q[i] = Jet(state.q[i], first + i);
    inputs.qd[i] = Jet(state.qd[i], first + 4 + i);
  }
  return inputs;
}

}  // namespace

void PersonBack(const PersonStep& s, const Vector4<double>& acceleration,
                const Vector4<double>& by_force, const Vector4<double>* by_effort,
                const std::vector<Parameter>& acting, StateAdjoint* adjoint,
                ParameterSet<double>* by_parameter) {
  using Jet = VectorJet;
  // Inputs: [q, qd], the rod, the cart's velocity before, parameters; a jet's columns at a time.
  constexpr int kRodAt = 8, kBeforeAt = 9, kParametersAt = 11;
  const int columns = kParametersAt + static_cast<int>(acting.size());
  for (int first = 0; first < columns; first += Jet::kColumns) {
    const auto has = [first](int column) {
      return first <= column && column < first + Jet::kColumns;
    };
    const auto input = [&](double value, int column) {
      return has(column) ? Jet::Input(value, column - first) : Jet(value);
    };
    PendulumState<Jet> state;
    Vector4<Jet> before = s.before.cast<Jet>();
    ParameterSet<Jet> p;
    for (int i = 0; i < 4; ++i) {
      state.q[i] = input(s.state.q[i], i);
      state.qd[i] = input(s.state.qd[i], 4 + i);
      if (i < 2) before[i] = input(s.before[i], kBeforeAt + i);
    }
    state.rod = input(s.state.rod, kRodAt);
    for (int i = 0; i < kNumParameters; ++i) p[i] = Jet(s.p[i]);
    for (int column = kParametersAt; column < columns; ++column) {
      const Parameter id = acting[column - kParametersAt];
      p[id] = input(s.p[id], column);
    }
    const Vector4<Jet> force =
        NetForceAt<Jet>(s.scene, s.options, s.self, p, s.person, s.frame, state, before).Total();
    const Vector4<Jet> needed = InverseDynamics<Jet>(BodyNow<Jet>(s.self.body, state.rod), state,
                                                     acceleration.cast<Jet>().eval());
    Jet sum = Dot<Jet>(by_force, force) - Dot<Jet>(by_force, needed);
    if (by_effort != nullptr) sum += Dot<Jet>(*by_effort, s.self.Effort(p, state, before));
    const auto add = [&](int column, double* to) {
      if (has(column)) *to += sum.Slope(column - first);
    };
    for (int i = 0; i < 8; ++i) add(i, &adjoint->state[i]);
    add(kRodAt, &adjoint->rod);
    for (int i = 0; i < 2; ++i) add(kBeforeAt + i, &adjoint->before[i]);
    for (int column = kParametersAt; column < columns; ++column) {
      add(column, &(*by_parameter)[acting[column - kParametersAt]]);
    }
  }
}

PairAdjoint PairBack(const ModelOptions& options, const Pair& pair, const ParameterSet<double>& p,
                     const PendulumState<double>& n, const PendulumState<double>& j,
                     const Vector4<double>& by_n, const Vector4<double>& by_j,
                     const double* by_gate, const Eigen::MatrixXd& by_inputs,
                     ParameterSet<double>* by_parameter) {
  using Jet = ceres::Jet<double, 16 + kNumPairParameters>;
  const PosedPendulum<Jet> a = Inputs<Jet>(n, 0), b = Inputs<Jet>(j, 8);
  ParameterSet<Jet> parameters;
  for (int i = 0; i < kNumPairParameters; ++i) {
    const int id = kFirstPairParameter + i;
    parameters[id] = Jet(p[id], 16 + i);
  }
  const PairForce<Jet> force = InteractionBetween<Jet>(options.interaction, pair, parameters, a, b);
  Jet sum = Dot<Jet>(by_n, force.on_n) + Dot<Jet>(by_j, force.on_j);
  if (by_gate != nullptr) {
    sum += *by_gate * PairGate<Jet>(options.learned->pair, pair, parameters, a.q, b.q);
  }
  for (Eigen::Index k = 0; k < by_inputs.cols(); ++k) {
    const VectorX<Jet> inputs = k == 0 ? PairInputs<Jet>(a, b) : PairInputs<Jet>(b, a);
    for (int i = 0; i < PairShape::kInputs; ++i) sum += by_inputs(i, k) * inputs[i];
  }
  for (int i = 0; i < kNumPairParameters; ++i) {
    (*by_parameter)[kFirstPairParameter + i] += sum.v[16 + i];
  }
  return sum.v.head<16>();
}

void FrameBack(const Body& body, const PendulumState<double>& state, const MeasuredFrame& measured,
               const ResidualSigmas& sigmas, double weight, StateAdjoint* adjoint) {
  constexpr int kRodAt = 8;
  using Jet = ceres::Jet<double, 9>;
  PendulumState<Jet> jets = Inputs<Jet>(state, 0);
  jets.rod = Jet(state.rod, kRodAt);
  const FrameVector<Jet> r = FrameResidual(BodyNow<Jet>(body, jets.rod), jets, measured, sigmas);
  const Jet cost = (0.5 * weight * weight) * r.squaredNorm();
  adjoint->state += cost.v.head<8>();
  adjoint->rod += cost.v[kRodAt];
}

}  // namespace pushid
