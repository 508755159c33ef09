// residuals: the regression of a network's force on friction and balance.
#include "residuals/cost_functions/network_takeover.h"

#include <Eigen/Dense>
#include <cmath>

#include "models/self_force.h"
#include "residuals/sensitivities/network_sensitivities.h"

namespace pushid {
namespace {

const Eigen::Vector3d kTypicalGains(40.0, 1400.0, 70.0);

}  // namespace

TakeoverResidual::TakeoverResidual(const std::vector<PendulumRecording>& recordings,
                                   const ModelOptions& options, double weight)
    : shape_(options.learned->shape),
      num_weights_(options.learned->num_weights()),
      weight_(weight) {
  mutable_parameter_block_sizes()->push_back(num_weights_);
  set_num_residuals(3);
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      const ScenePerson& person = recording.scene.people[n];
      const SelfForce self(options, person.body, person.start.q, recording.scene.dt);
      Path path{person.body, {}, {}, {}};
      for (int t = 0; t < recording.num_frames(); ++t) {
        const PendulumState<double>& state = recording.states[n][t];
        path.deviation.push_back(state.q.tail<2>() - self.posture);
        path.velocity.push_back(state.qd);
        // What one unit of each gain would be as a force.
        Coefficients unit = Coefficients::Zero();
        unit(0, 0) = -self.scale.force * state.qd[0];
        unit(0, 1) = -self.scale.force * state.qd[1];
        unit(1, 2) = -self.scale.stiffness * path.deviation.back()[0];
        unit(2, 2) = -self.scale.damping * state.qd[2];
        const double seen = recording.Weight(n, t) * recording.Weight(n, t);
        gram += seen * unit * unit.transpose();
        path.coefficients.push_back(seen * unit);
      }
      paths_.push_back(std::move(path));
    }
  }
  const Eigen::Matrix3d inverse = gram.completeOrthogonalDecomposition().pseudoInverse();
  for (Path& path : paths_) {
    for (Coefficients& c : path.coefficients) c = (inverse * c).eval();
  }
}

Eigen::Vector3d TakeoverResidual::Regress(const double* weights,
                                          Eigen::Matrix<double, 3, Eigen::Dynamic>* jacobian,
                                          double* mean_square) const {
  const int columns = num_weights_;
  if (jacobian != nullptr) jacobian->setZero(3, columns);
  using States = NetworkSensitivities::StateColumns;
  const States measured = States::Zero(8, columns);  // states do not move
  NetworkSensitivities::ForceColumns by_weight;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0, frames = 0.0;
  for (const Path& path : paths_) {
    NetworkState<double> state(shape_, path.body);
    NetworkSensitivities sensitivities(shape_, weights, path.body.mass,
                                       jacobian != nullptr ? columns : 0,
                                       jacobian != nullptr ? 0 : -1);
    for (size_t t = 0; t < path.coefficients.size(); ++t) {
      SetNetworkInputs<double>(path.deviation[t][0], path.deviation[t][1], path.velocity[t], 0.0,
                               &state);
      const Vector4<double> force = StepNetwork(shape_, weights, path.body.mass, &state);
      sum += path.coefficients[t] * force;
      squares += force.head<2>().squaredNorm() / (path.body.mass * path.body.mass);
      frames += 1.0;
      if (jacobian == nullptr) continue;
      sensitivities.Advance(state, measured);
      by_weight.setZero(4, columns);
      sensitivities.AddTo(&by_weight);
      *jacobian += path.coefficients[t] * by_weight;
    }
  }
  if (mean_square != nullptr) *mean_square = squares / std::max(1.0, frames);
  return sum;
}

bool TakeoverResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_weight;
  const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
  const Eigen::Vector3d taken = Regress(blocks[0], wanted ? &by_weight : nullptr, nullptr);
  const Eigen::Vector3d scale = weight_ * kTypicalGains.cwiseInverse();
  Eigen::Map<Eigen::Vector3d>(residuals, 3) = scale.cwiseProduct(taken);
  if (wanted) {
    using RowMajor = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], 3, num_weights_) = scale.asDiagonal() * by_weight;
  }
  return true;
}

Takeover TakeoverResidual::Of(const std::vector<double>& weights) const {
  Takeover takeover;
  double mean_square = 0.0;
  const Eigen::Vector3d taken = Regress(weights.data(), nullptr, &mean_square);
  takeover.mu = taken[0];
  takeover.kp_theta = taken[1];
  takeover.kd_theta = taken[2];
  takeover.rms_force = std::sqrt(mean_square);
  return takeover;
}

}  // namespace pushid
