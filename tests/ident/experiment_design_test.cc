// Which push to record next, checked by recording it.
#include "ident/experiment_design.h"

#include <gtest/gtest.h>

#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class Design : public ::testing::Test {
 protected:
  Design() : study_(SmallStudy()) {
    study_.recording_spread = 0.1;
    study_.joint_noise_m = 0.001;
    recordings_ = MakePendulums(study_);
    options_ = UnbiasedFit(study_);
    options_.model.friction = FrictionKind::kAnisotropic;
    EXPECT_FALSE(EditTable({"", "mu_y=20", "", "", ""}, &options_.table));
    problem_ = std::make_unique<FitProblem>(recordings_, options_);
    estimate_ = Solve(*problem_).Best().to;
    uncertainty_ = ComputeUncertainty(*problem_, estimate_);
  }
  ExperimentDesign Of(const std::vector<CandidatePush>& candidates) const {
    return DesignExperiments(*problem_, estimate_, uncertainty_, candidates);
  }
  static size_t Index(const ExperimentDesign& design, const std::string& name) {
    return static_cast<size_t>(std::find(design.parameters.begin(), design.parameters.end(), name) -
                               design.parameters.begin());
  }

  SyntheticOptions study_;
  std::vector<PendulumRecording> recordings_;
  FitOptions options_;
  std::unique_ptr<FitProblem> problem_;
  FitPoint estimate_;
  Uncertainty uncertainty_;
};

// Sideways pushes tell about sideways friction, and a strong one more than a weak one.
TEST_F(Design, ThePushThatMovesAParameterIsTheOneToRecord) {
  const ExperimentDesign d =
      Of({{0, 3, 1, 0.1, 80}, {90, 3, 1, 0.1, 80}, {90, 1, 1, 0.1, 80}, {90, 500, 1, 0.2, 80}});
  ASSERT_EQ(d.rows.size(), 3u);  // the last one fell
  const size_t sideways = Index(d, "mu_y");
  EXPECT_LT(d.rows[1].error_ratio[sideways], 0.97);
  EXPECT_LT(d.rows[1].error_ratio[sideways], d.rows[0].error_ratio[sideways]);
  EXPECT_LT(d.rows[1].error_ratio[sideways], d.rows[2].error_ratio[sideways]);
  EXPECT_NEAR(d.rows[0].error_ratio[sideways], 1.0, 0.01);
  for (const DesignRow& row : d.rows) EXPECT_LT(row.volume_ratio, 1.0);
}

// The Hessian of the fit with the candidate among its recordings is what the design adds up.
TEST_F(Design, CandidatesCountAsRecordings) {
  const CandidatePush push{90, 3, 1, 0.1, 80};
  std::vector<PendulumRecording> more = recordings_;
  more.push_back(MakeCandidate(*problem_, estimate_, push, PushKind::kNet));
  const FitProblem with(more, options_);
  const Covariance now = CovarianceAt(*problem_, estimate_), then = CovarianceAt(with, estimate_);
  const Eigen::MatrixXd h = now.inverse_hessian.inverse(), h2 = then.inverse_hessian.inverse();
  const Eigen::MatrixXd v = uncertainty_.covariance;
  const Eigen::MatrixXd expected =
      then.inverse_hessian *
      (h * v * h + static_cast<double>(recordings_.size()) * (h2 - h) * v * (h2 - h)) *
      then.inverse_hessian;
  const ExperimentDesign d = Of({push});
  for (int i = 0; i < v.rows(); ++i) {
    EXPECT_NEAR(d.rows[0].error_ratio[i], std::sqrt(expected(i, i) / v(i, i)), 1e-6);
  }
}

TEST_F(Design, TheTableIsSortedAndNamesItsUnits) {
  const std::vector<CandidatePush> candidates = DefaultCandidates(recordings_);
  EXPECT_EQ(candidates.size(), 96u);
  const ExperimentDesign d = Of(candidates);
  const std::string text = DesignText(d, "mu_y", 5).value();
  EXPECT_TRUE(Contains(text, "error of mu_y"));
  EXPECT_TRUE(Contains(text, "now: mu_y +- "));
  EXPECT_LT(text.find("to the left"), text.find("forwards"));
  EXPECT_TRUE(DesignText(d, "all", 5).ok());
  const Result<std::string> wrong = DesignText(d, "nu", 5);
  ASSERT_FALSE(wrong.ok());
  EXPECT_TRUE(Contains(wrong.error().message, "mu_y"));
}

}  // namespace
}  // namespace pushid
