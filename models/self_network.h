// models: a network as a part of the self force, in addition to balance and friction; its input is
// the person's own state alone.
//
//   u = [e_theta/0.15, e_phi/0.15, xd/0.8, yd/0.8, thd/0.6, phd/0.6]
//   k = [(M - 85 kg)/20 kg, 1]            what does not change during a rollout
//
//   mlp    h = tanh(W u + C k) - tanh(C k)
//          F = 2 M [O h]                  m/s^2 and m^2/s^2 per unit of output
//
//   ldp    x = max(0, E [u, k])
//          i, f, o = s(W x + U h + b + b'), g = tanh(W_g x + U_g h + b_g + b_g')
//          c' = f c + i g,  h' = o tanh(c'),  F = 2 (85 kg) [O h' + d]
//
// s is the logistic function, products of vectors are by element, memories start at zero. In `mlp`
// the response to k alone is subtracted: at rest (u = 0) the force is exactly zero for any weights,
// and O = 0 is no force at all. `ldp` has no such guarantee: it is the network of Yue et al. (CVPR
// 2024, Eq. 6), with the mass as an input, an embedding of 32, and an LSTM of 256 with two biases
// per gate as in LibTorch: 298,244 weights. Rejected: small GRUs and LSTMs, with which no held-out
// model of the 32 recordings settled (hipADE + 0.10 and + 0.05 m).
//
// Weights are one flat array: E, then the rows [W C] (of ldp [W U b b'], g among them), then O, of
// ldp [O d]; each matrix by rows.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "models/enum_names.h"
#include "models/ipm.h"
#include "models/jet.h"

namespace pushid {

// Inputs of the learned terms of a person, in units of typical ranges, and matrices within a flat
// array of weights.

template <typename T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;
// A matrix in a flat array, row by row with a stride.
template <typename T>
using ConstRows =
    Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
               Eigen::OuterStride<>>;

inline constexpr double kNetworkAngle = 0.15;        // rad
inline constexpr double kNetworkSpeed = 0.8;         // m/s
inline constexpr double kNetworkRate = 0.6;          // rad/s
inline constexpr double kNetworkRod = 0.05;          // m
inline constexpr double kNetworkMass = 20.0;         // kg
inline constexpr double kNetworkAcceleration = 2.0;  // m/s^2 and m^2/s^2, of forces over the mass

inline constexpr int kMotionInputs = 6;

// Sets the first inputs of u: e = (theta, phi) minus the posture, and the velocities.
template <typename T>
void SetMotionInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd, VectorX<T>* u) {
  (*u)[0] = e_theta / kNetworkAngle;
  (*u)[1] = e_phi / kNetworkAngle;
  (*u)[2] = qd[0] / kNetworkSpeed;
  (*u)[3] = qd[1] / kNetworkSpeed;
  (*u)[4] = qd[2] / kNetworkRate;
  (*u)[5] = qd[3] / kNetworkRate;
}

// Derivatives of the motion inputs by [theta, phi, qd].
inline Eigen::Matrix<double, kMotionInputs, 1> MotionInputScales() {
  Eigen::Matrix<double, kMotionInputs, 1> scales;
  scales << kNetworkAngle, kNetworkAngle, kNetworkSpeed, kNetworkSpeed, kNetworkRate, kNetworkRate;
  return scales.cwiseInverse();
}

enum class NetworkKind { kNone, kMlp, kLdp };
constexpr EnumNames<NetworkKind, 3> Names(NetworkKind) {
  return {{{"none", NetworkKind::kNone}, {"mlp", NetworkKind::kMlp}, {"ldp", NetworkKind::kLdp}}};
}

struct NetworkShape {
  NetworkKind kind = NetworkKind::kNone;
  int hidden = 0;
  int embedding = 0;  // of ldp, which always has one

  bool any() const { return kind != NetworkKind::kNone; }
  // True for LDP's network, which has biases, the mass and a memory.
  bool ldp() const { return kind == NetworkKind::kLdp; }
  int cells() const { return ldp() ? hidden : 0; }
  int num_features() const { return ldp() ? embedding : kMotionInputs; }
  int gate_rows() const { return (ldp() ? 4 : 1) * hidden; }
  int gate_inputs() const { return num_features() + cells(); }  // of [x h]
  int gate_width() const { return gate_inputs() + 2; }
  int embed_width() const { return kMotionInputs + 2; }
  int output_width() const { return hidden + (ldp() ? 1 : 0); }
  // Places at which the matrices start in the flat array.
  int gates_at() const { return embedding * embed_width(); }
  int output_at() const { return gates_at() + gate_rows() * gate_width(); }
  int num_weights() const { return any() ? output_at() + 4 * output_width() : 0; }

  // Newtons and newton metres per unit of output.
  double ForceUnit(double mass) const {
    return kNetworkAcceleration * (ldp() ? kReferenceMass : mass);
  }
  // Factors of the gates' last two columns.
  Eigen::Vector2d GateContext(const Eigen::Vector2d& context) const {
    return ldp() ? Eigen::Vector2d::Ones().eval() : context;
  }
};

// The matrices in a flat array.
template <typename T>
struct NetworkWeights {
  ConstRows<T> embed, gates, context, output;

  NetworkWeights(const NetworkShape& s, const T* w)
      : embed(w, s.embedding, s.embed_width(), Stride(s.embed_width())),
        gates(w + s.gates_at(), s.gate_rows(), s.gate_inputs(), Stride(s.gate_width())),
        context(w + s.gates_at() + s.gate_inputs(), s.gate_rows(), 2, Stride(s.gate_width())),
        output(w + s.output_at(), 4, s.output_width(), Stride(s.output_width())) {}

 private:
  static Eigen::OuterStride<> Stride(int width) { return Eigen::OuterStride<>(width); }
};

// k of a person.
inline Eigen::Vector2d NetworkContext(const Body& body) {
  return {(body.mass - kReferenceMass) / kNetworkMass, 1.0};
}

template <typename T>
VectorX<T> Squashed(const VectorX<T>& sum) {
  using std::tanh;
  return sum.unaryExpr([](const T& a) { return tanh(a); });
}
template <typename T>
VectorX<T> Rectified(const VectorX<T>& sum) {
  return sum.unaryExpr([](const T& a) -> T { return RealPart(a) > 0.0 ? a : T(0.0); });
}
template <typename T>
VectorX<T> Logistic(const VectorX<T>& sum) {
  using std::exp;
  return sum.unaryExpr([](const T& a) { return T(1.0) / (T(1.0) + exp(-a)); });
}

// One person's inputs u, the memory of an ldp network, and what does not change during a rollout.
template <typename T>
struct NetworkState {
  VectorX<T> inputs, hidden, cell;
  VectorX<T> context;   // what the gates see of k
  VectorX<T> rest;      // mlp: tanh(C k)
  Eigen::Vector2d own;  // k
  double force_unit;    // newtons and newton metres per unit of output

  NetworkState(const NetworkShape& shape, const T* weights, const Body& body)
      : inputs(VectorX<T>::Zero(kMotionInputs)),
        hidden(VectorX<T>::Zero(shape.hidden)),
        cell(VectorX<T>::Zero(shape.cells())),
        own(NetworkContext(body)),
        force_unit(shape.ForceUnit(body.mass)) {
    context = NetworkWeights<T>(shape, weights).context * shape.GateContext(own).template cast<T>();
    if (!shape.ldp()) rest = Squashed(context);
  }
};

// One step of the network after its inputs were set: advances the memory and returns the force.
template <typename T>
Vector4<T> StepNetwork(const NetworkShape& shape, const T* weights, NetworkState<T>* state) {
  if (!shape.any()) return Vector4<T>::Zero();
  const NetworkWeights<T> w(shape, weights);
  NetworkState<T>& s = *state;
  const int nf = shape.num_features(), h = shape.hidden;
  Vector4<T> output;
  if (!shape.ldp()) {
    const VectorX<T> sum = w.gates * s.inputs + s.context;
    s.hidden = Squashed(sum) - s.rest;
    output = w.output * s.hidden;
  } else {
    const Eigen::Matrix<T, 2, 1> own = s.own.template cast<T>();
    const VectorX<T> embedded = w.embed.leftCols(kMotionInputs) * s.inputs;
    const VectorX<T> features = Rectified<T>(embedded + w.embed.rightCols(2) * own);
    VectorX<T> sum = w.gates.leftCols(nf) * features + s.context;
    sum += w.gates.rightCols(h) * s.hidden;
    const VectorX<T> gates = Logistic<T>(sum.head(3 * h));  // i, f, o
    const VectorX<T> candidates = Squashed<T>(sum.tail(h));
    s.cell = gates.segment(h, h).cwiseProduct(s.cell) + gates.head(h).cwiseProduct(candidates);
    s.hidden = gates.tail(h).cwiseProduct(Squashed(s.cell));
    output = w.output.leftCols(h) * s.hidden;
    output += w.output.col(h);
  }
  return s.force_unit * output;
}

}  // namespace pushid
