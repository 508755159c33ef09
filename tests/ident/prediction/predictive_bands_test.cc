// Bands of hip paths: their order, where they come from, and whether they hold new recordings.
#include <gtest/gtest.h>

#include "datasets/files/random.h"
#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/model/model_rollout.h"
#include "ident/prediction/futures.h"
#include "ident/validation/crossvalidation.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticOptions VaryingStudy() {
  SyntheticOptions study = SmallStudy();
  study.recording_spread = 0.1;
  study.joint_noise_m = 0.001;
  return study;
}

TEST(PredictiveBands, SamplesHaveTheStatedSpread) {
  const FitResult result = Fit(MakePendulums(VaryingStudy()), UnbiasedFit(VaryingStudy()));
  BandOptions options;
  options.samples = 4000;
  const auto samples = SampleParameters(result, options);
  const Estimate& mu = *FindEstimate(result.estimates, "mu");
  int inside = 0;
  for (const ParameterSet<double>& set : samples) {
    inside += mu.lower95 <= set[kMu] && set[kMu] <= mu.upper95;
    EXPECT_EQ(set[kKpX], result.parameters[kKpX]);
  }
  EXPECT_NEAR(inside / 4000.0, 0.95, 0.015);
}

TEST(PredictiveBands, BootstrapRowsAreParameterSets) {
  const std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  FittedModel model{Fit(recordings, UnbiasedFit(TinyStudy())), {}, {}, {}, {}};
  ASSERT_FALSE(AddBootstrap(recordings, {8, 1, 2}, nullptr, &model));
  BandOptions options;
  options.bootstrap = &*model.bootstrap;
  for (const ParameterSet<double>& set : SampleParameters(model.fit, options)) {
    const auto& rows = model.bootstrap->values;
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(),
                            [&set](const std::vector<double>& row) { return row[0] == set[kMu]; }));
  }
}

TEST(PredictiveBands, LieInsideOneAnotherAndWidenWithModelError) {
  const std::vector<PendulumRecording> recordings = MakePendulums(VaryingStudy());
  const FitResult result = Fit(recordings, UnbiasedFit(VaryingStudy()));
  const auto samples = SampleParameters(result, BandOptions());
  const PredictiveBands narrow = ComputeBands(result, samples, {}, recordings[3], 1);
  const PredictiveBands wide =
      ComputeBands(result, samples, ErrorPaths(result, recordings), recordings[3], 1);
  EXPECT_EQ(narrow.failed, 0);
  ASSERT_EQ(narrow.people.size(), 1u);
  const int last = recordings[3].num_frames() - 1;
  for (const PredictiveBands* bands : {&narrow, &wide}) {
    const PathBand& b = bands->people[0];
    for (int t = 0; t <= last; ++t) {
      EXPECT_LE(b.lower90[t][0], b.lower50[t][0]);
      EXPECT_LE(b.lower50[t][0], b.middle[t][0]);
      EXPECT_LE(b.middle[t][0], b.upper50[t][0]);
      EXPECT_LE(b.upper50[t][0], b.upper90[t][0]);
    }
    EXPECT_NEAR(b.upper90[0][0] - b.lower90[0][0], 0.0, 1e-9);  // everybody starts there
  }
  const auto width = [last](const PredictiveBands& bands) {
    return bands.people[0].upper90[last][0] - bands.people[0].lower90[last][0];
  };
  EXPECT_GT(width(narrow), 0.0);
  EXPECT_GT(width(wide), 1.5 * width(narrow));
}

// Where the model misses something that all recordings share, the median of the draws lies beside
// the rollout: bands are moved so that the rollout lies where their median was.
TEST(PredictiveBands, LieAroundTheRollout) {
  const std::vector<PendulumRecording> recordings = MakePendulums(VaryingStudy());
  const FitResult result = Fit(recordings, UnbiasedFit(VaryingStudy()));
  std::vector<ErrorPath> errors = ErrorPaths(result, recordings);
  for (ErrorPath& error : errors) {
    for (size_t t = 0; t < error.path.size(); ++t) {
      error.path[t][0] += 3.0 * static_cast<double>(t) / static_cast<double>(error.path.size());
    }
  }
  const auto samples = SampleParameters(result, BandOptions());
  const PredictiveBands bands = ComputeBands(result, samples, errors, recordings[3], 1);
  const Prediction rollout = Predict(ModelOf(result), recordings[3]);
  const size_t last = static_cast<size_t>(recordings[3].num_frames()) - 1;
  const PathBand& band = bands.people[0];
  EXPECT_NEAR(rollout.hip[0][last].x(), band.middle[last][0], 1e-12);
  EXPECT_GT(band.middle[last][0], band.lower50[last][0]);
  EXPECT_LT(band.middle[last][0], band.upper50[last][0]);
}

// Three error paths drawn from N(0, 1): a fourth lies within their band in nine of ten cases, where
// the largest of three would hold one of two.
TEST(PredictiveBands, HoldAsOftenAsTheySayOfFewErrors) {
  const std::vector<PendulumRecording> recordings = MakePendulums(VaryingStudy());
  const FitResult result = Fit(recordings, UnbiasedFit(VaryingStudy()));
  const std::vector<ParameterSet<double>> samples(200, result.parameters);
  const double speed = PushSpeed(recordings[3]);
  Random random(7);
  int inside = 0;
  constexpr int kStudies = 300;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<ErrorPath> errors;
    for (const char* name : {"a", "b", "c"}) {
      errors.push_back({name, {BandPoint::Constant(random.Normal())}});
    }
    const PathBand band = ComputeBands(result, samples, errors, recordings[3], 1).people[0];
    const double drawn = band.middle[0][0] + speed * random.Normal();
    inside += drawn > band.lower90[0][0] && drawn < band.upper90[0][0];
  }
  EXPECT_NEAR(inside / static_cast<double>(kStudies), 0.9, 0.06);
}

TEST(PredictiveBands, HoldNewRecordingsAsOftenAsTheySay) {
  const std::vector<PendulumRecording> recordings = MakePendulums(VaryingStudy());
  const std::vector<Fold> folds = MakeFolds(recordings, FoldScheme::kStratified, 4, 1, 1).value();
  const MeanScore mean =
      CrossValidate(recordings, folds,
                    BandPredictor("bands", UnbiasedFit(VaryingStudy()), BandOptions()), 2)
          .summary.mean;
  EXPECT_EQ(mean.recordings, 24);
  EXPECT_NEAR(mean.value[kInside90], 0.9, 0.1);
  EXPECT_NEAR(mean.value[kInside50], 0.5, 0.2);
}

}  // namespace
}  // namespace pushid
