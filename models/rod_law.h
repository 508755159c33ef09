// models: the rod's length as a state that a learned law changes from step to step.
//
//   l' = l + dt * 0.1 m/s * f(u)
//   u = [e_theta / 0.15, e_phi / 0.15, xd / 0.8, yd / 0.8, thd / 0.6, phd / 0.6,
//        (F_self - F_rest) / (2 M) (4), (l - l_0) / 0.05]
//   linear  f = w u
//   mlp     h_1 = tanh(W_1 u + b_1) - tanh(b_1),  h_i = tanh(W_i h_{i-1} + b_i) - tanh(b_i),
//           f = o h_n
// F_self: friction, balance, linear and learned self force, whether or not a push hides them for a
// while; F_rest: the torque that holds the posture. A person at rest with the rod of frame 0
// (u = 0) keeps exactly that rod, whatever the weights, and zero weights (of f or of o) are a
// constant rod. Nothing pulls the rod back but the weights on l - l_0: built-in relaxation would
// decide what the data can say. Source: LDP's rod network (Yue et al., CVPR 2024: 256-128-256),
// with that guarantee added.
//
// Weights are one flat array: f's, or for each layer the rows [W b], then o.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "models/enum_names.h"
#include "models/network_inputs.h"

namespace pushid {

enum class RodKind { kConstant, kLinear, kMlp };
constexpr EnumNames<RodKind, 3> Names(RodKind) {
  return {{{"constant", RodKind::kConstant}, {"linear", RodKind::kLinear}, {"mlp", RodKind::kMlp}}};
}

struct RodShape {
  RodKind kind = RodKind::kConstant;
  std::vector<int> hidden = {};  // layers of an MLP, at least one

  static constexpr int kInputs = 11;
  static constexpr int kForceInputs = kMotionInputs;  // where the four of the self force start
  static constexpr int kRodInput = kForceInputs + 4;

  bool moves() const { return kind != RodKind::kConstant; }
  int num_weights() const;
};

// "constant", "linear", "mlp:4", "mlp:256-128-256".
std::string RodName(const RodShape& shape);

inline constexpr double kRodSpeed = 0.1;  // m/s per unit of f
// m: beyond them a rollout has left the model's domain.
inline constexpr double kShortestRod = 0.3, kLongestRod = 1.6;

// The values on the way from the inputs to the output of the last step.
template <typename T>
struct RodLayers {
  VectorX<T> inputs;                     // u
  std::vector<VectorX<T>> active, rest;  // tanh(W x + b), tanh(b)
  std::vector<VectorX<T>> hidden;        // the one less the other

  explicit RodLayers(const RodShape& shape)
      : inputs(VectorX<T>::Zero(RodShape::kInputs)),
        active(shape.hidden.size()),
        rest(shape.hidden.size()),
        hidden(shape.hidden.size()) {}
};

// e: (theta, phi) less the posture; force: F_self - F_rest; rod: l - l_0.
template <typename T>
void SetRodInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd, const Vector4<T>& force,
                  const T& rod, double mass, RodLayers<T>* layers) {
  VectorX<T>& u = layers->inputs;
  SetMotionInputs(e_theta, e_phi, qd, &u);
  for (int i = 0; i < 4; ++i) {
    u[RodShape::kForceInputs + i] = force[i] / (kNetworkAcceleration * mass);
  }
  u[RodShape::kRodInput] = rod / kNetworkRod;
}

// dl/dt in m/s, the inputs set.
template <typename T>
T RodVelocity(const RodShape& shape, const T* weights, RodLayers<T>* layers) {
  using std::tanh;
  const auto squash = [](const T& a) { return tanh(a); };
  const VectorX<T>* below = &layers->inputs;
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    const int rows = shape.hidden[i], width = static_cast<int>(below->size());
    const Eigen::OuterStride<> stride(width + 1);
    const ConstRows<T> w(weights, rows, width, stride), b(weights + width, rows, 1, stride);
    layers->active[i] = (w * *below + b).unaryExpr(squash);
    layers->rest[i] = b.unaryExpr(squash);
    layers->hidden[i] = layers->active[i] - layers->rest[i];
    below = &layers->hidden[i];
    weights += rows * (width + 1);
  }
  return kRodSpeed * Eigen::Map<const VectorX<T>>(weights, below->size()).dot(*below);
}

// Its derivatives by the inputs and, where by_weight is not null, by every weight, as RodVelocity
// left the layers; by hand, from the output back.
using RodInputGradient = Eigen::Matrix<double, 1, RodShape::kInputs>;
RodInputGradient RodVelocityGradient(const RodShape& shape, const double* weights,
                                     const RodLayers<double>& layers, double* by_weight);

}  // namespace pushid
