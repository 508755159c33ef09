// residuals: a whole recording against its rollout, frame by frame. Ceres sees these rows
// condensed, one residual block per recording (condensed_rollout.h).
//
//   residuals: FrameResidual (frame_residual.h) times `weight` for frames 1 .. horizon - 1, in
//              sigmas; ordered by frame, then person, then component.
//   blocks:    BlockLayout (parameter_map.h).
// Jacobian by forward sensitivities (rollout_sensitivities.h). Rejected: one block per frame, which
// would roll out the same recording once per frame.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "residuals/cost_functions/plate_residual.h"
#include "residuals/frame_residual.h"
#include "residuals/normal_equations.h"
#include "residuals/parameter_map.h"
#include "residuals/sensitivities/rollout_sensitivities.h"

namespace pushid {

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

// Of a recording's residuals. free_velocity: whether initial velocities are among the blocks.
BlockLayout LayoutOf(const PendulumRecording& recording, const ParameterMap& map,
                     bool free_velocity);

// Everything a rollout residual needs; shared by the analytic cost function and its oracle.
struct RolloutProblem {
  const PendulumRecording* recording = nullptr;  // must outlive the residual
  ModelOptions options;
  ParameterMap map;
  BlockLayout layout;
  ResidualSigmas sigmas;
  double weight = 1.0;  // on every residual of the recording
  int horizon = 0;      // frames rolled out, including frame 0

  // Of motion, then of platforms (plate_residual.h), frame by frame from frame 0 on, of those
  // people who have some.
  int num_residuals() const { return num_motion_rows() + num_plate_rows(); }
  int num_motion_rows() const { return (horizon - 1) * recording->num_people() * kFrameResiduals; }
  int num_plate_rows() const {
    return (horizon - 1) * static_cast<int>(PeopleOnPlates().size()) * kPlateResiduals;
  }
  std::vector<int> PeopleOnPlates() const {
    std::vector<int> people;
    for (int n = 0; n < recording->num_people(); ++n) {
      if (recording->HasPlates(n)) people.push_back(n);
    }
    return people;
  }
  MeasuredFrame Measured(int frame, int person) const {
    return {recording->hip[person][frame], recording->states[person][frame],
            recording->Weight(person, frame),
            RodMoves(options) ? recording->RodChange(person, frame) : 0.0};
  }
};

// horizon: at most that many frames; 0 means all.
std::shared_ptr<const RolloutProblem> MakeRolloutProblem(const PendulumRecording& recording,
                                                         const ModelOptions& options,
                                                         const ParameterMap& map,
                                                         const ResidualSigmas& sigmas,
                                                         double weight, int horizon);

// The inputs of a rollout at the given blocks, with its acting columns (parameter_map.h). The
// columns are NormalEquations::PaddedSize: what is beyond num_acting() is zero.
SensitivityInputs RolloutInputs(const Scene& scene, const ParameterMap& map,
                                const BlockLayout& layout, double const* const* blocks);

// Rows of one frame of one person by acting column, padded as RolloutInputs says.
using FrameRows = Eigen::Matrix<double, kFrameResiduals, Eigen::Dynamic, Eigen::RowMajor>;

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

enum class Derivatives {
  kNone,
  kHeldWeights,  // by all but the weights of what is learned
  kAll
};

// What Ceres asks of the blocks of a recording.
Derivatives WantedDerivatives(const RolloutProblem& problem, double** jacobians);

// The path at the given blocks; with derivatives, its sensitivities by the columns of *inputs,
// which kHeldWeights leaves the weights out of.
RolloutStatus RollOut(const RolloutProblem& problem, double const* const* blocks,
                      Derivatives derivatives, SensitivityInputs* inputs, RolloutPath<double>* path,
                      RolloutSensitivities* sensitivities);

using FrameVisitor = std::function<void(int frame, int person, const FrameVector<double>& residual,
                                        FrameRows* by_column)>;

using PlateRows = Eigen::Matrix<double, kPlateResiduals, Eigen::Dynamic, Eigen::RowMajor>;
using PlateVisitor = std::function<void(int frame, int person, const PlateVector<double>& residual,
                                        PlateRows* by_column)>;

// What is on hand of a rollout's residuals, frame by frame from frame 1 on, then person by person.
// The visitor may change the rows, which are there only with derivatives. plates: then those of
// platforms, in the same way from frame 0 on; null: nobody asks.
RolloutStatus VisitFrames(const RolloutProblem& problem, double const* const* blocks,
                          Derivatives derivatives, const FrameVisitor& visit,
                          const PlateVisitor& plates = nullptr);

// The residuals alone, problem.num_residuals() of them; false outside the model's domain.
bool RolloutResiduals(const RolloutProblem& problem, double const* const* blocks,
                      double* residuals);

// Of PeopleOnPlates, in this order.
template <typename OnPlates, typename Sets>
std::vector<OnPlates> BodiesOnPlates(const RolloutProblem& p, const Sets& parameters) {
  std::vector<OnPlates> bodies;
  for (int n : p.PeopleOnPlates()) {
    bodies.emplace_back(p.recording->scene, p.options, n, parameters[n]);
  }
  return bodies;
}

// Writes `jacobian` (rows x all columns) into the blocks that Ceres asks for.
void ScatterJacobian(const Eigen::Ref<const RowMajorMatrix>& jacobian,
                     const std::vector<int>& block_sizes, int first_row, int total_rows,
                     double** jacobians);

}  // namespace pushid
