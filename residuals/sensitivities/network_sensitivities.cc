// residuals: the chain rule through one step of an MLP, a GRU or an LSTM.
#include "residuals/sensitivities/network_sensitivities.h"

#include "residuals/packed/packed_matrix.h"

namespace pushid {
namespace {

using Eigen::VectorXd;

// d tanh and d logistic, from the activations.
VectorXd TanhSlope(const VectorXd& a) { return 1.0 - a.array().square(); }
VectorXd LogisticSlope(const VectorXd& a) { return a.array() * (1.0 - a.array()); }

}  // namespace

NetworkSensitivities::NetworkSensitivities(const NetworkShape& shape, const double* weights,
                                           double mass, int num_columns, int weight_column)
    : shape_(shape),
      weights_(shape, weights),
      scale_(shape.ForceUnit(mass)),
      weight_column_(weight_column),
      embedding_(shape.embedding, num_columns),
      now_(shape.hidden, num_columns),
      next_(Columns::Zero(shape.hidden, num_columns)),
      cell_(Columns::Zero(shape.cells(), num_columns)),
      hidden_(VectorXd::Zero(shape.hidden)) {}

template <typename Rows>
void NetworkSensitivities::AddOwn(int first, int width, int offset, const VectorXd& gain,
                                  const VectorXd& multiplied, Rows rows) const {
  if (weight_column_ < 0) return;
  for (int row = 0; row < rows.rows(); ++row) {
    const int column = weight_column_ + first + row * width + offset;
    rows.row(row).segment(column, multiplied.size()) += gain[row] * multiplied.transpose();
  }
}

template <typename Rows>
void NetworkSensitivities::AddOwnGates(const NetworkState<double>& state, int block,
                                       const VectorXd& gain, Rows rows) const {
  const int width = shape_.gate_width();
  const int first = shape_.gates_at() + block * shape_.hidden * width;
  AddOwn(first, width, 0, gain, state.features, rows);
  if (shape_.recurrent())
    AddOwn(first, width, shape_.num_features(), gain, state.hidden_before, rows);
  AddOwn(first, width, shape_.candidate_width(), gain, shape_.GateContext(state.context), rows);
}

void NetworkSensitivities::AdvanceEmbedding(const NetworkState<double>& state,
                                            const States& by_state) {
  const VectorXd slope = shape_.biased() ? VectorXd((state.features.array() > 0.0).cast<double>())
                                         : TanhSlope(state.features);
  const Columns embed = slope.asDiagonal() * weights_.embed.leftCols(kMotionInputs) *
                        MotionInputScales().asDiagonal();
  SetNarrowProduct(embed, by_state.middleRows<kMotionInputs>(2), embedding_);
  auto rows = embedding_.topRows(shape_.embedding);
  const int width = shape_.embed_width();
  AddOwn(0, width, 0, slope, state.inputs, rows);
  if (shape_.biased()) AddOwn(0, width, kMotionInputs, slope, state.context, rows);
}

void NetworkSensitivities::Carry(const Columns& step, const States& by_state, bool add,
                                 Columns* rows) const {
  if (shape_.embedding > 0) {
    NarrowProduct(step.leftCols(shape_.embedding), embedding_, add, *rows);
  } else {
    const Columns motion = step.leftCols(kMotionInputs) * MotionInputScales().asDiagonal();
    NarrowProduct(motion, by_state.middleRows<kMotionInputs>(2), add, *rows);
  }
  if (shape_.recurrent()) AddNarrowProduct(step.rightCols(shape_.hidden), now_, *rows);
}

void NetworkSensitivities::AdvanceMlp(const NetworkState<double>& state, const States& by_state) {
  const VectorXd slope = TanhSlope(state.gates);
  const int nf = shape_.num_features();
  const Columns step = slope.asDiagonal() * weights_.gates;
  Carry(step, by_state, false, &next_);
  auto rows = next_.topRows(shape_.hidden);
  const int first = shape_.gates_at(), width = shape_.gate_width();
  AddOwn(first, width, 0, slope, state.features, rows);
  // The slopes' difference, tanh' (W x + C k) - tanh' (C k), without what cancels.
  AddOwn(first, width, nf, -state.hidden.cwiseProduct(state.gates + state.rest), state.context,
         rows);
}

void NetworkSensitivities::AdvanceGru(const NetworkState<double>& state, const States& by_state) {
  const int nf = shape_.num_features(), h = shape_.hidden;
  const VectorXd slope = LogisticSlope(state.gates);
  const VectorXd keep = state.gates.head(h), recall = state.gates.tail(h);
  // How far the sums of n, r and z move h'.
  const VectorXd by_n = (1.0 - keep.array()).matrix().cwiseProduct(TanhSlope(state.candidates));
  const VectorXd by_r = by_n.cwiseProduct(state.recurrent).cwiseProduct(slope.tail(h));
  const VectorXd by_z = (state.hidden_before - state.candidates).cwiseProduct(slope.head(h));
  Columns step = by_z.asDiagonal() * weights_.gates.topRows(h);
  step += by_r.asDiagonal() * weights_.gates.bottomRows(h);
  step.leftCols(nf) += by_n.asDiagonal() * weights_.candidates.leftCols(nf);
  step.rightCols(h) += by_n.cwiseProduct(recall).asDiagonal() * weights_.candidates.rightCols(h);
  step.rightCols(h).diagonal() += keep;
  Carry(step, by_state, false, &next_);
  AddOwnGates(state, 0, by_z, next_.topRows(h));
  AddOwnGates(state, 1, by_r, next_.topRows(h));
  const int first = shape_.candidates_at(), width = shape_.candidate_width();
  AddOwn(first, width, 0, by_n, state.features, next_.topRows(h));
  AddOwn(first, width, nf, by_n.cwiseProduct(recall), state.hidden_before, next_.topRows(h));
}

void NetworkSensitivities::AdvanceLstm(const NetworkState<double>& state, const States& by_state) {
  const int nf = shape_.num_features(), h = shape_.hidden;
  const VectorXd slope = LogisticSlope(state.gates.head(3 * h));
  const VectorXd input = state.gates.head(h), output = state.gates.segment(2 * h, h);
  const auto by_features =
      shape_.biased() ? weights_.gates.bottomRows(h) : weights_.candidates.topRows(h);
  // How far the sums of i, f and g move c', and that of o moves h'.
  const VectorXd by_i = state.candidates.cwiseProduct(slope.head(h));
  const VectorXd by_f = state.cell_before.cwiseProduct(slope.segment(h, h));
  const VectorXd by_g = input.cwiseProduct(TanhSlope(state.candidates));
  const VectorXd by_o = state.cell_tanh.cwiseProduct(slope.tail(h));
  Columns step = by_i.asDiagonal() * weights_.gates.topRows(h);
  step += by_f.asDiagonal() * weights_.gates.middleRows(h, h);
  step += by_g.asDiagonal() * by_features;
  cell_ = state.gates.segment(h, h).asDiagonal() * cell_;
  Carry(step, by_state, true, &cell_);
  AddOwnGates(state, 0, by_i, cell_.topRows(h));
  AddOwnGates(state, 1, by_f, cell_.topRows(h));
  if (shape_.biased()) {
    AddOwnGates(state, 3, by_g, cell_.topRows(h));
  } else {
    const int first = shape_.candidates_at(), width = shape_.candidate_width();
    AddOwn(first, width, 0, by_g, state.features, cell_.topRows(h));
    AddOwn(first, width, nf, by_g, state.hidden_before, cell_.topRows(h));
  }

  step = by_o.asDiagonal() * weights_.gates.middleRows(2 * h, h);
  Carry(step, by_state, false, &next_);
  next_ += output.cwiseProduct(TanhSlope(state.cell_tanh)).asDiagonal() * cell_;
  AddOwnGates(state, 2, by_o, next_.topRows(h));
}

void NetworkSensitivities::AdvanceLdp(const NetworkState<double>& state, const States& by_state) {
  AdvanceLstm(state, by_state);
}

void NetworkSensitivities::Advance(const NetworkState<double>& state, const States& by_state) {
  if (shape_.embedding > 0) AdvanceEmbedding(state, by_state);
  now_.swap(next_);
  switch (shape_.kind) {
    case NetworkKind::kNone:
      return;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  case NetworkKind::id:                                                \
    Advance##Kind(state, by_state);                                    \
    break;
      PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
  }
  hidden_ = state.hidden;
}

void NetworkSensitivities::AddTo(ForceColumns* by_column) const {
  const Columns output = scale_ * weights_.output.leftCols(shape_.hidden);
  AddNarrowProduct(output, next_, *by_column);
  AddOwn(shape_.output_at(), shape_.output_width(), 0, VectorXd::Constant(4, scale_), Output(),
         by_column->topRows(4));
}

VectorXd NetworkSensitivities::Output() const {
  VectorXd output = VectorXd::Ones(shape_.output_width());
  output.head(shape_.hidden) = hidden_;
  return output;
}

void NetworkSensitivities::AddTo(const Eigen::RowVector4d& by_force,
                                 Eigen::RowVectorXd* by_column) const {
  const Eigen::RowVectorXd by_hidden =
      (scale_ * by_force) * weights_.output.leftCols(shape_.hidden);
  by_column->noalias() += by_hidden * next_;
  const int width = shape_.output_width();
  for (int row = 0; row < 4; ++row) {
    AddOwn(shape_.output_at() + row * width, width, 0,
           VectorXd::Constant(1, scale_ * by_force[row]), Output(), by_column->topRows(1));
  }
}

RodSensitivities::RodSensitivities(const LearnedTerms& network, const double* weights,
                                   int num_columns, int weight_column)
    : shape_(network.rod),
      weights_(weights + network.rod_at()),
      weight_column_(weight_column < 0 ? -1 : weight_column + network.rod_at()),
      own_(weight_column < 0 ? 0 : shape_.num_weights()),
      velocity_(num_columns) {}

const Eigen::RowVectorXd& RodSensitivities::Velocity(const RodStep& step, const States& by_state,
                                                     const States& before, const Row& rod) {
  static const auto kScales = MotionInputScales();
  const bool fitted = weight_column_ >= 0;
  const RodInputGradient by_input =
      RodVelocityGradient(shape_, weights_, step.layers, fitted ? own_.data() : nullptr);
  const Eigen::RowVector4d by_force =
      by_input.segment<4>(RodShape::kForceInputs) / (kNetworkAcceleration * step.mass);
  Eigen::Matrix<double, 1, 8> along = by_force * step.self.by_state;
  along.tail<kMotionInputs>() += by_input.head<kMotionInputs>() * kScales.asDiagonal();
  velocity_.noalias() = along * by_state;
  velocity_ += (by_input[RodShape::kRodInput] / kNetworkRod) * rod;
  if (!step.self.by_previous.isZero(0.0)) {
    const Eigen::RowVector2d back = by_force.head<2>() * step.self.by_previous.asDiagonal();
    velocity_.noalias() += back * before.middleRows<2>(4);
  }
  for (const ColumnEntry& entry : step.parameters) {
    velocity_[entry.column] +=
        entry.derivative * by_force.dot(step.self.by_parameter.col(entry.parameter));
  }
  if (step.network != nullptr) step.network->AddTo(by_force, &velocity_);
  if (fitted) velocity_.segment(weight_column_, own_.size()) += own_;
  return velocity_;
}

}  // namespace pushid
