// residuals: people of several recordings rolled out side by side, and back (adjoint_gradient.h).
#pragma once

#include <vector>

#include "models/rollout.h"
#include "residuals/adjoint_gradient.h"
#include "residuals/network_lockstep.h"

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
  using State = Eigen::Matrix<double, 8, 1>;  // an adjoint of [q, qd]

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
  void SetInputs(int step);
  void Step(const ParameterSet<double>& p, int step, std::vector<RolloutStatus>* status);
  double Cost() const;
  // Adds the residual of a frame to its adjoint.
  void AddResidual(const Walker& walker, int frame, State* adjoint) const;

  const ModelOptions options_;
  const ResidualSigmas sigmas_;
  std::vector<Walker> walkers_;
  std::vector<int> horizon_, end_;  // by place: frames to roll out, and those that count
  NetworkLockstep network_;
  NetworkLockstep::Columns inputs_, forces_;
};

}  // namespace pushid
