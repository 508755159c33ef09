// residuals: the cost of whole recordings and its gradient by the adjoint: for networks of so many
// weights that no Jacobian fits (an LSTM of 256 has 300 000).
//
//   cost = sum over recordings of 1/2 |RolloutResiduals|^2, robust loss and weights included
// With L = d(cost)/d[q, qd] of the next frame and g = L_qd + dt L_q, the step
//   M a = F - C - G,  qd' = qd + dt a,  q' = q + dt qd'
// goes back by
//   f = dt M^-1 g                          d(cost)/dF
//   L_q <- L_q + J_q' f,  L_qd <- g + J_qd' f,   J = dF/ds - d(M a + C + G)/ds at fixed a
// and d(cost)/dp += (dF/dp)' f (step_adjoint.h); the network's part of dF/ds: batched_networks.h.
// Where the rod moves, l' = l + dt v(s, F_self, l), its adjoint goes back through v
// (batched_networks.h) to s, F_self and p:
//   L_l <- L_l + dt v_l L_l - (d(M a + C + G)/dl)' f
// Forces between people: adjoint_gradient.cc.
// One gradient costs about as much as three rollouts, whatever the number of weights.
//
//   auto gradient = AdjointGradient::Create({{&recording, weight}}, options, map, sigmas);
//   if (!gradient.ok()) ...
//   const AdjointCost cost = gradient.value().Evaluate(shared, weights, by_shared, by_weight);
//
// Shared parameters (on the fitted scale) and weights only: deviations of units and free initial
// velocities are few and belong to Gauss-Newton. Deviations may be held (AdjointRecording::held).
#pragma once

#include <memory>
#include <vector>

#include "datasets/files/error.h"
#include "residuals/rollout_residual.h"

namespace pushid {

struct AdjointRecording {
  const PendulumRecording* recording = nullptr;  // must outlive the gradient
  double weight = 1.0;                           // on every residual
  int horizon = 0;                               // at most that many frames; 0 means all
  // Values of what is not fitted, in place of the map's: of each person, or one for all. What two
  // people share is taken from the first. Empty: the map's.
  std::vector<ParameterSet<double>> held = {};
};

struct AdjointCost {
  double cost = 0.0;  // of the frames before a failure
  // By recording: where its rollout left the domain.
  std::vector<RolloutStatus> status;

  bool ok() const { return num_failed() == 0; }
  int num_failed() const;
};

class AdjointGradient {
 public:
  // Fails, in words, on feet that stand and step, deviations, free initial velocities, and
  // where options have no network. map.num_weights: that of the network's.
  static Result<AdjointGradient> Create(const std::vector<AdjointRecording>& recordings,
                                        const ModelOptions& options, const ParameterMap& map,
                                        const ResidualSigmas& sigmas);

  AdjointGradient(AdjointGradient&&) noexcept;
  ~AdjointGradient();

  int num_shared() const;
  int num_weights() const;

  // Equal arguments give equal bits. by_shared and by_weight: overwritten; null where
  // not wanted. One call at a time: everything that a rollout leaves behind is kept in the object
  // (8 kB a person and frame for ldp:256:32, 17 for its gradient; 17 kB for each of two people and
  // frame in which they touch for an interaction network:512-512).
  AdjointCost Evaluate(const double* shared, const double* weights, double* by_shared,
                       double* by_weight);

 private:
  class Batch;
  AdjointGradient();

  ParameterMap map_;
  int num_weights_ = 0, num_recordings_ = 0;
  std::vector<std::unique_ptr<Batch>> batches_;
};

}  // namespace pushid
