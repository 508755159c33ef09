// residuals: settling and stability by forward sensitivities.
#include "residuals/cost_functions/rest_residual.h"

#include <cmath>

#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {

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
  problem.penalize_velocity = false;
  return problem;
}

RestResidual::RestResidual(RestProblem problem) : problem_(std::move(problem)) {
  for (int size : problem_.layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals((problem_.last_frame - problem_.first_frame) * problem_.scene.num_people() *
                    problem_.residuals_per_frame());
}

bool RestResidual::Evaluate(double const* const* blocks, double* residuals,
                            double** jacobians) const {
  const RestProblem& p = problem_;
  const SensitivityInputs inputs = RolloutInputs(p.scene, p.map, p.layout, blocks);
  RolloutPath<double> path;
  RolloutSensitivities sensitivities;
  const RolloutStatus status =
      jacobians != nullptr
          ? RolloutWithSensitivities(p.scene, p.options, inputs, p.last_frame, &path,
                                     &sensitivities)
          : Rollout<double>(p.scene, p.options, inputs.parameters, inputs.initial_velocity,
                            p.last_frame, &path, nullptr, inputs.network_weights);
  if (!status.ok) return false;

  const double w = p.weight / std::sqrt((p.last_frame - p.first_frame) * p.scene.num_people());
  // Component by component: index into [q, qd] and its scale.
  struct Component {
    int state;
    double scale;
  };
  std::vector<Component> components = {{2, w / p.sigmas.angle},
                                       {3, w / p.sigmas.angle},
                                       {6, w / p.sigmas.rate},
                                       {7, w / p.sigmas.rate}};
  if (p.penalize_velocity) {
    components.push_back({4, w / p.sigmas.velocity});
    components.push_back({5, w / p.sigmas.velocity});
  }

  const std::vector<int> sizes = p.layout.BlockSizes();
  const std::vector<SelfForce> self = SelfForces(p.scene, p.options);
  RowMajorMatrix by_column(1, inputs.num_columns);
  int row = 0;
  for (int t = p.first_frame; t < p.last_frame; ++t) {
    for (int n = 0; n < p.scene.num_people(); ++n) {
      const PendulumState<double>& state = path.At(t, n);
      for (const Component& c : components) {
        const double value =
            c.state < 4 ? state.q[c.state] - self[n].posture[c.state - 2] : state.qd[c.state - 4];
        residuals[row] = c.scale * value;
        if (jacobians != nullptr) {
          by_column = c.scale * sensitivities.At(t, n).row(c.state);
          ScatterJacobian(by_column, sizes, row, num_residuals(), jacobians);
        }
        ++row;
      }
    }
  }
  return true;
}

}  // namespace pushid
