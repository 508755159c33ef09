// residuals: settling and stability by forward sensitivities.
#include "residuals/cost_functions/rest_residual.h"

#include <cmath>

#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {
namespace {

constexpr double kWatched = 1.0;  // s, of settled people
constexpr double kMet = 0.9;      // of what counts as settled: where the hinge begins

// A rollout of the problem, with sensitivities where Jacobians are asked for; false when it leaves
// the model's domain.
struct RolledOut {
  RolloutPath<double> path;
  RolloutSensitivities sensitivities;
  std::vector<SelfForce> self;
};
bool RollOut(const RestProblem& p, double const* const* blocks, bool with_sensitivities,
             RolledOut* rolled) {
  const SensitivityInputs inputs = RolloutInputs(p.scene, p.map, p.layout, blocks);
  rolled->self = SelfForces(p.scene, p.options);
  const RolloutStatus status =
      with_sensitivities
          ? RolloutWithSensitivities(p.scene, p.options, inputs, p.last_frame, &rolled->path,
                                     &rolled->sensitivities)
          : Rollout<double>(p.scene, p.options, inputs.parameters, inputs.initial_velocity,
                            p.last_frame, &rolled->path, nullptr, inputs.network_weights);
  return status.ok;
}

void SetSizes(const RestProblem& p, int rows, std::vector<int32_t>* blocks, int* residuals) {
  for (int size : p.layout.BlockSizes()) blocks->push_back(size);
  *residuals = (p.last_frame - p.first_frame) * p.scene.num_people() * rows;
}

// max(0, |v| / limit - 1) and its derivative by v.
template <int kSize>
double Hinge(const Eigen::Matrix<double, kSize, 1>& v, double limit,
             Eigen::Matrix<double, 1, kSize>* slope) {
  const double size = v.norm(), x = size / limit - 1.0;
  *slope = x > 0.0 ? (v / (size * limit)).transpose().eval() : slope->Zero();
  return std::max(0.0, x);
}

}  // namespace

double RestProblem::Scale() const {
  return weight / std::sqrt((last_frame - first_frame) * scene.num_people());
}

RestProblem SettlingProblem(const Scene& scene, const ModelOptions& options,
                            const ParameterMap& map, const ResidualSigmas& sigmas, double weight,
                            const std::string& unit) {
  RestProblem problem;
  problem.scene = scene;
  problem.options = options;
  problem.map = map;
  // No particular person: only the shared block.
  if (unit.empty()) problem.map.num_deviations = 0;
  const std::vector<std::string> units(scene.people.size(), unit);
  problem.layout = BlockLayout(problem.map, units, false);
  problem.sigmas = sigmas;
  problem.weight = weight;
  problem.first_frame = scene.SettledFrame();
  problem.last_frame = problem.first_frame + static_cast<int>(std::lround(kWatched / scene.dt));
  return problem;
}

RestProblem StabilityProblem(const PendulumRecording& recording, double factor, int extra_frames,
                             const ModelOptions& options, const ParameterMap& map,
                             const ResidualSigmas& sigmas, double weight) {
  RestProblem problem;
  problem.scene = ScalePushes(recording.scene, factor);
  problem.options = options;
  problem.map = map;
  problem.layout = BlockLayout(map, PoolingUnits(recording, map.pool_by),
                               recording.initial_velocity == InitialVelocity::kFree);
  problem.sigmas = sigmas;
  problem.weight = weight;
  problem.first_frame = recording.num_frames();
  problem.last_frame = recording.num_frames() + extra_frames;
  return problem;
}

SettlingResidual::SettlingResidual(RestProblem problem) : problem_(std::move(problem)) {
  int residuals = 0;
  SetSizes(problem_, kRows, mutable_parameter_block_sizes(), &residuals);
  set_num_residuals(residuals);
}

bool SettlingResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const RestProblem& p = problem_;
  RolledOut rolled;
  if (!RollOut(p, blocks, jacobians != nullptr, &rolled)) return false;
  const double scale = p.Scale();
  const std::vector<int> sizes = p.layout.BlockSizes();
  RowMajorMatrix by_column;
  int row = 0;
  for (int t = p.first_frame; t < p.last_frame; ++t) {
    for (int n = 0; n < p.scene.num_people(); ++n, row += kRows) {
      const PendulumState<double>& state = rolled.path.At(t, n);
      const Eigen::Vector2d velocity = state.qd.head<2>();
      Eigen::Matrix<double, 1, 2> by_velocity;
      Eigen::Matrix<double, 1, 1> by_angle[2];
      residuals[row] = scale * Hinge<2>(velocity, kMet * kSettledSpeed, &by_velocity);
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Matrix<double, 1, 1> lean(state.q[2 + axis] - rolled.self[n].posture[axis]);
        residuals[row + 1 + axis] = scale * Hinge<1>(lean, kMet * kSettledLean, &by_angle[axis]);
      }
      if (jacobians == nullptr) continue;
      const auto by = rolled.sensitivities.At(t, n);  // of [q, qd] by column
      by_column.resize(kRows, by.cols());
      by_column.row(0) = scale * by_velocity * by.middleRows<2>(4);
      for (int axis = 0; axis < 2; ++axis) {
        by_column.row(1 + axis) = scale * by_angle[axis](0) * by.row(2 + axis);
      }
      ScatterJacobian(by_column, sizes, row, num_residuals(), jacobians);
    }
  }
  return true;
}

StabilityResidual::StabilityResidual(RestProblem problem) : problem_(std::move(problem)) {
  int residuals = 0;
  SetSizes(problem_, kRows, mutable_parameter_block_sizes(), &residuals);
  set_num_residuals(residuals);
}

bool StabilityResidual::Evaluate(double const* const* blocks, double* residuals,
                                 double** jacobians) const {
  const RestProblem& p = problem_;
  RolledOut rolled;
  if (!RollOut(p, blocks, jacobians != nullptr, &rolled)) return false;
  const double w = p.Scale();
  // Component by component: index into [q, qd] and its scale.
  struct Component {
    int state;
    double scale;
  };
  const Component components[kRows] = {{2, w / p.sigmas.angle},
                                       {3, w / p.sigmas.angle},
                                       {6, w / p.sigmas.rate},
                                       {7, w / p.sigmas.rate}};
  const std::vector<int> sizes = p.layout.BlockSizes();
  RowMajorMatrix by_column;
  int row = 0;
  for (int t = p.first_frame; t < p.last_frame; ++t) {
    for (int n = 0; n < p.scene.num_people(); ++n) {
      const PendulumState<double>& state = rolled.path.At(t, n);
      for (const Component& c : components) {
        const double value = c.state < 4 ? state.q[c.state] - rolled.self[n].posture[c.state - 2]
                                         : state.qd[c.state - 4];
        residuals[row] = c.scale * value;
        if (jacobians != nullptr) {
          by_column = c.scale * rolled.sensitivities.At(t, n).row(c.state);
          ScatterJacobian(by_column, sizes, row, num_residuals(), jacobians);
        }
        ++row;
      }
    }
  }
  return true;
}

}  // namespace pushid
