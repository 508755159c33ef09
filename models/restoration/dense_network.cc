// models: forward through dense layers.
#include "models/restoration/dense_network.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace pushid {

// The product is computed in tiles of 16 rows and 6 columns, whose sums stay in registers.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
namespace {

constexpr int kRows = 16, kColumns = 6;
typedef float Vector __attribute__((vector_size(kRows * sizeof(float))));

// The tiles of some rows of a product, whose columns are `stride` apart:
//
//   to(i, j) = sum over k of left[kRows * k + i] right(k, j), i < rows, j < columns
//
// right by columns, `depth` long.
#define PUSHID_TILES_OF(name, isa)                                                            \
  __attribute__((target(isa))) void name(Eigen::Index depth, const float* left,               \
                                         const float* right, Eigen::Index columns,            \
                                         Eigen::Index rows, Eigen::Index stride, float* to) { \
    for (Eigen::Index first = 0; first < columns; first += kColumns) {                        \
      const float* column[kColumns];                                                          \
      for (Eigen::Index j = 0; j < kColumns; ++j) {                                           \
        column[j] = right + depth * std::min(first + j, columns - 1);                         \
      }                                                                                       \
      Vector sums[kColumns] = {};                                                             \
      for (Eigen::Index k = 0; k < depth; ++k) {                                              \
        Vector of_left;                                                                       \
        std::memcpy(&of_left, left + kRows * k, sizeof(of_left));                             \
        _Pragma("GCC unroll 6") for (int j = 0; j < kColumns; ++j) {                          \
          sums[j] += of_left * column[j][k];                                                  \
        }                                                                                     \
      }                                                                                       \
      const Eigen::Index count = std::min<Eigen::Index>(kColumns, columns - first);           \
      for (Eigen::Index j = 0; j < count; ++j) {                                              \
        float* const column_of = to + stride * (first + j);                                   \
        if (rows == kRows) {                                                                  \
          std::memcpy(column_of, &sums[j], sizeof(Vector));                                   \
        } else {                                                                              \
          std::memcpy(column_of, &sums[j], static_cast<size_t>(rows) * sizeof(float));        \
        }                                                                                     \
      }                                                                                       \
    }                                                                                         \
  }
PUSHID_TILES_OF(Tiles512, "avx512f")
PUSHID_TILES_OF(Tiles256, "avx2,fma")
#undef PUSHID_TILES_OF

using Tiles = decltype(&Tiles256);

Tiles Widest() {
  if (__builtin_cpu_supports("avx512f")) return Tiles512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Tiles256;
  return nullptr;
}

}  // namespace

Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  static const Tiles tiles = Widest();
  const Eigen::Index depth = a.cols(), columns = b.cols();
  if (tiles == nullptr || columns < kColumns) return a * b;
  Eigen::MatrixXf product(a.rows(), columns);
  Eigen::MatrixXf left = Eigen::MatrixXf::Zero(kRows, depth);
  for (Eigen::Index row = 0; row < a.rows(); row += kRows) {
    const Eigen::Index count = std::min<Eigen::Index>(kRows, a.rows() - row);
    left.topRows(count) = a.middleRows(row, count);
    tiles(depth, left.data(), b.data(), columns, count, a.rows(), &product(row, 0));
  }
  return product;
}

#else

Eigen::MatrixXf FloatProduct(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) { return a * b; }

#endif

Eigen::MatrixXf Applied(const DenseLayer& layer, const Eigen::MatrixXf& values) {
  Eigen::MatrixXf result = FloatProduct(layer.weights, values);
  result.colwise() += layer.bias;
  return result;
}

void ApplyElu(Eigen::MatrixXf* values) {
  auto v = values->array();
  // There is no branch, so exp is vectorized.
  v = v.max(0.0f) + v.min(0.0f).exp() - 1.0f;
}

Eigen::MatrixXf DenseNetwork::Evaluate(const Eigen::MatrixXf& inputs) const {
  Eigen::MatrixXf value = inputs;
  for (size_t i = 0; i < layers.size(); ++i) {
    value = Applied(layers[i], value);
    if (i + 1 < layers.size()) ApplyElu(&value);
  }
  return value;
}

Eigen::MatrixXf Scaling::Scaled(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf scaled = values.colwise() - mean;
  scaled.array().colwise() /= spread.array();
  return scaled.cwiseMax(-kLargestScaled).cwiseMin(kLargestScaled);
}

Eigen::MatrixXf Scaling::Unscaled(const Eigen::MatrixXf& values) const {
  Eigen::MatrixXf raw = values.array().colwise() * spread.array();
  raw.colwise() += mean;
  return raw;
}

Scaling ScalingOf(const Eigen::MatrixXf& values, float smallest) {
  Scaling scaling;
  const Eigen::MatrixXd wide = values.cast<double>();
  const Eigen::VectorXd mean = wide.rowwise().mean();
  const Eigen::VectorXd variance =
      (wide.colwise() - mean).rowwise().squaredNorm() / std::max<double>(1.0, wide.cols() - 1.0);
  scaling.mean = mean.cast<float>();
  scaling.spread = variance.cwiseSqrt().cast<float>().cwiseMax(smallest);
  return scaling;
}

Eigen::MatrixXf TensorFields::Take(const std::string& name, int rows, int columns) {
  const Eigen::MatrixXf nothing = Eigen::MatrixXf::Zero(std::max(rows, 1), std::max(columns, 1));
  for (const NamedTensor& tensor : *read_) {
    if (tensor.name != name) continue;
    const Eigen::MatrixXf& values = tensor.values;
    if ((rows >= 0 && values.rows() != rows) || (columns >= 0 && values.cols() != columns)) {
      Fail("the tensor " + name + " is " + std::to_string(values.rows()) + " x " +
           std::to_string(values.cols()) + ", not " + std::to_string(rows) + " x " +
           std::to_string(columns));
      return nothing;
    }
    if (!values.allFinite()) Fail("the tensor " + name + " has entries that are not numbers");
    return values;
  }
  Fail("the tensor " + name + " is missing");
  return nothing;
}

void TensorFields::Layer(const std::string& name, int inputs, int outputs, DenseLayer* layer) {
  Matrix(name + ".weights", outputs, inputs, &layer->weights);
  Matrix(name + ".bias", static_cast<int>(layer->weights.rows()), 1, &layer->bias);
}

void TensorFields::Network(const std::string& name, int layers, int inputs, int outputs,
                           DenseNetwork* network) {
  network->layers.resize(layers);
  int width = inputs;
  for (int i = 0; i < layers; ++i) {
    DenseLayer& layer = network->layers[i];
    Layer(name + "." + std::to_string(i), width, i + 1 == layers ? outputs : -1, &layer);
    width = static_cast<int>(layer.weights.rows());
  }
}

void TensorFields::Scales(const std::string& name, int rows, Scaling* scaling) {
  Matrix(name + ".mean", rows, 1, &scaling->mean);
  Positive(name + ".spread", rows, &scaling->spread);
}

}  // namespace pushid
