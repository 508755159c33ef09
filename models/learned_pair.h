// models: what people do to each other, learned: a small network beside contact, fitted with
// everything else.
//
//   u = [dx/0.4, dy/0.4, dxd/0.8, dyd/0.8, th_n/0.15, th_j/0.15, ph_n/0.15, ph_j/0.15,
//        dthd/0.6, dphd/0.6]                     carts, n minus j: LDP's ten inputs
//   h_1 = tanh(W_1 u + b_1), h_i = tanh(W_i h_(i-1) + b_i)
//   F on n = 2 M_n g (O h_last + c),             g = x / (x + w)
//
// x: the load of contact, w its onset (contact.h), so that people who do not touch do nothing to
// each other, whatever the weights, and O = c = 0 is no force at all. Each of the two asks the same
// network alone: the force is not mutual, and no matter who is numbered first. Source: LDP's
// interaction network (Yue et al., CVPR 2024: 10-512-512-4, given by file in
// network_interaction.h), with that gate added.
//
// Weights are one flat array: for each layer the rows [W b], then the rows [O c].
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "models/contact.h"
#include "models/network_inputs.h"

namespace pushid {

inline constexpr double kPairDistance = 0.4;  // m

struct PairShape {
  std::vector<int> hidden = {};  // units of each layer; empty: nothing is learned

  static constexpr int kInputs = 10;
  bool any() const { return !hidden.empty(); }
  int num_weights() const;
};

// "network:4", "network:32-16".
std::string PairName(const PairShape& shape);

// The values on the way from the inputs to the output.
template <typename T>
struct PairLayers {
  std::vector<VectorX<T>> values;  // u, then the hidden layers
  Vector4<T> output;               // O h + c
};

template <typename T>
void SetPairInputs(const PendulumState<T>& n, const PendulumState<T>& j, VectorX<T>* u) {
  u->resize(PairShape::kInputs);
  *u << (n.q[0] - j.q[0]) / kPairDistance, (n.q[1] - j.q[1]) / kPairDistance,
      (n.qd[0] - j.qd[0]) / kNetworkSpeed, (n.qd[1] - j.qd[1]) / kNetworkSpeed,
      n.q[2] / kNetworkAngle, j.q[2] / kNetworkAngle, n.q[3] / kNetworkAngle,
      j.q[3] / kNetworkAngle, (n.qd[2] - j.qd[2]) / kNetworkRate,
      (n.qd[3] - j.qd[3]) / kNetworkRate;
}

// A layer's [W b] in the flat array.
template <typename T>
ConstRows<T> PairLayer(const T* weights, int rows, int inputs) {
  return {weights, rows, inputs + 1, Eigen::OuterStride<>(inputs + 1)};
}

// What n gets from j before gate and mass; layers keeps the way there.
template <typename T>
void RunPairNetwork(const PairShape& shape, const T* weights, const PendulumState<T>& n,
                    const PendulumState<T>& j, PairLayers<T>* layers) {
  layers->values.resize(shape.hidden.size() + 1);
  SetPairInputs(n, j, &layers->values[0]);
  int inputs = PairShape::kInputs;
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    const ConstRows<T> layer = PairLayer(weights, shape.hidden[i], inputs);
    const VectorX<T> sum = layer.leftCols(inputs) * layers->values[i] + layer.col(inputs);
    layers->values[i + 1] = sum.unaryExpr([](const T& a) {
      using std::tanh;
      return tanh(a);
    });
    weights += layer.size();
    inputs = shape.hidden[i];
  }
  const ConstRows<T> last = PairLayer(weights, 4, inputs);
  layers->output = last.leftCols(inputs) * layers->values.back() + last.col(inputs);
}

// The gate g of two people; zero where neither loads the other.
template <typename T>
T PairGate(const Pair& pair, const ParameterSet<T>& p, const Vector4<T>& q_n,
           const Vector4<T>& q_j) {
  const T load = LoadBetween(pair, p, q_n, q_j);
  return RealPart(load) > 0.0 ? T(load / (load + kContactOnset)) : T(0.0);
}

template <typename T>
void AddLearnedPair(const PairShape& shape, const T* weights, const Pair& pair,
                    const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    PairForce<T>* force) {
  const T gate = PairGate<T>(pair, p, n.q, j.q);
  if (!(RealPart(gate) > 0.0)) return;
  PairLayers<T> layers;
  RunPairNetwork(shape, weights, n, j, &layers);
  force->on_n += (kNetworkAcceleration * pair.body_n.mass * gate) * layers.output;
  RunPairNetwork(shape, weights, j, n, &layers);
  force->on_j += (kNetworkAcceleration * pair.body_j.mass * gate) * layers.output;
  force->acts = true;
}

}  // namespace pushid
