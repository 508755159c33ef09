// residuals: the chain rule through one step of an MLP, a GRU or an LSTM.
#include "residuals/network_sensitivities.h"

namespace pushid {
namespace {

// d tanh and d logistic, from the activations.
Eigen::VectorXd TanhSlope(const Eigen::VectorXd& a) { return 1.0 - a.array().square(); }
Eigen::VectorXd LogisticSlope(const Eigen::VectorXd& a) { return a.array() * (1.0 - a.array()); }

}  // namespace

NetworkSensitivities::NetworkSensitivities(const NetworkShape& shape, const double* weights,
                                           double mass, int num_columns, int weight_column)
    : shape_(shape),
      weights_(shape, weights),
      scale_(kNetworkAcceleration * mass),
      weight_column_(weight_column),
      z_(Columns::Zero(shape.num_features() + shape.hidden, num_columns)),
      gates_(shape.gate_rows(), num_columns),
      candidates_(shape.candidate_rows(), num_columns),
      output_(Columns::Zero(4, num_columns)) {
  if (shape.kind == NetworkKind::kLstm) cell_ = Columns::Zero(shape.hidden, num_columns);
}

void NetworkSensitivities::AddOwn(int first, int width, int offset,
                                  const Eigen::VectorXd& multiplied, Columns* rows) const {
  if (weight_column_ < 0) return;
  for (int row = 0; row < rows->rows(); ++row) {
    rows->row(row).segment(weight_column_ + first + row * width + offset, multiplied.size()) +=
        multiplied.transpose();
  }
}

void NetworkSensitivities::AdvanceFeatures(const NetworkState<double>& state,
                                           const States& by_state, const Row& rod) {
  static const auto kScales = MotionInputScales();
  const bool sees_rod = shape_.rod_input && rod.size() > 0;
  if (shape_.embedding == 0) {
    z_.topRows(6).noalias() = kScales.asDiagonal() * by_state.middleRows<6>(2);
    if (sees_rod) z_.row(6) = rod / kNetworkRod;
    return;
  }
  Columns features = weights_.embed.leftCols(6) * kScales.asDiagonal() * by_state.middleRows<6>(2);
  if (sees_rod) features.noalias() += (weights_.embed.col(6) / kNetworkRod) * rod;
  AddOwn(0, shape_.num_inputs(), 0, state.inputs, &features);
  z_.topRows(shape_.num_features()) = TanhSlope(state.features).asDiagonal() * features;
}

void NetworkSensitivities::SumGates(const NetworkState<double>& state) {
  const int nf = shape_.num_features(), width = shape_.gate_width();
  const int used = shape_.candidate_width();  // an MLP does not see its own past
  gates_.noalias() = weights_.gates * z_.topRows(used);
  AddOwn(shape_.gates_at(), width, 0, state.features, &gates_);
  if (used > nf) AddOwn(shape_.gates_at(), width, nf, state.hidden_before, &gates_);
  AddOwn(shape_.gates_at(), width, used, state.context, &gates_);
}

void NetworkSensitivities::AdvanceMlp(const NetworkState<double>& state) {
  SumGates(state);
  auto hidden = z_.bottomRows(shape_.hidden);
  hidden.noalias() = TanhSlope(state.gates).asDiagonal() * gates_;
  gates_.setZero();
  AddOwn(shape_.gates_at(), shape_.gate_width(), shape_.num_features(), state.context, &gates_);
  hidden -= TanhSlope(state.rest).asDiagonal() * gates_;
}

void NetworkSensitivities::AdvanceGru(const NetworkState<double>& state) {
  const int nf = shape_.num_features(), h = shape_.hidden;
  SumGates(state);
  gates_ = LogisticSlope(state.gates).asDiagonal() * gates_;
  auto hidden = z_.bottomRows(h);
  const auto forget = state.gates.tail(h);
  recurrent_.noalias() = weights_.candidates.rightCols(h) * hidden;
  AddOwn(shape_.candidates_at(), shape_.candidate_width(), nf, state.hidden_before, &recurrent_);
  candidates_.noalias() = weights_.candidates.leftCols(nf) * z_.topRows(nf);
  AddOwn(shape_.candidates_at(), shape_.candidate_width(), 0, state.features, &candidates_);
  candidates_ += forget.asDiagonal() * recurrent_;
  candidates_ += state.recurrent.asDiagonal() * gates_.bottomRows(h);
  candidates_ = TanhSlope(state.candidates).asDiagonal() * candidates_;
  const auto keep = state.gates.head(h);
  hidden = keep.asDiagonal() * (hidden - candidates_) + candidates_;
  hidden += (state.hidden_before - state.candidates).asDiagonal() * gates_.topRows(h);
}

void NetworkSensitivities::AdvanceLstm(const NetworkState<double>& state) {
  const int nf = shape_.num_features(), h = shape_.hidden;
  SumGates(state);
  gates_ = LogisticSlope(state.gates).asDiagonal() * gates_;
  candidates_.noalias() = weights_.candidates * z_;
  AddOwn(shape_.candidates_at(), shape_.candidate_width(), 0, state.features, &candidates_);
  AddOwn(shape_.candidates_at(), shape_.candidate_width(), nf, state.hidden_before, &candidates_);
  candidates_ = TanhSlope(state.candidates).asDiagonal() * candidates_;
  cell_ = state.gates.segment(h, h).asDiagonal() * cell_;
  cell_ += state.cell_before.asDiagonal() * gates_.middleRows(h, h);
  cell_ += state.gates.head(h).asDiagonal() * candidates_;
  cell_ += state.candidates.asDiagonal() * gates_.topRows(h);
  const Eigen::VectorXd through = state.gates.tail(h).cwiseProduct(TanhSlope(state.cell_tanh));
  z_.bottomRows(h) = through.asDiagonal() * cell_;
  z_.bottomRows(h) += state.cell_tanh.asDiagonal() * gates_.bottomRows(h);
}

void NetworkSensitivities::Advance(const NetworkState<double>& state, const States& by_state,
                                   const Row& rod) {
  AdvanceFeatures(state, by_state, rod);
  switch (shape_.kind) {
    case NetworkKind::kNone:
      return;
    case NetworkKind::kMlp:
      AdvanceMlp(state);
      break;
    case NetworkKind::kGru:
      AdvanceGru(state);
      break;
    case NetworkKind::kLstm:
      AdvanceLstm(state);
      break;
  }
  output_.noalias() = weights_.output * z_.bottomRows(shape_.hidden);
  AddOwn(shape_.output_at(), shape_.hidden, 0, state.hidden, &output_);
}

void NetworkSensitivities::AddTo(Eigen::Matrix<double, 4, Eigen::Dynamic>* by_column) const {
  *by_column += scale_ * output_;
}

void NetworkSensitivities::AddTo(const Eigen::RowVector4d& by_force,
                                 Eigen::RowVectorXd* by_column) const {
  by_column->noalias() += (scale_ * by_force) * output_;
}

}  // namespace pushid
