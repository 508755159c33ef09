// models: sizes and names of what is learned, and derivatives of rod laws.
#include "models/learned_terms.h"

namespace pushid {

std::string NetworkName(const NetworkShape& shape) {
  std::string name = NameOf(shape.kind);
  if (!shape.any()) return name;
  name += ":" + std::to_string(shape.hidden);
  if (shape.embedding > 0) name += ":" + std::to_string(shape.embedding);
  return name;
}

int RodShape::num_weights() const {
  if (!moves()) return 0;
  int weights = 0, below = num_inputs();
  for (int rows : hidden) {
    weights += rows * (below + 1);
    below = rows;
  }
  return weights + below + (biased() ? 1 : 0);
}

std::string RodName(const RodShape& shape) {
  std::string name = NameOf(shape.kind);
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    name += (i == 0 ? ":" : "-") + std::to_string(shape.hidden[i]);
  }
  return name;
}

RodInputGradient RodVelocityGradient(const RodShape& shape, const double* weights,
                                     const RodLayers<double>& layers, double* by_weight) {
  const int num_layers = static_cast<int>(shape.hidden.size());
  const auto below = [&](int i) -> const VectorX<double>& {
    return i == 0 ? layers.inputs : layers.hidden[i - 1];
  };
  int at = shape.num_weights();  // of the matrix in hand
  if (shape.biased()) {
    --at;
    if (by_weight != nullptr) by_weight[at] = kRodSpeed;
  }
  const VectorX<double>& top = below(num_layers);
  at -= static_cast<int>(top.size());
  if (by_weight != nullptr) {
    Eigen::Map<VectorX<double>>(by_weight + at, top.size()) = kRodSpeed * top;
  }
  VectorX<double> slope = kRodSpeed * Eigen::Map<const VectorX<double>>(weights + at, top.size());
  for (int i = num_layers - 1; i >= 0; --i) {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const VectorX<double>& x = below(i);
    const int rows = shape.hidden[i], width = static_cast<int>(x.size());
    at -= rows * (width + 1);
    const auto active = layers.active[i].array(), rest = layers.rest[i].array();
    VectorX<double> by_sum = slope.array() * (1.0 - active.square());
    if (shape.biased()) by_sum = slope.array() * (active > 0.0).cast<double>();
    if (by_weight != nullptr) {
      Eigen::Map<Rows> own(by_weight + at, rows, width + 1);
      own.leftCols(width).noalias() = by_sum * x.transpose();
      // tanh' less tanh' at rest, without the difference of near equals.
      own.col(width) = -slope.array() * layers.hidden[i].array() * (active + rest);
      if (shape.biased()) own.col(width) = by_sum;
    }
    const ConstRows<double> w(weights + at, rows, width, Eigen::OuterStride<>(width + 1));
    slope = w.transpose() * by_sum;
  }
  return slope.transpose();
}

int PairShape::num_weights() const {
  if (!any()) return 0;
  int weights = 0, inputs = kInputs;
  for (int size : hidden) {
    weights += size * (inputs + 1);
    inputs = size;
  }
  return weights + 4 * (inputs + 1);
}

std::string PairName(const PairShape& shape) {
  std::string name;
  for (int size : shape.hidden) {
    name += (!name.empty() ? "-" : shape.ldp ? "ldp_network:" : "network:") + std::to_string(size);
  }
  return name;
}

}  // namespace pushid
