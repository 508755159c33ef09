// residuals: a whole recording against its rollout: the residual of every fit.
//
//   s(t+1) = s(t) + dt f(s(t), push(t); p)       models/rollout.h, from frame 0 on
//   r      = weight * FrameResidual(s(t))        hip, velocity, angles, rates less the measured
//            / sigma                             ones, in sigmas (frame_residual.h)
//
//   residuals: nine a frame and person, for frames 1 .. horizon - 1, ordered by frame, then person,
//              then component; behind them four a frame of each person on force platforms, from
//              frame 0 on (plate_residual.h).
//   blocks:    0        shared parameters, on the fitted scale (log, logit or as they are)
//              1 .. S   deviations of each unit; where parameters are pooled
//              next     initial velocities; where they are free
//              last     weights of what is learned; where there is any   (parameter_map.h)
// False outside the model's domain: a pendulum that lies down, a rod that tears.
//
// A functor as Ceres' own: it serves ceres::DynamicAutoDiffCostFunction as it stands,
//   ceres::DynamicAutoDiffCostFunction<RolloutResidual, 8> cost(new RolloutResidual{problem});
//   for (int size : problem->layout.BlockSizes()) cost.AddParameterBlock(size);
//   cost.SetNumResiduals(problem->num_residuals());
// and AutoDiffRollout (jets/autodiff_rollout.h) differentiates the same lines by jets that allocate
// nothing. A fit condenses the rows of a recording to as many as it has columns
// (cost_functions/condensed_rollout.h). Rejected: one block per frame, which would roll out the
// same recording once per frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "models/rollout.h"
#include "residuals/frame_residual.h"
#include "residuals/normal_equations.h"
#include "residuals/parameter_map.h"
#include "residuals/plate_residual.h"

namespace pushid {

inline MeasuredFrame MeasuredAt(const PendulumRecording& r, int frame, int person, bool rod_moves) {
  return {r.hip[person][frame], r.states[person][frame], r.Weight(person, frame),
          rod_moves ? r.RodChange(person, frame) : 0.0};
}

// Everything a rollout residual needs.
struct RolloutProblem {
  const PendulumRecording* recording = nullptr;  // must outlive the residual
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  ResidualSigmas sigmas;
  double weight = 1.0;  // on every residual of the recording
  int horizon = 0;      // frames rolled out, including frame 0
  DerivativesBy derivatives = DerivativesBy::kAuto;

  int num_residuals() const { return num_motion_rows() + num_plate_rows(); }
  int num_motion_rows() const { return (horizon - 1) * recording->num_people() * kFrameResiduals; }
  int num_plate_rows() const;
  std::vector<int> PeopleOnPlates() const;
  MeasuredFrame Measured(int frame, int person) const {
    return MeasuredAt(*recording, frame, person, RodMoves(options));
  }
};

// horizon: at most that many frames; 0 means all.
std::shared_ptr<const RolloutProblem> MakeRolloutProblem(
    const PendulumRecording& recording, const ModelOptions& options, const ParameterMap& map,
    const ResidualSigmas& sigmas, double weight, int horizon,
    DerivativesBy derivatives = DerivativesBy::kAuto);

struct RolloutResidual {
  std::shared_ptr<const RolloutProblem> problem;

  template <typename T>
  bool operator()(T const* const* blocks, T* residuals) const {
    return At(*problem, blocks, residuals).ok;
  }

  template <typename T>
  static RolloutStatus At(const RolloutProblem& p, T const* const* blocks, T* residuals) {
    std::vector<Vector4<T>> velocity;
    const T* const free = p.layout.VelocityBlock(blocks);
    for (int n = 0; n < p.recording->num_people(); ++n) {
      const Vector4<double>& start = p.recording->scene.people[n].start.qd;
      velocity.push_back(free != nullptr ? Vector4<T>(Eigen::Map<const Vector4<T>>(free + 4 * n))
                                         : Vector4<T>(start.cast<T>()));
    }
    return Rows<T>(p, p.layout.Parameters<T>(p.map, blocks), velocity, p.layout.WeightBlock(blocks),
                   residuals);
  }

  // parameters, velocity: one entry per person; weights: null for those of the options.
  template <typename T>
  static RolloutStatus Rows(const RolloutProblem& p, const std::vector<ParameterSet<T>>& parameters,
                            const std::vector<Vector4<T>>& velocity, const T* weights,
                            T* residuals) {
    const Scene& scene = p.recording->scene;
    thread_local RolloutPath<T> path;  // used again: asking the system for it takes a tenth
    const RolloutStatus status =
        Rollout<T>(scene, p.options, parameters, velocity, p.horizon, &path, nullptr, weights);
    if (!status.ok) return status;
    for (int t = 1; t < p.horizon; ++t) {
      for (int n = 0; n < scene.num_people(); ++n, residuals += kFrameResiduals) {
        const PendulumState<T>& state = path.At(t, n);
        const Body& body = scene.people[n].body;
        Eigen::Map<FrameVector<T>> r(residuals);
        r = T(p.weight) *
            (RodMoves(p.options)
                 ? FrameResidual<T>(BodyNow(body, state.rod), state, p.Measured(t, n), p.sigmas)
                 : FrameResidual<T>(body, state, p.Measured(t, n), p.sigmas));
      }
    }
    const std::vector<int> on_plates = p.PeopleOnPlates();
    std::vector<BodyOnPlates<T>> bodies;
    for (int n : on_plates) bodies.emplace_back(scene, p.options, n, parameters[n]);
    for (int t = 0; t + 1 < p.horizon; ++t) {
      for (size_t k = 0; k < on_plates.size(); ++k, residuals += kPlateResiduals) {
        const int n = on_plates[k];
        Eigen::Map<PlateVector<T>> r(residuals);
        r = T(p.weight) * PlateResidual<T>({&scene, &p.options, n, t}, bodies[k], parameters[n],
                                           path.At(t, n), path.At(t + 1, n).qd,
                                           p.recording->plates[n][t], p.sigmas);
      }
    }
    return status;
  }
};

// Inputs of a rollout at a point, and the columns by which it is differentiated.
struct SensitivityInputs {
  std::vector<ParameterSet<double>> parameters;   // one entry per person
  std::vector<Vector4<double>> initial_velocity;  // likewise
  std::vector<std::vector<ColumnEntry>> entries;  // likewise
  int num_columns = 0;                      // NormalEquations::PaddedSize; zero beyond the last
  int velocity_column = -1;                 // first of 4 * people columns; negative when not fitted
  const double* network_weights = nullptr;  // all of options.learned, instead of its own
  int weight_column = -1;                   // of the first of them; negative when not fitted
};

// The inputs at the given blocks, by the acting columns of a layout (parameter_map.h).
SensitivityInputs RolloutInputs(const Scene& scene, const ParameterMap& map,
                                const BlockLayout& layout, double const* const* blocks);

// The path at the given blocks.
RolloutStatus RollOut(const RolloutProblem& problem, double const* const* blocks,
                      RolloutPath<double>* path);
// The residuals alone, problem.num_residuals() of them; false outside the model's domain.
bool RolloutResiduals(const RolloutProblem& problem, double const* const* blocks,
                      double* residuals);

// Parts of a problem.

// The unit of each person, by which pooled parameters differ.
std::vector<std::string> PoolingUnits(const PendulumRecording& recording,
                                      const std::string& pool_by);

// Each person's value of each covariate, as it moves parameters: 0 where it is not known. Empty
// where there are no covariates.
std::vector<std::vector<double>> CovariatesOf(const PendulumRecording& recording,
                                              const std::vector<Covariate>& covariates);
// A person's own number or label, of which a covariate is made; none where it is not known.
std::optional<double> NumberOf(const PendulumRecording& recording, int person,
                               const std::string& key);
std::string LabelOf(const PendulumRecording& recording, int person, const std::string& key);

// Layout of a recording's blocks. free_velocity: whether initial velocities are among them.
BlockLayout LayoutOf(const PendulumRecording& recording, const ParameterMap& map,
                     bool free_velocity);

// From acting columns to those of the blocks, into the blocks that Ceres asks for.
class ActingColumns {
 public:
  explicit ActingColumns(const BlockLayout& layout)
      : block_sizes_(layout.BlockSizes()), of_column_(layout.ActingOfColumns()) {}

  RowMajorMatrix Expand(const Eigen::Ref<const RowMajorMatrix>& by_acting) const;
  // by_acting: at least the acting columns of the blocks that are asked for.
  void Scatter(const Eigen::Ref<const RowMajorMatrix>& by_acting, int first_row, int total_rows,
               double** jacobians) const;

 private:
  std::vector<int> block_sizes_;
  std::vector<std::pair<int, int>> of_column_;
};

}  // namespace pushid
