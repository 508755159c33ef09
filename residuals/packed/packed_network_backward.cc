// residuals: packed self-force networks, backwards.
#include "residuals/packed/packed_network.h"

namespace pushid {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <typename A>
auto TanhSlopes(const A& a) {
  return 1.0 - a * a;
}
template <typename A>
auto LogisticSlopes(const A& a) {
  return a * (1.0 - a);
}

}  // namespace

void PackedNetwork::DeactivateMlp(int step, int column, const Columns& adjoint) {
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  // tanh' less tanh' at rest, without the difference of what is nearly the same.
  context_sum_.col(column).array() -=
      hidden * At(hidden_, step).col(column).array() * (a + rest_.col(column).array());
  a = hidden * TanhSlopes(a);
}

void PackedNetwork::DeactivateGru(int step, int column, const Columns& adjoint) {
  const int h = shape_.hidden;
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  auto keep = a.head(h), reset = a.segment(h, h), candidate = a.segment(2 * h, h);
  auto recurrent = a.tail(h);
  const auto before = At(z_, step).col(column).segment(shape_.num_features(), h).array();
  hidden_carry_.col(column).array() = hidden * keep;
  const Eigen::ArrayXd by_keep = hidden * (before - candidate) * LogisticSlopes(keep);
  candidate = hidden * (1.0 - keep) * TanhSlopes(candidate);
  keep = by_keep;
  const Eigen::ArrayXd by_recurrent = candidate * reset;
  reset = candidate * recurrent * LogisticSlopes(reset);
  recurrent = by_recurrent;
}

void PackedNetwork::DeactivateLstm(int step, int column, const Columns& adjoint) {
  const int h = shape_.hidden;
  const auto hidden = adjoint.col(column).array();
  auto a = At(activations_, step).col(column).array();
  auto input = a.head(h), forget = a.segment(h, h), output = a.segment(2 * h, h);
  auto candidate = a.tail(h);
  auto carry = cell_carry_.col(column).array();
  const auto squashed = At(cell_tanh_, step).col(column).array();
  const Eigen::ArrayXd cell = carry + hidden * output * TanhSlopes(squashed);
  output = hidden * squashed * LogisticSlopes(output);
  carry = cell * forget;
  if (step > 0) {
    forget = cell * At(cells_, step - 1).col(column).array() * LogisticSlopes(forget);
  } else {
    forget = 0.0;
  }
  const Eigen::ArrayXd by_input = cell * candidate * LogisticSlopes(input);
  candidate = cell * input * TanhSlopes(candidate);
  input = by_input;
}

void PackedNetwork::DeactivateLdp(int step, int column, const Columns& adjoint) {
  DeactivateLstm(step, column, adjoint);
}

void PackedNetwork::Deactivate(int step, const Columns& hidden) {
  for (int column = 0; column < columns_.active(step); ++column) {
    switch (shape_.kind) {
      case NetworkKind::kNone:
        break;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  case NetworkKind::id:                                                \
    Deactivate##Kind(step, column, hidden);                            \
    break;
        PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
    }
  }
}

void PackedNetwork::Backward(int step, const Columns& forces, Columns* inputs) {
  const int n = columns_.active(step), h = shape_.hidden, nf = shape_.num_features();
  auto outputs = At(outputs_, step);
  outputs = forces * scale_.head(n).asDiagonal();
  Columns hidden = Weights().output.leftCols(h).transpose() * outputs;
  // Columns that end here have none from later.
  if (shape_.recurrent()) hidden += hidden_carry_.leftCols(n);
  hidden_carry_.leftCols(n).setZero();
  Deactivate(step, hidden);

  auto sums = At(activations_, step);
  Columns z = Columns::Zero(shape_.gate_width(), n);
  right_.Pack(sums.data(), n, rows_, rows_, 1);
  AddProduct(transposed_, right_, z.data(), z.rows());
  if (shape_.recurrent()) hidden_carry_.leftCols(n) += z.middleRows(nf, h);
  if (shape_.embedding == 0) {
    *inputs = z.topRows(nf);
    return;
  }
  auto embedded = At(embedded_, step);
  const auto features = At(z_, step).topRows(nf).array();
  if (shape_.biased()) {
    embedded = z.topRows(nf).array() * (features > 0.0).cast<double>();
  } else {
    embedded = z.topRows(nf).array() * TanhSlopes(features);
  }
  *inputs = Weights().embed.leftCols(kMotionInputs).transpose() * embedded;
}

void PackedNetwork::AddWeightGradient(double* gradient) {
  const int h = shape_.hidden, width = shape_.gate_width();
  const int total = columns_.total(), gate_rows = shape_.gate_rows();
  PackedMatrix left(kernels_, PackedMatrix::kLeft);
  left.Pack(z_.data(), width, total, 1, width);
  right_.Pack(activations_.data(), rows_, total, 1, rows_);
  RowMajor stacked = RowMajor::Zero(rows_, width);
  AddProduct(left, right_, stacked.data(), width);
  if (!shape_.recurrent()) {
    stacked.rightCols<2>() = context_sum_ * context_.transpose();
  }
  Eigen::Map<RowMajor>(gradient + shape_.gates_at(), gate_rows, width) +=
      stacked.topRows(gate_rows);
  Eigen::Map<RowMajor> candidates(gradient + shape_.candidates_at(), shape_.candidate_rows(),
                                  shape_.candidate_width());
  ForCandidates(shape_, [&](int row, int first, int columns) {
    candidates.middleCols(first, columns) += stacked.block(row, first, h, columns);
  });
  Eigen::Map<RowMajor> embed(gradient, shape_.embedding, shape_.embed_width());
  embed.leftCols(kMotionInputs) += embedded_ * inputs_.transpose();
  Eigen::Map<RowMajor> output(gradient + shape_.output_at(), 4, shape_.output_width());
  output.leftCols(h) += outputs_ * hidden_.transpose();
  if (!shape_.biased()) return;
  output.col(h) += outputs_.rowwise().sum();
  for (int step = 0; step < columns_.num_steps(); ++step) {
    embed.rightCols(2) += At(embedded_, step) * own_.leftCols(columns_.active(step)).transpose();
  }
}

}  // namespace pushid
