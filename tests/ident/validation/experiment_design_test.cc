// Which push to record next, checked by recording it.

#include "ident/validation/experiment_design.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/model_verdict.h"
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
    estimate_ = Solve(*problem_).start.to;
    uncertainty_ = ComputeUncertainty(*problem_, estimate_);
    const ScoredFit fit = ScoreAt(*problem_, estimate_);
    parts_ = ComputeCovariance(fit.score, fit.unit, {ClusterByRecording(fit.score), {}, 0, false});
  }
  ExperimentDesign Of(const std::vector<CandidatePush>& candidates) const {
    return Unwrapped(DesignExperiments(*problem_, estimate_, uncertainty_, parts_, candidates));
  }
  void WithoutSpread() {
    parts_.scatter = {};
    parts_.scatter.Add(parts_.naive, 1.0);
  }
  static size_t Index(const ExperimentDesign& design, const std::string& name) {
    const auto at = std::find_if(design.parameters.begin(), design.parameters.end(),
                                 [&](const Estimate& e) { return e.name == name; });
    return static_cast<size_t>(at - design.parameters.begin());
  }

  SyntheticOptions study_;
  std::vector<PendulumRecording> recordings_;
  FitOptions options_;
  std::unique_ptr<FitProblem> problem_;
  FitPoint estimate_;
  Uncertainty uncertainty_;
  Covariance parts_;
};

// Sideways pushes tell about sideways friction, and a strong one more than a weak one.
TEST_F(Design, ThePushThatMovesAParameterIsTheOneToRecord) {
  const std::vector<CandidatePush> pushes = {
      {0, 3, 1, 0.1, 80}, {90, 3, 1, 0.1, 80}, {90, 1, 1, 0.1, 80}, {90, 500, 1, 0.2, 80}};
  const ExperimentDesign alike = Of(pushes);
  ASSERT_EQ(alike.rows.size(), 3u);  // the last one fell
  const size_t sideways = Index(alike, "mu_y");
  const auto ratio = [&](const ExperimentDesign& d, int row) {
    return d.rows[row].error_ratio[sideways];
  };
  WithoutSpread();
  const ExperimentDesign noise_alone = Of(pushes);
  for (const ExperimentDesign* d : {&alike, &noise_alone}) {
    EXPECT_LT(ratio(*d, 1), ratio(*d, 0));
    EXPECT_LT(ratio(*d, 1), ratio(*d, 2));
    for (const DesignRow& row : d->rows) EXPECT_LT(row.error_ratio.back(), 1.0);
  }
  EXPECT_LT(ratio(noise_alone, 1), 0.92);
  EXPECT_GT(ratio(noise_alone, 0), 0.95);
  // Where recordings disagree, one more of 12 cannot help much.
  for (const DesignRow& row : alike.rows) {
    EXPECT_GT(row.error_ratio.back(), 0.9 * std::sqrt(12.0 / 13.0));
  }
}

// The candidate's information is that of the recording it would be.
TEST_F(Design, CandidatesCountAsRecordings) {
  const CandidatePush push{90, 3, 1, 0.1, 80};
  std::vector<PendulumRecording> more = recordings_;
  more.push_back(MakeCandidate(*problem_, estimate_, push));
  const FitProblem with(more, options_);
  // Without spread V = V_naive, and what is found is the naive error of the fit with it.
  const Covariance now = CovarianceAt(*problem_, estimate_), then = CovarianceAt(with, estimate_);
  parts_ = now;
  WithoutSpread();
  const double sigma = now.sigma / then.sigma;
  const Eigen::MatrixXd expected = sigma * sigma * then.naive;
  const ExperimentDesign d = Of({push});
  for (int i = 0; i < expected.rows(); ++i) {
    EXPECT_NEAR(d.rows[0].error_ratio[i], std::sqrt(expected(i, i) / now.naive(i, i)), 1e-6);
  }
}

// A sensor makes the tail known, which is found beside drag without.
TEST_F(Design, ASensorTellsMoreOfDragThanAPushWithATail) {
  WithoutSpread();
  const ExperimentDesign d = Of({{90, 3, 1, 0.1, 80, false}, {90, 3, 1, 0.2, 80, true}});
  const size_t sideways = Index(d, "mu_y");
  EXPECT_LT(d.rows[1].error_ratio[sideways], d.rows[0].error_ratio[sideways]);
}

TEST_F(Design, TheTableSaysWhatIsBestForTheParameterAsked) {
  Result<ExperimentDesign> d = Of({{0, 3, 1, 0.1, 80}, {90, 3, 1, 0.1, 80}, {180, 1, 1, 0.1, 80}});
  const std::string text = DesignText("mu_y", &d).value();
  EXPECT_LT(text.find("to the left"), text.find("forwards"));
  EXPECT_TRUE(Contains(text, "the least useful of 3 candidates"));
  EXPECT_TRUE(Contains(text, "now, by the data alone: mu_y +- "));
  EXPECT_FALSE(Contains(DesignText("all", &d).value(), "now,"));
  EXPECT_TRUE(Contains(ProblemOf(DesignText("nu", &d)), "all, mu"));
  d = Error{"too few"};
  EXPECT_EQ(DesignText("all", &d).value(), "no further push is proposed: too few\n");
}

TEST_F(Design, DefaultCandidatesSpanTheRecordings) {
  const ExperimentDesign d = Of({});
  EXPECT_GT(d.rows.size(), 96u);  // of 192, half of them with a sensor
}

}  // namespace
}  // namespace pushid
