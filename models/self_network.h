// models: a small network as a part of the self force: what a person does beyond balance and
// friction, learned. An MLP, a GRU or an LSTM of any size, from the person's own state alone.
//
//   u = [e_theta/0.15, e_phi/0.15, xd/0.8, yd/0.8, thd/0.6, phd/0.6]
//   k = [(M - 85 kg)/20 kg, 1]            what does not change during a rollout
//   x = u, or tanh(E u) with an embedding
//
//   mlp    h = tanh(W x + C k) - tanh(C k)
//
//   gru    z, r = s(W x + U h + C k)
//          n = tanh(W_n x + r (U_n h))
//          h' = (1 - z) n + z h
//
//   lstm   i, f, o = s(W x + U h + C k)
//          g = tanh(W_g x + U_g h)
//          c' = f c + i g
//          h' = o tanh(c')
//
//   F = 2 M [O h']                        m/s^2 and m^2/s^2 per unit of output
//
//   ldp    x = max(0, E [u, k])
//          i, f, o = s(W x + U h + b + b'), g = tanh(W_g x + U_g h + b_g + b_g')
//          c' = f c + i g,  h' = o tanh(c'),  F = 2 (85 kg) [O h' + d]
//
// s is the logistic function, products of vectors are by element, memories start at zero. What
// could answer to k alone has no bias and no mass: a person at rest (u = 0) feels exactly no
// force, whatever the weights, and O = 0 is no force at all. `ldp` has no such guarantee: it is the
// network of Yue et al. (CVPR 2024, Eq. 6): mass among the inputs, an embedding of 32, an LSTM of
// 256 with the two biases of a gate that LibTorch has: 298,244 weights.
//
// Weights are one flat array: E, then the rows [W U C] of the gates (of ldp [W U b b'], g among
// them), then the rows [W U] of the candidates (n or g), then O, of ldp [O d]; each matrix by rows.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "models/dual.h"
#include "models/enum_names.h"
#include "models/ipm.h"
#include "models/model_rows.h"

namespace pushid {

// What the learned terms of a person see of that person, in units of typical ranges, and
// how they read matrices from a flat array of weights.

template <typename T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;
// Rows of a matrix in a flat array, each followed by the next after a stride.
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

// The first of u: e = (theta, phi) less the posture, and the velocities.
template <typename T>
void SetMotionInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd, VectorX<T>* u) {
  (*u)[0] = e_theta / kNetworkAngle;
  (*u)[1] = e_phi / kNetworkAngle;
  (*u)[2] = qd[0] / kNetworkSpeed;
  (*u)[3] = qd[1] / kNetworkSpeed;
  (*u)[4] = qd[2] / kNetworkRate;
  (*u)[5] = qd[3] / kNetworkRate;
}

// Their derivatives by [theta, phi, qd].
inline Eigen::Matrix<double, kMotionInputs, 1> MotionInputScales() {
  Eigen::Matrix<double, kMotionInputs, 1> scales;
  scales << kNetworkAngle, kNetworkAngle, kNetworkSpeed, kNetworkSpeed, kNetworkRate, kNetworkRate;
  return scales.cwiseInverse();
}

#define PUSHID_NETWORK(id, ...) id,
enum class NetworkKind { kNone, PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK) };
#undef PUSHID_NETWORK

struct NetworkKindRow {
  const char* name;
  NetworkKind value;
  int gates;  // for each hidden unit
  bool recurrent, cell, biased;
};
inline constexpr NetworkKindRow kNetworkKinds[] = {
    {"none", NetworkKind::kNone, 0, false, false, false},
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  {name, NetworkKind::id, gates, recurrent, cell, biased},
    PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
};
static_assert(RowsAreInOrder(kNetworkKinds));
constexpr const auto& Names(NetworkKind) { return kNetworkKinds; }

struct NetworkShape {
  NetworkKind kind = NetworkKind::kNone;
  int hidden = 0;
  int embedding = 0;  // 0: none; of a recurrent network

  bool any() const { return kind != NetworkKind::kNone; }
  bool recurrent() const { return RowOf(kind).recurrent; }
  bool biased() const { return RowOf(kind).biased; }
  int cells() const { return RowOf(kind).cell ? hidden : 0; }
  int num_features() const { return embedding > 0 ? embedding : kMotionInputs; }
  int gate_rows() const { return RowOf(kind).gates * hidden; }
  // Where all are biased, candidates are gates like the others.
  int candidate_rows() const { return recurrent() && !biased() ? hidden : 0; }
  int candidate_width() const { return num_features() + (recurrent() ? hidden : 0); }
  int gate_width() const { return candidate_width() + 2; }
  int embed_width() const { return kMotionInputs + (biased() ? 2 : 0); }
  int output_width() const { return hidden + (biased() ? 1 : 0); }
  // Where each matrix starts in the flat array.
  int gates_at() const { return embedding * embed_width(); }
  int candidates_at() const { return gates_at() + gate_rows() * gate_width(); }
  int output_at() const { return candidates_at() + candidate_rows() * candidate_width(); }
  int num_weights() const { return any() ? output_at() + 4 * output_width() : 0; }

  // Newtons and newton metres per unit of output.
  double ForceUnit(double mass) const {
    return kNetworkAcceleration * (biased() ? kReferenceMass : mass);
  }
  // What the gates' last two columns multiply.
  Eigen::Vector2d GateContext(const Eigen::Vector2d& context) const {
    return biased() ? Eigen::Vector2d::Ones().eval() : context;
  }
};

// The matrices in a flat array.
template <typename T>
struct NetworkWeights {
  ConstRows<T> embed, gates, context, candidates, output;

  NetworkWeights(const NetworkShape& s, const T* w)
      : embed(w, s.embedding, s.embed_width(), Stride(s.embed_width())),
        gates(w + s.gates_at(), s.gate_rows(), s.candidate_width(), Stride(s.gate_width())),
        context(w + s.gates_at() + s.candidate_width(), s.gate_rows(), 2, Stride(s.gate_width())),
        candidates(w + s.candidates_at(), s.candidate_rows(), s.candidate_width(),
                   Stride(s.candidate_width())),
        output(w + s.output_at(), 4, s.output_width(), Stride(s.output_width())) {}

 private:
  static Eigen::OuterStride<> Stride(int width) { return Eigen::OuterStride<>(width); }
};

// One person's memory, and every value on the way from the inputs to the output of the last step:
// what derivatives by hand are made of.
template <typename T>
struct NetworkState {
  VectorX<T> inputs, features;  // u, x
  VectorX<T> gates;             // activations: mlp tanh; gru z, r; lstm i, f, o; ldp i, f, o, g
  VectorX<T> rest;              // mlp: tanh(C k)
  VectorX<T> candidates, recurrent;  // n or g; gru: U_n h
  VectorX<T> hidden_before, cell_before, hidden, cell, cell_tanh;
  Eigen::Vector2d context = Eigen::Vector2d::Zero();  // k

  NetworkState(const NetworkShape& shape, const Body& body)
      : inputs(VectorX<T>::Zero(kMotionInputs)),
        hidden(VectorX<T>::Zero(shape.hidden)),
        cell(VectorX<T>::Zero(shape.cells())),
        context((body.mass - kReferenceMass) / kNetworkMass, 1.0) {}
};

// e: (theta, phi) less the posture.
template <typename T>
void SetNetworkInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd,
                      NetworkState<T>* state) {
  SetMotionInputs(e_theta, e_phi, qd, &state->inputs);
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

// From the sums of a step to the hidden units. sum: of the gates, with the context's part C k.
// Of a recurrent network state holds the candidates' sum over the features, and over h.
struct MlpCell {
  template <typename T>
  static void Step(const VectorX<T>& sum, const VectorX<T>& context, NetworkState<T>* state) {
    state->gates = Squashed(sum);
    state->rest = Squashed(context);
    state->hidden = state->gates - state->rest;
  }
};

struct GruCell {
  template <typename T>
  static void Step(const VectorX<T>& sum, const VectorX<T>&, NetworkState<T>* state) {
    NetworkState<T>& s = *state;
    const Eigen::Index h = s.hidden.size();
    s.gates = Logistic(sum);
    s.candidates += s.gates.tail(h).cwiseProduct(s.recurrent);
    s.candidates = Squashed(s.candidates);
    s.hidden = s.candidates + s.gates.head(h).cwiseProduct(s.hidden_before - s.candidates);
  }
};

struct LstmCell {
  template <typename T>
  static void Step(const VectorX<T>& sum, const VectorX<T>&, NetworkState<T>* state) {
    NetworkState<T>& s = *state;
    const Eigen::Index h = s.hidden.size();
    s.gates = Logistic(sum);
    s.candidates += s.recurrent;
    s.candidates = Squashed(s.candidates);
    s.cell_before = s.cell;
    s.cell = s.gates.segment(h, h).cwiseProduct(s.cell_before) +
             s.gates.head(h).cwiseProduct(s.candidates);
    s.cell_tanh = Squashed(s.cell);
    s.hidden = s.gates.tail(h).cwiseProduct(s.cell_tanh);
  }
};

struct LdpCell {
  template <typename T>
  static void Step(const VectorX<T>& sum, const VectorX<T>&, NetworkState<T>* state) {
    NetworkState<T>& s = *state;
    const Eigen::Index h = s.hidden.size();
    s.candidates = sum.tail(h);
    s.recurrent = VectorX<T>::Zero(h);  // already in the sum
    LstmCell::Step<T>(sum.head(3 * h), sum, state);
    s.gates.conservativeResize(4 * h);
    s.gates.tail(h) = s.candidates;
  }
};

// The features x, its inputs set.
template <typename T>
VectorX<T> NetworkFeatures(const NetworkShape& shape, const NetworkWeights<T>& weights,
                           const NetworkState<T>& state) {
  if (shape.embedding == 0) return state.inputs;
  const VectorX<T> sum = weights.embed.leftCols(kMotionInputs) * state.inputs;
  if (!shape.biased()) return Squashed(sum);
  const Eigen::Matrix<T, 2, 1> context = state.context.template cast<T>();
  return Rectified<T>(sum + weights.embed.rightCols(2) * context);
}

// One step of the network, its inputs set: the memory goes on, and the force is what it answers.
template <typename T>
Vector4<T> StepNetwork(const NetworkShape& shape, const T* weights, double mass,
                       NetworkState<T>* state) {
  if (!shape.any()) return Vector4<T>::Zero();
  const NetworkWeights<T> w(shape, weights);
  NetworkState<T>& s = *state;
  s.features = NetworkFeatures(shape, w, s);
  const int nf = shape.num_features(), h = shape.hidden;
  const VectorX<T> context = w.context * shape.GateContext(s.context).template cast<T>();
  VectorX<T> sum = w.gates.leftCols(nf) * s.features + context;
  if (shape.recurrent()) {
    s.hidden_before = s.hidden;
    sum += w.gates.rightCols(h) * s.hidden;
    s.candidates = w.candidates.leftCols(nf) * s.features;
    s.recurrent = w.candidates.rightCols(h) * s.hidden;
  }
  switch (shape.kind) {
    case NetworkKind::kNone:
      break;
#define PUSHID_NETWORK(id, name, gates, recurrent, cell, biased, Kind) \
  case NetworkKind::id:                                                \
    Kind##Cell::Step(sum, context, &s);                                \
    break;
      PUSHID_SELF_FORCES(PUSHID_NO_SELF_FORCE, PUSHID_NETWORK)
#undef PUSHID_NETWORK
  }
  Vector4<T> output = w.output.leftCols(h) * s.hidden;
  if (shape.biased()) output += w.output.col(h);
  return T(shape.ForceUnit(mass)) * output;
}

}  // namespace pushid
