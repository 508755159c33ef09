// ident: the cost of what was held out, iteration by iteration, and the way to large networks.
#include "ident/solver/network_training.h"

#include <cmath>
#include <limits>

#include "datasets/files/number_text.h"
#include "ident/problem/folds.h"

namespace pushid {
namespace {

constexpr int kPatience = 10;  // iterations without a better one

}  // namespace

Result<EarlyStoppingSplit> SplitForEarlyStopping(const FitProblem& problem, double share,
                                                 uint64_t seed) {
  const std::vector<PendulumRecording>& recordings = problem.recordings();
  const int total = static_cast<int>(recordings.size());
  const int folds = static_cast<int>(std::lround(1.0 / share));
  if (folds < 2 || folds > total) {
    return Error{"--early_stopping=" + DoubleText(share) + " of " + std::to_string(total) +
                 " recordings holds out none or all of them; a share from " +
                 DoubleText(1.0 / total) + " to 0.5 leaves some on both sides"};
  }
  const Result<std::vector<Fold>> made =
      MakeFolds(recordings, FoldScheme::kStratified, folds, 1, seed);
  if (!made.ok()) return made.error();
  EarlyStoppingSplit split{std::vector<int>(total), std::vector<int>(total)};
  for (int i = 0; i < total; ++i) split.training[i] = problem.Count(i);
  for (int i : made.value().front().held_out) std::swap(split.training[i], split.held_out[i]);
  return split;
}

EarlyStopping::EarlyStopping(const FitProblem& held_out, const FitPoint* point)
    : held_out_(held_out),
      point_(point),
      best_(*point),
      best_cost_(std::numeric_limits<double>::infinity()) {}

ceres::CallbackReturnType EarlyStopping::operator()(const ceres::IterationSummary& summary) {
  if (!summary.step_is_successful) return ceres::SOLVER_CONTINUE;
  const double cost = held_out_.DataCost(*point_);
  if (cost < best_cost_) {
    best_cost_ = cost;
    best_ = *point_;
    since_best_ = 0;
    return ceres::SOLVER_CONTINUE;
  }
  stopped_ = ++since_best_ >= kPatience;
  return stopped_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
}

FitOptions PhysicsAlone(FitOptions options) {
  const ModelOptions whole = options.model;
  options.model.learned = nullptr;
  options.model.interaction.learned = false;
  options.early_stopping = 0.0;  // physics does not learn by heart
  for (ParameterSpec& spec : options.table.specs) {
    const bool of_network = Acts(spec.id, whole) && !Acts(spec.id, options.model);
    if (of_network) spec.free = spec.pooled = false;
  }
  return options;
}

LargeNetworkTrainer& LargeNetworkTraining() {
  static LargeNetworkTrainer trainer = nullptr;
  return trainer;
}

Result<FitOptions> TrainLargeNetwork(const std::vector<PendulumRecording>& recordings,
                                     const FitOptions& options, const FittedPhysics& physics,
                                     const SolveProgress& progress) {
  if (LargeNetworkTraining() != nullptr) {
    return LargeNetworkTraining()(recordings, options, physics, progress);
  }
  return Error{"this program trains no large networks: it is built without pushid_large_networks"};
}

}  // namespace pushid
