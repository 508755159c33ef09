// Fits without folds: what is held out teaches them nothing.

#include <gtest/gtest.h>

#include <cmath>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/prediction/prediction.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

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

// Neither for gains nor for weights.
TEST(CrossFit, LooksAtNothingHeldOut) {
  const SyntheticOptions study = DifferingPeople();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  options.estimate_weights = true;
  const FitProblem problem(recordings, options);
  const SolveStart start = SolveFrom(problem, problem.NominalPoint(), "nominal", nullptr);
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
// and error scales are those of the latter.
TEST(CrossFit, ErrorsAreThoseOfOthers) {
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
  EXPECT_EQ(of_itself->input_time, ForecastRule().input_time);
  const auto scale = [](const ForecastRule& rule) {
    return std::exp(rule.errors[0].coefficients.dot(ScaleFeatures(0.5, 0.0, 0.5)));
  };
  EXPECT_GT(scale(*result.forecasts), 1.1 * scale(*of_itself));
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

// The largest distance of hips that two models predict, m.
double FarthestHips(const IdentifiedModel& a, const IdentifiedModel& b,
                    const PendulumRecording& recording) {
  const Prediction of_a = Predict(a, recording), of_b = Predict(b, recording);
  double farthest = 0.0;
  for (size_t t = 0; t < of_a.hip[0].size(); ++t) {
    farthest = std::max(farthest, (of_a.hip[0][t] - of_b.hip[0][t]).norm());
  }
  return farthest;
}

// A refit predicts what a solve without these recordings does, but for the weights of the whole.
TEST(SolveFolds, RefitsToWhatASolveWithoutThemFinds) {
  const SyntheticOptions study = DifferingPeople();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = UnbiasedFit(study);
  const FoldedModels folded = Unwrapped(SolveFolds(recordings, options, {{0, 1, 2, 3}}));
  ASSERT_TRUE(folded.without[0].has_value());
  const IdentifiedModel anew =
      Unwrapped(SolveModel({recordings.begin() + 4, recordings.end()}, options));
  for (int i = 0; i < 4; ++i) {
    const double of_whole = FarthestHips(folded.whole, anew, recordings[i]);
    EXPECT_LT(FarthestHips(*folded.without[0], anew, recordings[i]), 0.5 * of_whole) << of_whole;
  }
}

}  // namespace
}  // namespace pushid
