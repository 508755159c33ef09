// residuals: people of several recordings rolled out side by side, and back (adjoint_gradient.h).
#pragma once

#include <optional>
#include <vector>

#include "models/rollout.h"
#include "residuals/adjoint/adjoint_gradient.h"
#include "residuals/adjoint/network_lockstep.h"
#include "residuals/adjoint/rod_lockstep.h"

namespace pushid {

class AdjointGradient::Batch {
 public:
  // recordings: indices into `all`; those of more frames first.
  Batch(const std::vector<AdjointRecording>& all, const std::vector<int>& recordings,
        const ModelOptions& options, const ResidualSigmas& sigmas, const VectorKernels& kernels);

  // Returns the cost, and what became of the batch's recordings.
  double Forward(const ParameterSet<double>& p, const double* weights,
                 std::vector<RolloutStatus>* status);

  // After Forward, with the same arguments. by_parameter: of natural values; adds to both.
  void Backward(const ParameterSet<double>& p, ParameterSet<double>* by_parameter,
                double* by_weight);

 private:
  using State = Eigen::Matrix<double, 8, 1>;
  // d(cost)/d(one column's state) on the way back.
  struct Adjoint {
    State state = State::Zero();  // [q, qd]
    double rod = 0.0;
    // What the backward difference of the cart's velocity hands to the frame before.
    Eigen::Vector2d owed = Eigen::Vector2d::Zero();
  };

  // One column of the lockstep.
  struct Walker {
    const PendulumRecording* recording;
    int index, place, person;  // of the recording among all, in the batch; of the person in it
    double weight;
    SelfForce self;
    std::vector<PendulumState<double>> path;
    std::vector<Vector4<double>> acceleration;

    const Scene& scene() const { return recording->scene; }
    const Body& body() const { return self.body; }
    const Vector4<double>& VelocityBefore(int frame) const {
      return path[frame > 0 ? frame - 1 : 0].qd;
    }
    MeasuredFrame Measured(int frame) const;
  };

  bool Going(const Walker& walker, int step) const { return step + 1 < end_[walker.place]; }
  // What the networks answer to the states of a step.
  void SetForces(int step);
  void SetRodVelocities(const ParameterSet<double>& p, int step);
  void Step(const ParameterSet<double>& p, int step, std::vector<RolloutStatus>* status);
  double Cost(double lift) const;
  // Adds the residual of a frame to its adjoint; returns its part of d(cost)/d(lift).
  double AddResidual(const Walker& walker, int frame, double lift, Adjoint* adjoint) const;
  // A walker's step back but for the networks. by_rod: the adjoint of what the rod's law saw; null
  // where it is constant. Returns the adjoint of the force of the network.
  Vector4<double> StepBack(const Walker& walker, const ParameterSet<double>& p, int step,
                           const Eigen::VectorXd* by_rod, Adjoint* adjoint,
                           ParameterSet<double>* by_parameter) const;

  const ModelOptions options_;
  const ResidualSigmas sigmas_;
  std::vector<Walker> walkers_;
  std::vector<int> horizon_, end_;  // by place: frames to roll out, and those that count
  LockstepColumns columns_;
  std::optional<NetworkLockstep> network_;  // none: no force
  std::optional<RodLockstep> rod_;          // none: constant
  Eigen::MatrixXd inputs_, forces_, rod_inputs_;
  Eigen::RowVectorXd rod_velocities_;
};

}  // namespace pushid
