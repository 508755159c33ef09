// Evaluations ahead of Ceres: what it is handed, and that threads change no bit of a fit.
#include "ident/problem/parallel_evaluation.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <atomic>

#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

// r = a x - b, counting how often it is asked.
class CountedLine : public ceres::SizedCostFunction<1, 1, 1> {
 public:
  explicit CountedLine(std::atomic<int>* asked) : asked_(asked) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    ++*asked_;
    const double a = blocks[0][0], x = blocks[1][0];
    if (x > 100.0) return false;
    residuals[0] = a * x - 6.0;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) jacobians[0][0] = x;
    if (jacobians[1] != nullptr) jacobians[1][0] = a;
    return true;
  }

 private:
  std::atomic<int>* asked_;
};

class AheadOfCeres : public ::testing::Test {
 protected:
  AheadOfCeres() : evaluation_(2) {
    ceres::Problem::Options options;
    options.evaluation_callback = &evaluation_;
    problem_ = std::make_unique<ceres::Problem>(options);
    evaluation_.set_problem(problem_.get());
    const std::vector<double*> blocks = {&a_, &x_};
    problem_->AddResidualBlock(
        evaluation_.Wrap(std::make_unique<CountedLine>(&asked_), blocks).release(), nullptr,
        blocks);
  }
  double a_ = 2.0, x_ = 1.0;
  std::atomic<int> asked_{0};
  ParallelEvaluation evaluation_;
  std::unique_ptr<ceres::Problem> problem_;
};

TEST_F(AheadOfCeres, SolvesWithAConstantBlock) {
  problem_->SetParameterBlockConstant(&a_);
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);
  EXPECT_NEAR(x_, 3.0, 1e-6);
  EXPECT_EQ(a_, 2.0);
}

TEST_F(AheadOfCeres, FollowsThePointAndEvaluatesItOnce) {
  double cost = 0.0;
  for (double x : {1.0, 4.0, 4.0}) {
    x_ = x;
    ASSERT_TRUE(problem_->Evaluate({}, &cost, nullptr, nullptr, nullptr));
    EXPECT_EQ(cost, 0.5 * (2.0 * x - 6.0) * (2.0 * x - 6.0));
  }
  EXPECT_EQ(asked_, 2);  // the third time nothing had moved
  std::vector<double> gradient;
  ASSERT_TRUE(problem_->Evaluate({}, &cost, nullptr, &gradient, nullptr));
  EXPECT_EQ(asked_, 3);  // now with derivatives
  EXPECT_EQ(gradient[0], 2.0 * 4.0);
  EXPECT_EQ(gradient[1], 2.0 * 2.0);
}

TEST_F(AheadOfCeres, FailuresAreFailures) {
  x_ = 1000.0;
  double cost = 0.0;
  EXPECT_FALSE(problem_->Evaluate({}, &cost, nullptr, nullptr, nullptr));
}

// People who touch, with a tolerance as loose as the preset's, where the end of a fit shows every
// difference in its last digits.
TEST(ParallelEvaluation, AnyNumberOfThreadsGivesTheSameBits) {
  SyntheticOptions study = TinyStudy();
  study.subjects = study.people_in_row = 3;
  study.frames = 40;
  study.model.interaction.spring = study.model.interaction.damping = true;
  for (Parameter id :
       {kContactStiffness, kContactDistance, kContactKappa, kContactDamping, kContactHeight}) {
    study.parameters[id] = BaseTable()[id].nominal;
  }
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = MakePreset("group").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult one = Fit(recordings, options);
  ASSERT_TRUE(one.ok());
  for (int threads : {2, 5}) {
    options.num_threads = threads;
    const FitResult several = Fit(recordings, options);
    EXPECT_EQ(several.cost, one.cost) << threads;
    EXPECT_EQ(several.parameters, one.parameters) << threads;
    EXPECT_EQ(several.starts[0].iterations, one.starts[0].iterations) << threads;
  }
}

}  // namespace
}  // namespace pushid
