// residuals: settling and stability by forward sensitivities.
#include "residuals/cost_functions/rest_residual.h"

#include <algorithm>
#include <cmath>

#include "residuals/cost_functions/rollout_residual.h"

namespace pushid {
namespace {

constexpr double kWatched = 1.0;  // s, of settled people
constexpr double kMet = 0.9;      // of what counts as settled: where the hinge begins

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

RestResidual::RestResidual(RestProblem problem, int rows)
    : problem_(std::move(problem)), rows_(rows) {
  for (int size : problem_.layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals((problem_.last_frame - problem_.first_frame) * problem_.scene.num_people() *
                    rows_);
}

bool RestResidual::Evaluate(double const* const* blocks, double* residuals,
                            double** jacobians) const {
  const RestProblem& p = problem_;
  const SensitivityInputs inputs = RolloutInputs(p.scene, p.map, p.layout, blocks);
  RolloutPath<double> path;
  if (!Rollout<double>(p.scene, p.options, inputs.parameters, inputs.initial_velocity, p.last_frame,
                       &path, nullptr, inputs.network_weights)
           .ok) {
    return false;
  }
  const std::vector<SelfForce> self = SelfForces(p.scene, p.options);
  const double scale = p.Scale();
  struct Slope {
    int frame, person, row;
    RestRows by_state;
  };
  std::vector<Slope> slopes;  // where there are any
  RestRows by_state(rows_, 8);
  int row = 0;
  for (int t = p.first_frame; t < p.last_frame; ++t) {
    for (int n = 0; n < p.scene.num_people(); ++n, row += rows_) {
      OfState(path.At(t, n), self[n], residuals + row, jacobians != nullptr ? &by_state : nullptr);
      for (int k = 0; k < rows_; ++k) residuals[row + k] *= scale;
      if (jacobians == nullptr || by_state.isZero(0.0)) continue;
      slopes.push_back({t, n, row, by_state});
    }
  }
  if (jacobians == nullptr) return true;
  for (size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    if (jacobians[b] == nullptr) continue;
    std::fill_n(jacobians[b], num_residuals() * parameter_block_sizes()[b], 0.0);
  }
  if (slopes.empty()) return true;
  RolloutSensitivities sensitivities;
  if (!RolloutWithSensitivities(p.scene, p.options, inputs, slopes.back().frame + 1, &path,
                                &sensitivities)
           .ok) {
    return false;
  }
  const ActingColumns columns(p.layout);
  RowMajorMatrix by_column;
  for (const Slope& slope : slopes) {
    by_column = scale * slope.by_state * sensitivities.At(slope.frame, slope.person);
    columns.Scatter(by_column, slope.row, num_residuals(), jacobians);
  }
  return true;
}

void SettlingResidual::OfState(const PendulumState<double>& state, const SelfForce& self,
                               double* residuals, RestRows* by_state) const {
  Eigen::Matrix<double, 1, 2> by_velocity;
  Eigen::Matrix<double, 1, 1> by_angle[2];
  residuals[0] = Hinge<2>(state.qd.head<2>(), kMet * kSettledSpeed, &by_velocity);
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Matrix<double, 1, 1> lean(state.q[2 + axis] - self.posture[axis]);
    residuals[1 + axis] = Hinge<1>(lean, kMet * kSettledLean, &by_angle[axis]);
  }
  if (by_state == nullptr) return;
  by_state->setZero();
  by_state->block<1, 2>(0, 4) = by_velocity;
  for (int axis = 0; axis < 2; ++axis) (*by_state)(1 + axis, 2 + axis) = by_angle[axis](0);
}

void StabilityResidual::OfState(const PendulumState<double>& state, const SelfForce& self,
                                double* residuals, RestRows* by_state) const {
  const ResidualSigmas& sigmas = problem_.sigmas;
  if (by_state != nullptr) by_state->setZero();
  for (int axis = 0; axis < 2; ++axis) {
    residuals[axis] = (state.q[2 + axis] - self.posture[axis]) / sigmas.angle;
    residuals[2 + axis] = state.qd[2 + axis] / sigmas.rate;
    if (by_state == nullptr) continue;
    (*by_state)(axis, 2 + axis) = 1.0 / sigmas.angle;
    (*by_state)(2 + axis, 6 + axis) = 1.0 / sigmas.rate;
  }
}

}  // namespace pushid
