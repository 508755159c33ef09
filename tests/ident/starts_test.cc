// From wrong starts to one optimum; stages; starts from which people fall.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "datasets/load_recordings.h"
#include "ident/fit_result.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr int kStarts = 32;
constexpr double kSameCost = 1e-6;  // relative

// 32 starts with every gain wrong by up to 5x either way.
void ExpectOneOptimum(const FitProblem& problem) {
  std::vector<double> costs;
  for (uint64_t seed = 1; seed <= kStarts; ++seed) {
    const SolveStart solved =
        SolveFrom(problem, RandomStart(problem, 5.0, seed), "random", "", nullptr);
    EXPECT_TRUE(solved.usable) << "start " << seed << ": " << solved.message;
    EXPECT_TRUE(solved.failed.empty()) << "start " << seed;
    costs.push_back(solved.cost);
  }
  const double best = *std::min_element(costs.begin(), costs.end());
  for (int i = 0; i < kStarts; ++i) {
    EXPECT_LE(costs[i], best * (1.0 + kSameCost)) << "start " << i + 1;
  }
}

TEST(Starts, SyntheticOneOptimum) {
  SyntheticOptions study = SmallStudy();
  study.joint_noise_m = 0.002;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = DefaultFit(study);
  ExpectOneOptimum(FitProblem(recordings, options));
}

TEST(Starts, SyntheticOneOptimumWithoutPriors) {
  SyntheticOptions study = SmallStudy();
  study.joint_noise_m = 0.002;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = UnbiasedFit(study);
  ExpectOneOptimum(FitProblem(recordings, options));
}

TEST(Starts, RealRecordingsOneOptimum) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions load;
  load.setting = "single";
  const auto loaded = LoadRecordings(RecordingsRoot() + "/manifest.json", load);
  ASSERT_TRUE(loaded.ok()) << loaded.error().ToString();
  const std::vector<PendulumRecording> recordings = AsPendulums(loaded.value());
  const Preset preset = MakePreset("tail").value();
  FitOptions options;
  options.model = preset.model;
  options.table = preset.table;
  options.settling_weight = preset.settling_weight;
  ExpectOneOptimum(FitProblem(recordings, options));
}

}  // namespace
}  // namespace pushid
