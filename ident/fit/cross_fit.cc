// ident: refits without folds.
#include <algorithm>
#include <utility>

#include "ident/fit/fit.h"
#include "ident/model/push_range.h"
#include "ident/observed/recording_filter.h"
#include "ident/problem/folds.h"
#include "ident/problem/parallel.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {
namespace {

constexpr size_t kFolds = 4, kFewestUnits = 3;
// Of the cost: what more would bring is little beside what people differ by.
constexpr double kFoldTolerance = 1e-5;

std::vector<std::vector<int>> FoldsOf(const FitProblem& problem) {
  std::vector<std::vector<int>> units =
      MakeResamplingUnits(problem.recordings(), ClusterBy::kAuto).units;
  if (units.size() < kFewestUnits) {
    units.clear();
    for (size_t i = 0; i < problem.recordings().size(); ++i) units.push_back({static_cast<int>(i)});
  }
  std::vector<std::vector<int>> folds;
  if (units.size() < kFewestUnits) return folds;
  folds.resize(std::min(kFolds, units.size()));
  for (size_t u = 0; u < units.size(); ++u) {
    std::vector<int>& fold = folds[u % folds.size()];
    fold.insert(fold.end(), units[u].begin(), units[u].end());
  }
  return folds;
}

}  // namespace

std::optional<IdentifiedModel> RefitWithout(const FitProblem& problem, const FitPoint& optimum,
                                            const IdentifiedModel& model,
                                            const std::vector<int>& held_out) {
  FitOptions options = problem.options();
  options.num_threads = 1;
  options.function_tolerance = std::max(kFoldTolerance, options.function_tolerance);
  std::vector<int> counts(problem.recordings().size(), 1);
  for (int i : held_out) counts[i] = 0;
  const FitProblem others(problem.recordings(), options, counts);
  const SolveStart fit = Refit(others, optimum);
  if (!fit.usable) return std::nullopt;
  IdentifiedModel refitted = model;
  refitted.options = others.ModelAt(fit.to);
  refitted.parameters = others.Parameters(fit.to, "");
  for (auto& [unit, parameters] : refitted.by_unit) parameters = others.Parameters(fit.to, unit);
  refitted.push_range.reset();
  refitted.push_range = FittedPushRange(refitted, Without(problem.recordings(), held_out));
  return refitted;
}

std::vector<FoldModel> CrossFit(const FitProblem& problem, const FitPoint& optimum,
                                const IdentifiedModel& model, int num_threads) {
  if (NeedsGradientTraining(problem.options())) return {};
  const std::vector<std::vector<int>> held_out = FoldsOf(problem);
  std::vector<std::optional<FoldModel>> made(held_out.size());
  ParallelFor(static_cast<int>(held_out.size()), num_threads, [&](int f) {
    std::optional<IdentifiedModel> refitted = RefitWithout(problem, optimum, model, held_out[f]);
    if (!refitted) return;
    refitted->recording_effect =
        FitRecordingEffect(*refitted, Without(problem.recordings(), held_out[f]));
    if (refitted->recording_effect) made[f].emplace(FoldModel{*std::move(refitted), held_out[f]});
  });
  std::vector<FoldModel> folds;
  for (std::optional<FoldModel>& fold : made) {
    if (fold) folds.push_back(*std::move(fold));
  }
  return folds;
}

std::optional<ForecastRule> CrossFitForecasts(const FitProblem& problem, const FitPoint& optimum,
                                              const IdentifiedModel& model,
                                              const std::vector<PendulumRecording>& recordings,
                                              int num_threads) {
  return LearnForecasts(model, recordings, CrossFit(problem, optimum, model, num_threads),
                        num_threads);
}

}  // namespace pushid
