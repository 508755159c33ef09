// Do the 95 % intervals cover the truth? 200 studies of 24 recordings with 2 mm of noise on every
// coordinate of hip and ankles; people, pushes and noise are drawn anew in each.
//
// Noise at frame 0 acts on rod length, start and posture, hence on the model itself (errors in
// variables). At 2 mm the bias this leaves is below a fifth of the spread; the spread itself grows
// twofold (mu) to fivefold (the tail's torque), by errors that all frames of a recording share:
// naive intervals cover as little as 83 % then, and nearly 100 % without it.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

constexpr int kStudies = 200;
constexpr double kNoise = 0.002;  // m

class Coverage : public ::testing::TestWithParam<bool> {};

std::vector<Estimate> EstimatesOf(int study, bool noise_at_first_frame) {
  SyntheticOptions made = SmallStudy();
  made.seed = 100 + static_cast<uint64_t>(study);
  made.joint_noise_m = kNoise;
  made.noise_at_first_frame = noise_at_first_frame;
  std::vector<PendulumRecording> recordings = MakePendulums(made);
  for (PendulumRecording& r : recordings) r.subject_ids = {"S1"};  // people are alike here
  FitOptions options = UnbiasedFit(made);
  options.sigmas = ResidualSigmas();  // the robust loss as a user has it
  const FitProblem problem(recordings, options);
  const Solution solution = Solve(problem);
  if (!solution.ok()) return {};
  return ComputeUncertainty(problem, solution.start.to).estimates;
}

TEST_P(Coverage, IntervalsCoverTheTruth) {
  std::vector<std::vector<Estimate>> estimates(kStudies);
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < kStudies; i = next++) estimates[i] = EstimatesOf(i, GetParam());
  };
  std::thread second(work);
  work();
  second.join();

  const FitOptions options = UnbiasedFit(SmallStudy());
  const std::vector<Parameter> free = options.table.Free();
  for (size_t p = 0; p < free.size(); ++p) {
    const double truth = SmallStudy().parameters[free[p]];
    int covered = 0, covered_naive = 0;
    double mean = 0.0, squares = 0.0, error = 0.0;
    for (const std::vector<Estimate>& study : estimates) {
      ASSERT_EQ(study.size(), free.size());
      const Estimate& e = study[p];
      covered += e.lower95 <= truth && truth <= e.upper95;
      covered_naive += std::abs(e.value - truth) <= 1.96 * e.standard_error_naive;
      mean += (e.value - truth) / kStudies;
      error += e.standard_error / kStudies;
    }
    for (const std::vector<Estimate>& study : estimates) {
      squares += std::pow(study[p].value - truth - mean, 2) / (kStudies - 1);
    }
    const std::string name(kParameterNames[free[p]]);
    const double spread = std::sqrt(squares);
    RecordProperty("covered_" + name, std::to_string(static_cast<double>(covered) / kStudies));
    RecordProperty("covered_naive_" + name,
                   std::to_string(static_cast<double>(covered_naive) / kStudies));
    RecordProperty("bias_over_truth_" + name, std::to_string(mean / truth));
    RecordProperty("spread_over_truth_" + name, std::to_string(spread / std::abs(truth)));
    EXPECT_GE(covered, 0.89 * kStudies) << name;  // tail_gain and tail_base trade
    EXPECT_LE(covered, 0.99 * kStudies) << name;
    EXPECT_LT(std::abs(mean), 0.2 * spread) << name;
    // The error that a study states is the spread between studies.
    EXPECT_NEAR(error / spread, 1.0, 0.16) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Noise, Coverage, ::testing::Values(true, false),
                         [](const ::testing::TestParamInfo<bool>& noisy) {
                           return noisy.param ? "AtEveryFrame" : "ExceptAtTheFirstFrame";
                         });

}  // namespace
}  // namespace pushid
