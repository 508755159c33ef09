// Fits without folds: what is held out teaches them nothing.

#include <gtest/gtest.h>

#include <cmath>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/observed/recording_filter.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

SyntheticOptions DifferingPeople() {
  SyntheticOptions study = SmallStudy();
  study.subjects = 4;
  study.recordings_per_subject = 4;
  study.subject_spread = 0.2;
  study.joint_noise_m = 0.001;
  return study;
}

// Folds of a problem, from a point that is given.
std::vector<FoldModel> FoldsOfProblem(const std::vector<PendulumRecording>& recordings,
                                      const FitOptions& options, const FitPoint& from) {
  const FitProblem problem(recordings, options);
  IdentifiedModel model;
  model.options = options.model;
  model.table = options.table;
  model.parameters = problem.Parameters(from, "");
  return CrossFit(problem, from, model, 2);
}

TEST(CrossFit, LooksAtNothingHeldOut) {
  const SyntheticOptions study = DifferingPeople();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = UnbiasedFit(study);
  const FitProblem problem(recordings, options);
  const SolveStart start = SolveFrom(problem, problem.NominalPoint(), "nominal", "", nullptr);
  ASSERT_TRUE(start.usable);
  const std::vector<FoldModel> folds = FoldsOfProblem(recordings, options, start.to);
  ASSERT_EQ(folds.size(), 4u);
  std::vector<int> times(recordings.size(), 0);
  for (const FoldModel& fold : folds) {
    std::vector<PendulumRecording> changed = recordings;
    for (int i : fold.held_out) {
      ++times[i];
      // One person is held out, with all recordings.
      EXPECT_EQ(recordings[i].subject_ids, recordings[fold.held_out[0]].subject_ids);
      for (PendulumState<double>& state : changed[i].states[0]) state.q[0] *= 0.7;
      for (Vector3<double>& hip : changed[i].hip[0]) hip[0] *= 0.7;
    }
    for (const FoldModel& again : FoldsOfProblem(changed, options, start.to)) {
      if (again.held_out != fold.held_out) continue;
      for (int p = 0; p < kNumParameters; ++p) {
        EXPECT_EQ(again.model.parameters[p], fold.model.parameters[p]) << kParameterNames[p];
      }
    }
  }
  EXPECT_EQ(times, std::vector<int>(recordings.size(), 1));
}

FitResult FitAndLearn(const std::vector<PendulumRecording>& recordings, const FitOptions& options) {
  FittedModel model;
  model.fit = Fit(recordings, options);
  EXPECT_FALSE(AddForecasts(recordings, 1, &model));
  return model.fit;
}

// Recordings that a model was fitted to are forecast better by it than those that were held out,
// and scores say the latter.
TEST(CrossFit, ScoresAreThoseOfOthers) {
  SyntheticOptions study = DifferingPeople();
  study.subject_spread = 0.3;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitResult result = FitAndLearn(recordings, UnbiasedFit(study));
  ASSERT_TRUE(result.forecasts.has_value());
  EXPECT_EQ(result.forecasts->folds, 4);
  EXPECT_EQ(result.forecasts->recordings, 16);
  const auto of_itself = LearnForecasts(ModelOf(result), recordings, {}, 1);
  ASSERT_TRUE(of_itself.has_value());
  EXPECT_EQ(of_itself->folds, 0);
  EXPECT_EQ(of_itself->logits, ForecastStack::DefaultLogits());
  EXPECT_GT(result.forecasts->scores[0].mean[0], 1.1 * of_itself->scores[0].mean[0]);
}

TEST(CrossFit, NeedsThreeRecordings) {
  const SyntheticOptions study = DifferingPeople();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  recordings.resize(2);
  const FitResult two = FitAndLearn(recordings, UnbiasedFit(study));
  ASSERT_TRUE(two.forecasts.has_value());
  EXPECT_EQ(two.forecasts->folds, 0);
  recordings = MakePendulums(study);
  recordings.resize(4);  // of one person
  const FitResult one = FitAndLearn(recordings, UnbiasedFit(study));
  ASSERT_TRUE(one.forecasts.has_value());
  EXPECT_EQ(one.forecasts->folds, 4);
}

double LargestChangeOf(const IdentifiedModel& model, const IdentifiedModel& from) {
  double largest = 0.0;
  for (const Parameter p : model.table.Free()) {
    largest =
        std::max(largest, std::abs(model.parameters[p] - from.parameters[p]) / from.parameters[p]);
  }
  return largest;
}

// A refit ends where a solve without these recordings does, but for the weights of the whole.
TEST(SolveFolds, RefitsToWhatASolveWithoutThemFinds) {
  const SyntheticOptions study = DifferingPeople();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = UnbiasedFit(study);
  const std::vector<int> held_out = {0, 1, 2, 3};
  const Result<FoldedModels> folded = SolveFolds(recordings, options, {held_out});
  ASSERT_TRUE(folded.ok());
  ASSERT_TRUE(folded.value().without[0].has_value());
  const Result<IdentifiedModel> anew =
      SolveModel({recordings.begin() + 4, recordings.end()}, options);
  ASSERT_TRUE(anew.ok());
  EXPECT_LT(LargestChangeOf(*folded.value().without[0], anew.value()), 0.02);
  EXPECT_GT(LargestChangeOf(folded.value().whole, anew.value()), 0.02);
}

}  // namespace
}  // namespace pushid
