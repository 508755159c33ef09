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

// The frame at which the first push begins, or the ground leaves its place; 0 where nothing
// happens.
int PushFrame(const PendulumRecording& recording);

// How much each part of a problem's cost weighs: what a fit estimates between two solves. Fields as
// those of FitOptions and ParameterSpec.
struct CostWeights {
  ResidualSigmas sigmas;
  double effective_weight = 0.0;
  double settling_weight = 0.0;
  std::vector<double> pooling_sigma;  // of every row of the table
};

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
  // By recording; no problem where it does not count, or fails in its first step.
  std::vector<RolloutAt> rollouts;
  std::shared_ptr<const std::vector<SideBySide>> side_by_side =
      std::make_shared<const std::vector<SideBySide>>();  // of these, those with lanes
  std::vector<double*> parameter_blocks;                  // in the order of FitPoint::Flat
  std::vector<FailedRollout> shortened;
  // By recording: its cost less this is its negative log likelihood, up to a constant that no
  // point changes (residuals/cost_functions/likelihood_residual.h): only so do costs of problems
  // built at different points compare. Empty for rollouts.
  std::map<int, double> offsets;
  double OffsetOf(int recording) const {
    const auto found = offsets.find(recording);
    return found == offsets.end() ? 0.0 : found->second;
  }
  double Offset() const {
    double sum = 0.0;
    for (const auto& [recording, offset] : offsets) sum += offset;
    return sum;
  }
  int rests_left_out = 0;  // settling simulations that could not be rolled out to their end here

  void Add(std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& on, int cluster);
  // As Add, for a cost that rolls out: evaluated once a point, over threads where there are any.
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

  // Its priors and demands alone.
  FitProblem WithoutRecordings() const;

  CostWeights weights() const;
  // Points of the problem stay points of it.
  void SetWeights(const CostWeights& weights);
  void set_settling_weight(double weight) { options_.settling_weight = weight; }
  void set_function_tolerance(double tolerance) { options_.function_tolerance = tolerance; }
  void set_max_iterations(int most) { options_.max_iterations = most; }
  void set_gradient_tolerance(double tolerance) { options_.gradient_tolerance = tolerance; }

  const ParameterMap& map() const { return map_; }
  // The table's row of a fitted parameter.
  const ParameterSpec& Spec(size_t fitted) const {
    return options_.table[map_.fitted[fitted].parameter];
  }
  // Where a parameter stands among the fitted ones; as many as these are where it is held.
  size_t FittedIndex(Parameter id) const;
  // As the model sees them: in axes along their pushes, where it is the same in all directions.
  const std::vector<PendulumRecording>& recordings() const { return *recordings_; }
  const FitOptions& options() const { return options_; }
  // Frames of a recording that a horizon means: so many from its first push on, since before it
  // nothing is learned; 0: all.
  int Frames(int recording, int horizon) const {
    return horizon == 0 ? 0 : horizon + PushFrame(recordings()[recording]);
  }
  // The factor on a recording's residuals, rolled out over `horizon` frames (0: all).
  double Weight(int recording, int horizon) const;
  const std::vector<int>& counts() const { return counts_; }  // empty: each once
  int Count(int recording) const { return counts_.empty() ? 1 : counts_[recording]; }

  // Shared values at the table's nominal values, deviations where the options start them,
  // velocities as the scenes hold them, weights as the options' network holds them.
  FitPoint NominalPoint() const;

  // The point whose Flat() is `row`, weights excepted where it has none; none where sizes differ.
  std::optional<FitPoint> PointAt(std::vector<double> row) const;

  // The parameters of a unit (any name, even one that was not fitted) at a point.
  ParameterSet<double> Parameters(const FitPoint& point, const std::string& unit) const;
  // The fitted parameters without deviations, in natural units.
  std::vector<double> SharedValues(const FitPoint& point) const;

  // The options with the network of a point.
  ModelOptions ModelAt(const FitPoint& point) const;

  // Units whose settling is simulated: the shared parameters (""), and each setting or
  // condition where these differ in what acts then.
  std::vector<std::string> SettlingUnits(const FitPoint& point) const;

  // What people do after a push at a point; where settings or conditions differ, in each.
  Behaviour BehaviourAt(const FitPoint& point) const;

  // Recordings whose rollout over `horizon` frames (0: all) leaves the domain at a point; none
  // where the likelihood needs no rollout.
  std::vector<FailedRollout> Failures(const FitPoint& point, int horizon) const;

  // The deviance of all recordings, as they count, by a likelihood of single steps.
  Deviance DevianceAt(const FitPoint& point) const;

  // How many residuals of a recording are of motion; those of platforms follow.
  size_t NumMotionRows(int recording) const;

  // Clusters of what is not data.
  static constexpr int kPriorCluster = -1;     // priors on parameters
  static constexpr int kPoolingCluster = -2;   // what ties the units' deviations to zero
  static constexpr int kSettlingCluster = -3;  // the demand that people settle
  static constexpr int kNetworkCluster = -4;   // what ties a network's weights to zero

  // By how much the logarithm of the noise may fall in a solve before its rows end
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
  void AddParameterBlocks(FitPoint* point, int num_threads, Built* built) const;
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
// By the EM algorithm (Dempster, Laird and Rubin 1977; Laird and Ware 1982):
//   s^2 <- mean over the n units of (E[d_u]^2 + Var[d_u])
// with mean and variance under the data, the other priors and the last s. Its fixed point is
//   s^2 = sum of E[d_u]^2 / sum of (1 - Var[d_u] / s^2)
// and that is what is iterated (MacKay 1992): near no spread EM takes hundreds of steps.
//
// The posterior is taken as normal: cost and J'J at the point (Laplace). With two units, s is known
// to a factor of about two either way; it says how much a unit may differ, no more.

// Bounds of s, in ParameterSpec::pooling_sigma's units: 1 % and a factor of twenty.
inline constexpr double kLeastPoolingSigma = 0.01, kLargestPoolingSigma = 3.0;

// Sets the weights' pooling_sigma of every pooled parameter to the s that the units tell of at a
// point (best the optimum of the cost as the problem weighs it). Returns the largest relative
// change: solve and update until it is small.
double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, CostWeights* weights);

// What a fit minimizes, family by family: each row says when a family is part of the cost
// and adds its residual blocks (residuals/cost_functions/) to the Ceres problem.
//
// A new family is a row of the table in fit_problem.cc with the two functions that it names,
// its cost function in a file of its own, and an option for its weight
// (ident/parameters/option_table.cc). Solver, covariance, profiles and bootstrap take it from here.

// Where a family adds blocks.
struct FamilyPlace {
  const FitProblem& problem;
  FitPoint* point;
  FitProblem::Built* built;
  int recording = -1;     // of a family of recordings
  std::string unit = {};  // of a family of units; empty: the shared parameters

  // The recording's rollout while it stays within the domain; no problem: not even one frame.
  const RolloutAt& rollout() const { return built->rollouts[recording]; }
};

struct ResidualFamily {
  enum Per {
    kRecording,  // added for each recording that counts
    kPoint,      // once
    kUnit        // for each unit whose settling is simulated (FitProblem::SettlingUnits)
  };
  const char* name;
  Per per;
  int cluster;  // of its rows, one of FitProblem's; of recordings: their index
  bool (*on)(const FitOptions& options, int horizon);
  void (*add)(const ResidualFamily& family, const FamilyPlace& place);
};

// All of them, in the order of their blocks.
const std::vector<ResidualFamily>& ResidualFamilies();

}  // namespace pushid
