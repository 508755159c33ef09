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

// The rod's length as a state that a learned law changes from step to step.
//
//   l' = l + dt * 0.1 m/s * f(u)
//   u = [e_theta / 0.15, e_phi / 0.15, xd / 0.8, yd / 0.8, thd / 0.6, phd / 0.6,
//        (F_self - F_rest) / (2 M) (4), (l - l_0) / 0.05]
//   linear  f = w u
//   mlp     h_1 = tanh(W_1 u + b_1) - tanh(b_1),  h_i = tanh(W_i h_{i-1} + b_i) - tanh(b_i),
//           f = o h_n
// F_self: balance, linear and learned self force, whether or not a push hides them for a while, and
// not friction, which is the ground's (LDP, Eq. 7); F_rest: the torque that holds the posture. A
// person at rest with the rod of frame 0 (u = 0) keeps exactly that rod, whatever the weights, and
// zero weights (of f or of o) are a constant rod. Nothing pulls the rod back but the weights on
// l - l_0: built-in relaxation would decide what the data can say.
//
// `ldp` is LDP's rod network (Yue et al., CVPR 2024, Eq. 7; of the paper 128-128, of its release
// 256-128-256) without that guarantee; it sees the length itself and the mass:
//   u = [as above (10), (l - 0.95 m) / 0.05, (M - 85 kg) / 20 kg]
//   h_i = max(0, W_i h_{i-1} + b_i),  f = o h_n + c
//
// Weights are one flat array: f's, or for each layer the rows [W b], then o, of ldp [o c].

enum class RodKind { kConstant, kLinear, kMlp, kLdp };
constexpr EnumNames<RodKind, 4> Names(RodKind) {
  return {{{"constant", RodKind::kConstant},
           {"linear", RodKind::kLinear},
           {"mlp", RodKind::kMlp},
           {"ldp", RodKind::kLdp}}};
}

struct RodShape {
  RodKind kind = RodKind::kConstant;
  std::vector<int> hidden = {};  // layers of an MLP, at least one

  static constexpr int kForceInputs = kMotionInputs;  // where the four of the self force start
  static constexpr int kRodInput = kForceInputs + 4;

  bool moves() const { return kind != RodKind::kConstant; }
  bool layered() const { return kind == RodKind::kMlp || kind == RodKind::kLdp; }
  bool biased() const { return kind == RodKind::kLdp; }
  int num_inputs() const { return kRodInput + (biased() ? 2 : 1); }
  int num_weights() const;
};

// "constant", "linear", "mlp:4", "ldp:128-128".
std::string RodName(const RodShape& shape);

inline constexpr double kRodSpeed = 0.1;  // m/s per unit of f
// m: beyond them a rollout has left the model's domain.
inline constexpr double kShortestRod = 0.3, kLongestRod = 1.6;

// The values on the way from the inputs to the output of the last step.
template <typename T>
struct RodLayers {
  VectorX<T> inputs;                     // u
  std::vector<VectorX<T>> active, rest;  // tanh(W x + b), tanh(b); of ldp, max(0, W x + b)
  std::vector<VectorX<T>> hidden;        // the one less the other

  explicit RodLayers(const RodShape& shape)
      : inputs(VectorX<T>::Zero(shape.num_inputs())),
        active(shape.hidden.size()),
        rest(shape.hidden.size()),
        hidden(shape.hidden.size()) {}
};

// e: (theta, phi) less the posture; force: F_self - F_rest; rod: l - l_0; body: with l_0.
template <typename T>
void SetRodInputs(const T& e_theta, const T& e_phi, const Vector4<T>& qd, const Vector4<T>& force,
                  const T& rod, const Body& body, RodLayers<T>* layers) {
  VectorX<T>& u = layers->inputs;
  SetMotionInputs(e_theta, e_phi, qd, &u);
  for (int i = 0; i < 4; ++i) {
    u[RodShape::kForceInputs + i] = force[i] / (kNetworkAcceleration * body.mass);
  }
  u[RodShape::kRodInput] = rod / kNetworkRod;
  if (u.size() == RodShape::kRodInput + 1) return;
  u[RodShape::kRodInput] += (body.rod_length - kReferenceRod) / kNetworkRod;
  u[RodShape::kRodInput + 1] = T((body.mass - kReferenceMass) / kNetworkMass);
}

// dl/dt in m/s, the inputs set.
template <typename T>
T RodVelocity(const RodShape& shape, const T* weights, RodLayers<T>* layers) {
  const VectorX<T>* below = &layers->inputs;
  for (size_t i = 0; i < shape.hidden.size(); ++i) {
    const int rows = shape.hidden[i], width = static_cast<int>(below->size());
    const Eigen::OuterStride<> stride(width + 1);
    const ConstRows<T> w(weights, rows, width, stride), b(weights + width, rows, 1, stride);
    const VectorX<T> sum = w * *below + b;
    layers->active[i] = shape.biased() ? Rectified(sum) : Squashed(sum);
    layers->rest[i] = shape.biased() ? VectorX<T>(VectorX<T>::Zero(rows)) : Squashed<T>(b);
    layers->hidden[i] = layers->active[i] - layers->rest[i];
    below = &layers->hidden[i];
    weights += rows * (width + 1);
  }
  T f = Eigen::Map<const VectorX<T>>(weights, below->size()).dot(*below);
  if (shape.biased()) f += weights[below->size()];
  return kRodSpeed * f;
}

// What people do to each other, learned: a small network beside contact, fitted with
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
//
// Weights are one flat array: for each layer the rows [W b], then the rows [O c].

inline constexpr double kPairDistance = 0.4;  // m

struct PairShape {
  std::vector<int> hidden = {};  // units of each layer; empty: nothing is learned
  bool ldp = false;              // LDP's: of every neighbour in range, rectified, no gate

  static constexpr int kInputs = 10;
  bool any() const { return !hidden.empty(); }
  int num_weights() const;
  // Newtons and newton metres per unit of output.
  double ForceUnit(const Body& body) const {
    return kNetworkAcceleration * (ldp ? kReferenceMass : body.mass);
  }
};

// "network:4", "network:32-16", "ldp_network:512-512".
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
    layers->values[i + 1] = shape.ldp ? Rectified(sum) : Squashed(sum);
    weights += layer.size();
    inputs = shape.hidden[i];
  }
  const ConstRows<T> last = PairLayer(weights, 4, inputs);
  layers->output = last.leftCols(inputs) * layers->values.back() + last.col(inputs);
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
  PairLayers<T> layers;
  RunPairNetwork(shape, weights, n, j, &layers);
  force->on_n += (shape.ForceUnit(pair.body_n) * gate) * layers.output;
  RunPairNetwork(shape, weights, j, n, &layers);
  force->on_j += (shape.ForceUnit(pair.body_j) * gate) * layers.output;
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

// Whether a rod that moves takes the cart with it, which LDP's does not.
inline bool RodMovesCart(const ModelOptions& options) {
  return options.learned != nullptr && options.learned->rod.moves() &&
         !options.learned->rod.biased();
}

// Whether the rod moves.
inline bool RodMoves(const ModelOptions& options) {
  return options.learned != nullptr && options.learned->rod.moves();
}

}  // namespace pushid
