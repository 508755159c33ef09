// residuals: the chain rule through gate and layers.
#include "residuals/sensitivities/learned_pair_jacobian.h"

#include <ceres/jet.h>

namespace pushid {
namespace {

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
