// ident: the nonlinear least-squares problem of a fit: its parameter blocks and its residual
// blocks.
#pragma once

#include <ceres/problem.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_point.h"
#include "ident/problem/parallel_evaluation.h"
#include "models/rollout.h"
#include "residuals/cost_functions/likelihood_residual.h"
#include "residuals/rollout_residual.h"

namespace pushid {

// The first frame of a push, or at which the ground leaves its place; 0 where nothing happens.
int PushFrame(const PendulumRecording& recording);

// A Ceres problem over *point (which must outlive it). Recordings that fail at the point are held
// to the frames before their failure; `shortened` names them.
struct BuiltProblem {
  std::unique_ptr<ParallelEvaluation> evaluation;
  std::unique_ptr<ceres::Problem> problem;
  // cluster: the recording that the block belongs to, or FitProblem::kPriorCluster and the like;
  // cost: what was added, which the problem may hold inside another (parallel_evaluation.h).
  struct Block {
    ceres::ResidualBlockId id;
    int cluster;
    const ceres::CostFunction* cost;
  };
  std::vector<Block> blocks;
  // Rollouts by recording; no problem where it does not count, or fails in its first step.
  std::vector<RolloutAt> rollouts;
  std::shared_ptr<const std::vector<SideBySide>> side_by_side =
      std::make_shared<const std::vector<SideBySide>>();  // the rollouts with lanes
  std::vector<double*> parameter_blocks;                  // in the order of FitPoint::Flat
  std::vector<FailedRollout> shortened;
  // Offsets by recording: its cost less this is its negative log likelihood, up to a constant that
  // no point changes (residuals/cost_functions/likelihood_residual.h): only so do costs of problems
  // built at different points compare. Empty for rollouts.
  std::map<int, double> offsets;
  double Offset() const {
    double sum = 0.0;
    for (const auto& [recording, offset] : offsets) sum += offset;
    return sum;
  }
  int rests_left_out = 0;  // settling simulations that could not be rolled out to their end here

  void Add(std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& on, int cluster);
  // Adds a cost that rolls out: evaluated once a point, over threads where there are any.
  void AddRollout(std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& on,
                  int cluster);
};

class FitProblem {
 public:
  // recordings must outlive the problem. counts: how often each recording counts (a bootstrap
  // replica; 0 leaves it out); empty: each once. Copies of a recording under other ids
  // (datasets/inspection/findings.h) never count: they tell nothing new.
  FitProblem(const std::vector<PendulumRecording>& recordings, FitOptions options,
             std::vector<int> counts = {});

  // The problem of the priors and demands alone.
  FitProblem WithoutRecordings() const;

  const FitOptions& options() const { return options_; }
  // Nothing may change but weights, nothing that points or recordings depend on.
  void SetWeights(const FitOptions& weights) {
    layouts_ = std::make_shared<Layouts>();
    options_ = weights;
  }
  // Tolerances, iterations, and the weight of the demand to settle alone may change.
  FitOptions* mutable_options() { return &options_; }
  const ParameterMap& map() const { return map_; }
  // The table's row of a fitted parameter.
  const ParameterSpec& Spec(size_t fitted) const {
    return options_.table[map_.fitted[fitted].parameter];
  }
  // Its lower and upper bound, on the fitted scale.
  std::pair<double, double> Bounds(size_t fitted) const;
  // The index of a parameter among the fitted ones; their number if it is held.
  size_t FittedIndex(Parameter id) const;
  // The recordings as the model sees them: in axes along their pushes, where it is the same in all
  // directions.
  const std::vector<PendulumRecording>& recordings() const { return *recordings_; }
  // The frames of a recording in a horizon: so many from its first push on, since before it nothing
  // is learned; 0: all.
  int Frames(int recording, int horizon) const {
    return horizon == 0 ? 0 : horizon + PushFrame(recordings()[recording]);
  }
  // The factor on a recording's residuals, rolled out over `horizon` frames (0: all).
  double Weight(int recording, int horizon) const;
  const std::vector<int>& counts() const { return counts_; }  // empty: each once
  int Count(int recording) const { return counts_.empty() ? 1 : counts_[recording]; }

  // The table's nominal values, no deviations, and velocities and weights where scenes and networks
  // start them.
  FitPoint NominalPoint() const;

  // The point whose Flat() is `row`, weights excepted where it has none; none where sizes differ.
  std::optional<FitPoint> PointAt(std::vector<double> row) const;

  // The parameters of a unit (any name, even one that was not fitted) at a point.
  ParameterSet<double> Parameters(const FitPoint& point, const std::string& unit) const;
  // The fitted parameters without deviations, in natural units.
  std::vector<double> SharedValues(const FitPoint& point) const;

  // The options with the network of a point.
  ModelOptions ModelAt(const FitPoint& point) const;

  // Units whose settling is simulated: the shared parameters (""), and each setting or condition
  // where these differ in what acts then.
  std::vector<std::string> SettlingUnits(const FitPoint& point) const;

  // The behaviour after a push at a point, in each setting or condition if they differ.
  Behaviour BehaviourAt(const FitPoint& point) const;

  // Recordings whose rollout over `horizon` frames (0: all) leaves the domain at a point; none
  // where the likelihood needs no rollout.
  std::vector<FailedRollout> Failures(const FitPoint& point, int horizon) const;

  // The deviance of all recordings, as they count, by a likelihood of single steps.
  Deviance DevianceAt(const FitPoint& point) const;

  // Residuals of a recording's motion; those of platforms follow.
  size_t NumMotionRows(int recording) const;

  // Clusters of rows that are no data: priors on parameters; ties of the units' deviations, and of
  // a network's weights, to zero; the demand that people settle.
  static constexpr int kPriorCluster = -1, kPoolingCluster = -2, kSettlingCluster = -3,
                       kNetworkCluster = -4;

  // The fall of the noise's logarithm in a solve that ends its rows
  // (residuals/cost_functions/likelihood_residual.h): kFisherShift, where J'J is the Fisher
  // information, or more far from the optimum.
  void set_fall_of_noise(double logarithm) { fall_of_noise_ = logarithm; }
  double fall_of_noise() const { return fall_of_noise_; }

  // The parameter blocks of a recording's residuals.
  std::vector<double*> RecordingBlocks(FitPoint* point, int recording) const;
  LikelihoodProblem LikelihoodOf(int recording, double weight) const;

  using Built = BuiltProblem;
  // hold_network: its weights are constant. num_threads: of the evaluations; the same bits for any.
  // all_inside: it is known already that no recording fails at the point.
  Built Build(FitPoint* point, int horizon, bool hold_network = false, int num_threads = 1,
              bool all_inside = false) const;

 private:
  // The rollouts of all recordings over `horizon` frames, and those with lanes side by side: the
  // same at every point, until weights or counts change.
  struct LaidOut {
    std::vector<RolloutAt> rollouts;  // by recording, nowhere yet; no problem: it does not count
    std::vector<SideBySide> side_by_side;
  };
  // Kept for the copies of a problem as well, in any thread.
  struct Layouts {
    std::mutex mutex;
    std::map<int, std::shared_ptr<const LaidOut>> by_horizon;
  };
  std::shared_ptr<const LaidOut> LayOut(int horizon) const;
  // The laid out rollouts at a point.
  std::vector<RolloutAt> Rollouts(const LaidOut& laid_out, FitPoint* point) const;
  std::vector<double*> BlocksOf(FitPoint* point, int recording, const BlockLayout& layout) const;

  std::shared_ptr<const std::vector<PendulumRecording>>
      turned_;  // null where the file's axes serve
  const std::vector<PendulumRecording>* recordings_;
  FitOptions options_;
  std::vector<int> counts_;
  ParameterMap map_;
  double fall_of_noise_ = kFisherShift;
  std::shared_ptr<Layouts> layouts_ = std::make_shared<Layouts>();
};

// How far units differ, estimated from the units.
//
// A pooled parameter of unit u is shared + d_u with d_u ~ N(0, s^2). s maximizes the marginal
// likelihood of the data, in which the deviations and the shared values are integrated out
// (empirical Bayes; restricted maximum likelihood, as the shared values are integrated out too).
// The EM algorithm (Dempster, Laird and Rubin 1977; Laird and Ware 1982) has
//   s^2 <- mean over the n units of (E[d_u]^2 + Var[d_u])
// with mean and variance under the data, the other priors and the last s. Its fixed point is
//   s^2 = sum of E[d_u]^2 / sum of (1 - Var[d_u] / s^2)
// and that is what is iterated (MacKay 1992): near no spread EM takes hundreds of steps.
//
// The posterior is taken as normal: cost and J'J at the point (Laplace). With two units, s is known
// to a factor of about two either way; it says how much a unit may differ, no more.

// Bounds of s, in ParameterSpec::pooling_sigma's units: 1 % and a factor of twenty.
inline constexpr double kLeastPoolingSigma = 0.01, kLargestPoolingSigma = 3.0;

// Sets the pooling_sigma of every pooled parameter to the s that the units tell of at a
// point (best the optimum of the cost as the problem weighs it). Returns the largest relative
// change: solve and update until it is small.
double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, FitOptions* weights);

}  // namespace pushid
