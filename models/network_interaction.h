// models: an interaction network: what a person gets from a neighbour, learned (LDP: 10-512-512-4).
//
//   u = ([dx, dy, dxd, dyd, th_n, th_j, ph_n, ph_j, dthd, dphd] - mean) / deviation    (n minus j)
//   F on n = clamp(scale * MLP(u) + offset) * switch(range - d), d the carts' distance,
//   switch = (1 + tanh(. / 0.05 m)) / 2, range = neighbour_range.
// Not mutual: each of the two asks alone. The clamp is optional and as hard as LDP's; a
// network for fitting around should have none.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <type_traits>
#include <vector>

#include "models/enum_names.h"
#include "models/ldp_interaction.h"

namespace pushid {

// A small fully connected network with fixed weights: its value and its derivatives by the
// inputs, at once and by hand, so that no automatic differentiation runs through the layers.
//
//   y = W_L s(... s(W_1 x + b_1) ...) + b_L, s = tanh or max(0, .)
enum class Activation { kTanh, kRelu };
constexpr EnumNames<Activation, 2> Names(Activation) {
  return {{{"tanh", Activation::kTanh}, {"relu", Activation::kRelu}}};
}

struct MlpLayer {
  Eigen::MatrixXd weights;  // outputs x inputs
  Eigen::VectorXd bias;
};

struct Mlp {
  Activation activation = Activation::kTanh;
  std::vector<MlpLayer> layers;  // at least one; the last is linear

  int num_inputs() const { return static_cast<int>(layers.front().weights.cols()); }
  int num_weights() const;

  // by_input (outputs x inputs) may be null.
  Eigen::VectorXd Evaluate(const Eigen::VectorXd& input, Eigen::MatrixXd* by_input) const;
};

inline constexpr int kNetworkInputs = 10;

struct InteractionNetwork {
  using Inputs = Eigen::Matrix<double, kNetworkInputs, 1>;
  Mlp mlp;  // 10 inputs, 4 outputs
  Inputs mean = Inputs::Zero(), deviation = Inputs::Ones();
  Vector4<double> scale = Vector4<double>::Ones(), offset = Vector4<double>::Zero();
  std::optional<Vector4<double>> lowest, highest;  // of the clamp
};

struct NetworkTerm {
  const InteractionNetwork* network;

  template <typename T>
  void Add(const Pair&, const ParameterSet<T>& p, const PendulumState<T>& n,
           const PendulumState<T>& j, PairForce<T>* force) const {
    using std::sqrt;
    constexpr double kTiny = 1e-12;  // m^2
    const T d = sqrt((n.q.template head<2>() - j.q.template head<2>()).squaredNorm() + kTiny);
    if (RealPart(d) > SmoothLdpReach(p)) return;
    const T on = SoftStep<T>(p[kNeighbourRange] - d, kLdpSoftDistance);
    force->on_n += on * Force(n, j);
    force->on_j += on * Force(j, n);
    force->acts = true;
  }

 private:
  // The force on n, its derivatives by the inputs carried on to whatever the scalar carries.
  template <typename T>
  Vector4<T> Force(const PendulumState<T>& n, const PendulumState<T>& j) const {
    const T inputs[kNetworkInputs] = {
        n.q[0] - j.q[0], n.q[1] - j.q[1], n.qd[0] - j.qd[0], n.qd[1] - j.qd[1], n.q[2], j.q[2],
        n.q[3],          j.q[3],          n.qd[2] - j.qd[2], n.qd[3] - j.qd[3]};
    InteractionNetwork::Inputs u;
    for (int i = 0; i < kNetworkInputs; ++i) {
      u[i] = (RealPart(inputs[i]) - network->mean[i]) / network->deviation[i];
    }
    constexpr bool kPlain = std::is_same<T, double>::value;
    Eigen::MatrixXd by_input;
    const Vector4<double> raw = network->mlp.Evaluate(u, kPlain ? nullptr : &by_input);
    Vector4<T> force;
    for (int row = 0; row < 4; ++row) {
      double value = network->scale[row] * raw[row] + network->offset[row];
      const bool low = network->lowest && value < (*network->lowest)[row];
      const bool high = network->highest && value > (*network->highest)[row];
      if (low) value = (*network->lowest)[row];
      if (high) value = (*network->highest)[row];
      force[row] = T(value);
      if constexpr (!kPlain) {
        if (low || high) continue;
        for (int i = 0; i < kNetworkInputs; ++i) {
          const double slope = network->scale[row] * by_input(row, i) / network->deviation[i];
          force[row].v += slope * inputs[i].v;
        }
      }
    }
    return force;
  }
};

}  // namespace pushid
