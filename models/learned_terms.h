// models: all that a model has learned: a self force, a law of the rod, what people do to each
// other; any of them, their weights in one flat array.
#pragma once

#include <string>
#include <vector>

#include "models/enum_names.h"
#include "models/interaction.h"
#include "models/options.h"
#include "models/self_network.h"

namespace pushid {

// Layers of a network, of the rod's law and of the interaction: hidden ones, each a function by
// element of W x + b, then O h + c. Their weights are one flat array: for each layer the rows [W
// b], then the rows [O c].
int NumLayerWeights(int inputs, const std::vector<int>& hidden, int outputs);

// A layer's [W b] in the flat array.
template <typename T>
ConstRows<T> LayerAt(const T* weights, int rows, int inputs) {
  return {weights, rows, inputs + 1, Eigen::OuterStride<>(inputs + 1)};
}

// O h + c; values: u. rectified: max(0, .) of hidden sums, else tanh.
template <typename T>
VectorX<T> RunLayers(const std::vector<int>& hidden, int outputs, bool rectified, const T* weights,
                     VectorX<T> values) {
  for (int rows : hidden) {
    const int inputs = static_cast<int>(values.size());
    const ConstRows<T> layer = LayerAt(weights, rows, inputs);
    const VectorX<T> sum = layer.leftCols(inputs) * values + layer.col(inputs);
    values = rectified ? Rectified(sum) : Squashed(sum);
    weights += layer.size();
  }
  const int inputs = static_cast<int>(values.size());
  const ConstRows<T> last = LayerAt(weights, outputs, inputs);
  return last.leftCols(inputs) * values + last.col(inputs);
}

// The rod's length as a state that a learned law changes from step to step: LDP's rod network (Yue
// et al., CVPR 2024, Eq. 7; of the paper 128-128, of its release 256-128-256).
//
//   l' = l + dt * 0.1 m/s * f(u)
//   u = [e_theta / 0.15, e_phi / 0.15, xd / 0.8, yd / 0.8, thd / 0.6, phd / 0.6,
//        (F_self - F_rest) / (2 M) (4), (l - 0.95 m) / 0.05, (M - 85 kg) / 20 kg]
//   h_i = max(0, W_i h_{i-1} + b_i),  f = o h_n + c
// F_self: balance, linear and learned self force, whether or not a push hides them for a while, and
// not friction, which is the ground's; F_rest: the torque that holds the posture. Weights may move
// the rod of a person at rest. Rejected: laws without biases that keep it, linear or of layers,
// which take the cart with the rod: none predicts unseen pushes better.

enum class RodKind { kConstant, kLdp };
constexpr EnumNames<RodKind, 2> Names(RodKind) {
  return {{{"constant", RodKind::kConstant}, {"ldp", RodKind::kLdp}}};
}

struct RodShape {
  RodKind kind = RodKind::kConstant;
  std::vector<int> hidden = {};  // layers of LDP's, at least one

  static constexpr int kForceInputs = kMotionInputs;  // where the four of the self force start
  static constexpr int kRodInput = kForceInputs + 4;
  static constexpr int kInputs = kRodInput + 2;

  bool moves() const { return kind != RodKind::kConstant; }
  int num_weights() const { return moves() ? NumLayerWeights(kInputs, hidden, 1) : 0; }
};

// "constant", "ldp:128-128".
std::string RodName(const RodShape& shape);

inline constexpr double kRodSpeed = 0.1;  // m/s per unit of f
// m: beyond them a rollout has left the model's domain.
inline constexpr double kShortestRod = 0.3, kLongestRod = 1.6;

// u. e: (theta, phi) less the posture; force: F_self - F_rest; rod: l - l_0; body: with l_0.
template <typename T>
VectorX<T> RodInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd,
                     const Vector4<T>& force, const T& rod, const Body& body) {
  VectorX<T> u(RodShape::kInputs);
  SetMotionInputs(e_theta, e_phi, qd, &u);
  for (int i = 0; i < 4; ++i) {
    u[RodShape::kForceInputs + i] = force[i] / (kNetworkAcceleration * body.mass);
  }
  u[RodShape::kRodInput] = rod / kNetworkRod + (body.rod_length - kReferenceRod) / kNetworkRod;
  u[RodShape::kRodInput + 1] = T((body.mass - kReferenceMass) / kNetworkMass);
  return u;
}

// dl/dt in m/s.
template <typename T>
T RodVelocity(const RodShape& shape, const T* weights, const VectorX<T>& inputs) {
  return kRodSpeed * RunLayers(shape.hidden, 1, true, weights, inputs)[0];
}

// A learned interaction: a small network beside contact, fitted with
// everything else.
//
//   u = [dx/0.4, dy/0.4, dxd/0.8, dyd/0.8, th_n/0.15, th_j/0.15, ph_n/0.15, ph_j/0.15,
//        dthd/0.6, dphd/0.6]                     carts, n minus j: LDP's ten inputs
//   h_1 = tanh(W_1 u + b_1), h_i = tanh(W_i h_(i-1) + b_i)
//   F on n = 2 M_n g (O h_last + c),             g = x / (x + w)
//
// x: the load of contact, w its onset (interaction.h), so that people who do not touch do nothing
// to each other, whatever the weights, and O = c = 0 is no force at all. Each of the two asks the
// same network alone: the force is not mutual, and no matter who is numbered first.
//
// `ldp_network` is LDP's interaction network (Yue et al., CVPR 2024: 10-512-512-4). It
// acts on every neighbour within the range, touched or not:
//   h_i = max(0, W_i h_(i-1) + b_i),  F on n = 2 (85 kg) (O h_last + c),  |r_n - r_j| < range

inline constexpr double kPairDistance = 0.4;  // m

struct PairShape {
  std::vector<int> hidden = {};  // units of each layer; empty: nothing is learned
  bool ldp = false;              // LDP's: of every neighbour in range, rectified, no gate

  static constexpr int kInputs = 10;
  bool any() const { return !hidden.empty(); }
  int num_weights() const { return any() ? NumLayerWeights(kInputs, hidden, 4) : 0; }
  // Newtons and newton metres per unit of output.
  double ForceUnit(const Body& body) const {
    return kNetworkAcceleration * (ldp ? kReferenceMass : body.mass);
  }
};

// "network:4", "network:32-16", "ldp_network:512-512".
std::string PairName(const PairShape& shape);

// u of n who meets j.
template <typename T>
VectorX<T> PairInputs(const PendulumState<T>& n, const PendulumState<T>& j) {
  VectorX<T> u(PairShape::kInputs);
  u << (n.q[0] - j.q[0]) / kPairDistance, (n.q[1] - j.q[1]) / kPairDistance,
      (n.qd[0] - j.qd[0]) / kNetworkSpeed, (n.qd[1] - j.qd[1]) / kNetworkSpeed,
      n.q[2] / kNetworkAngle, j.q[2] / kNetworkAngle, n.q[3] / kNetworkAngle,
      j.q[3] / kNetworkAngle, (n.qd[2] - j.qd[2]) / kNetworkRate,
      (n.qd[3] - j.qd[3]) / kNetworkRate;
  return u;
}

// The gate g of two people; zero where neither loads the other, of LDP's out of range.
template <typename T>
T PairGate(const PairShape& shape, const Pair& pair, const ParameterSet<T>& p,
           const Vector4<T>& q_n, const Vector4<T>& q_j) {
  if (shape.ldp) return T(InLdpRange(p, q_n, q_j) ? 1.0 : 0.0);
  const T load = LoadBetween(pair, p, q_n, q_j);
  return RealPart(load) > 0.0 ? T(load / (load + kContactOnset)) : T(0.0);
}

template <typename T>
void AddLearnedPair(const PairShape& shape, const T* weights, const Pair& pair,
                    const ParameterSet<T>& p, const PendulumState<T>& n, const PendulumState<T>& j,
                    PairForce<T>* force) {
  const T gate = PairGate<T>(shape, pair, p, n.q, j.q);
  if (!(RealPart(gate) > 0.0)) return;
  const auto answer = [&](const VectorX<T>& u) -> Vector4<T> {
    return RunLayers(shape.hidden, 4, shape.ldp, weights, u);
  };
  force->on_n += (shape.ForceUnit(pair.body_n) * gate) * answer(PairInputs(n, j));
  force->on_j += (shape.ForceUnit(pair.body_j) * gate) * answer(PairInputs(j, n));
  force->acts = true;
}

// "none", "mlp:4", "ldp:256:32" (hidden size, embedding).
std::string NetworkName(const NetworkShape& shape);

struct LearnedTerms {
  NetworkShape shape;           // of the self force
  std::vector<double> weights;  // of the self force, then of the rod's law, then of the interaction
  RodShape rod = {};            // of the rod's law
  PairShape pair = {};          // of the interaction

  bool any() const { return shape.any() || rod.moves() || pair.any(); }
  int num_weights() const { return pair_at() + pair.num_weights(); }
  // The first weights of rod and interaction.
  int rod_at() const { return shape.num_weights(); }
  int pair_at() const { return rod_at() + rod.num_weights(); }
};

// Whether something is learned of a person alone: a force, or how the rod moves.
inline bool LearnsAlone(const ModelOptions& options) {
  return options.learned != nullptr &&
         (options.learned->shape.any() || options.learned->rod.moves());
}

// Whether the rod moves.
inline bool RodMoves(const ModelOptions& options) {
  return options.learned != nullptr && options.learned->rod.moves();
}

}  // namespace pushid
