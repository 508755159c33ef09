// What a verdict finds, and what it does not.
#include "ident/uncertainty/model_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ident/fit/fit.h"
#include "ident/uncertainty/rows_by_frame.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

SyntheticOptions Study(uint64_t seed) {
  SyntheticOptions study;
  study.subjects = 6;
  study.recordings_per_subject = 5;
  study.frames = 90;
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.002;
  study.subject_spread = 0.1;
  study.seed = seed;
  return study;
}

FitResult FitOf(const std::vector<PendulumRecording>& recordings) {
  FitOptions options = MakePreset("tail").value();
  EXPECT_FALSE(PrepareFit(recordings, &options));
  FitResult result = Fit(recordings, options);
  EXPECT_TRUE(result.ok()) << result.message;
  return result;
}

const AssumptionTest* Find(const ModelVerdict& verdict, const std::string& name) {
  const auto found = std::find_if(verdict.assumptions.begin(), verdict.assumptions.end(),
                                  [&name](const AssumptionTest& t) { return t.name == name; });
  return found == verdict.assumptions.end() ? nullptr : &*found;
}

int Count(const FitResult& result, EstimateStatus status) {
  return static_cast<int>(
      std::count_if(result.estimates.begin(), result.estimates.end(),
                    [status](const Estimate& e) { return e.status == status; }));
}

// Differences of raw residuals give the gradient that the solver's Jacobian gives.
TEST(ModelVerdict, RowsByFrameHaveTheGradientOfTheCost) {
  const auto recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitProblem problem(recordings, options);
  FitPoint point = problem.NominalPoint();
  const RowsByFrame by_frame = EvaluateByFrame(problem, point, {});
  const JacobianBlocks condensed = EvaluateJacobianBlocks(problem.Build(&point, 0), true);
  const auto gradient = [](const JacobianBlocks& rows) {
    return Eigen::VectorXd(rows.jacobian.transpose() * rows.residuals);
  };
  const Eigen::VectorXd a = gradient(by_frame.rows), b = gradient(condensed);
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i], b[i], 1e-3 * (1e-3 + std::abs(b[i]))) << i;
  }
}

TEST(ModelVerdict, PassesWhatTheModelMade) {
  int failed = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    const FitResult result = FitOf(MakePendulums(Study(seed)));
    EXPECT_TRUE(result.verdict.checked()) << result.verdict.not_checked;
    failed += result.verdict.fails();
  }
  EXPECT_LE(failed, 1);
}

TEST(ModelVerdict, FindsPushesOfAnotherScale) {
  std::vector<PendulumRecording> recordings = MakePendulums(Study(3));
  for (PendulumRecording& r : recordings) r.scene = ScalePushes(r.scene, 1.5);
  const FitResult result = FitOf(recordings);
  EXPECT_TRUE(result.verdict.fails());
  EXPECT_EQ(Count(result, EstimateStatus::kIdentified), 0);
  const AssumptionTest* scale = Find(result.verdict, "scale of the pushes");
  ASSERT_NE(scale, nullptr);
  EXPECT_LT(scale->wanted, -0.1);
}

// The total error holds what is stated of pushes and held gains as well.
TEST(ModelVerdict, TotalErrorsAreLargerThanThoseOfTheDataAlone) {
  const FitResult result = FitOf(MakePendulums(Study(2)));
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    ASSERT_TRUE(e.total.has_value()) << e.name;
    EXPECT_GT(e.total->error, 0.9 * e.standard_error) << e.name;
    EXPECT_LT(e.total->lower95, e.value) << e.name;
    EXPECT_GT(e.total->upper95, e.value) << e.name;
  }
}

TEST(ModelVerdict, SaysWhyNothingWasChecked) {
  SyntheticOptions study = TinyStudy();
  const FitResult result = FitOf(MakePendulums(study));  // two people
  EXPECT_FALSE(result.verdict.checked());
  EXPECT_NE(result.verdict.not_checked.find("fewer than three"), std::string::npos);
}

}  // namespace
}  // namespace pushid
