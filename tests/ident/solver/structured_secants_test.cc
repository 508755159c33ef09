// Curvature that secants learn, and how many steps that saves.
#include "ident/solver/structured_secants.h"

#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ident/problem/residual_rows.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/covariance.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

using Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

// A quadratic cost 0.5 x'Hx + 10 whose rows say J'J = G.
SecondOrder Quadratic(const MatrixXd& g, const MatrixXd& h, const VectorXd& x) {
  return {g, h * x};
}
double CostOf(const MatrixXd& h, const VectorXd& x) { return 0.5 * x.dot(h * x) + 10.0; }

struct Model {
  MatrixXd hessian;
  VectorXd gradient;
  double cost;

  explicit Model(const RowMajorMatrix& rows) {
    const Eigen::Index size = rows.cols() - 1;
    hessian = rows.leftCols(size).transpose() * rows.leftCols(size);
    gradient = rows.leftCols(size).transpose() * rows.col(size);
    cost = 0.5 * rows.col(size).squaredNorm();
  }
};

class Secants : public ::testing::Test {
 protected:
  const MatrixXd g_ = (MatrixXd(2, 2) << 4.0, 1.0, 1.0, 3.0).finished();
  const MatrixXd h_ = (MatrixXd(2, 2) << 1.5, 0.2, 0.2, 2.0).finished();
  const SecondOrder nothing_ = SecondOrder::Zero(2);

  Model After(const std::vector<Vector2d>& points, bool learns, const MatrixXd& beyond = {}) const {
    StructuredSecants secants(learns, beyond);
    for (const Vector2d& x : points) {
      secants.Add(x, CostOf(h_, x), Quadratic(g_, h_, x), nothing_);
    }
    return Model(secants.Rows());
  }
};

TEST_F(Secants, RowsAreTheCostAndItsGradient) {
  const Vector2d x(0.3, -0.2);
  for (bool learns : {false, true}) {
    const Model model = After({{1.0, 0.5}, {0.5, 0.1}, x}, learns);
    EXPECT_NEAR(model.cost, CostOf(h_, x), 1e-9);
    EXPECT_LT((model.gradient - h_ * x).norm(), 1e-9);
  }
}

TEST_F(Secants, NothingIsLearnedFromOnePointOrWhereItIsNotAsked) {
  EXPECT_LT((After({{1.0, 0.5}}, true).hessian - g_).norm(), 1e-9);
  EXPECT_LT((After({{1.0, 0.5}, {0.4, 0.1}, {0.1, 0.2}}, false).hessian - g_).norm(), 1e-9);
}

TEST_F(Secants, TheLastStepIsKnown) {
  const Vector2d from(0.4, 0.1), to(0.1, 0.2);
  const Model model = After({{1.0, 0.5}, from, to}, true);
  EXPECT_LT((model.hessian * (to - from) - h_ * (to - from)).norm(), 1e-9);
}

TEST_F(Secants, StartFromWhatIsKnownNearby) {
  EXPECT_LT((After({{1.0, 0.5}}, true, h_ - g_).hessian - h_).norm(), 1e-9);
}

TEST_F(Secants, TheSamePointTwiceChangesNothing) {
  const Model once = After({{1.0, 0.5}, {0.4, 0.1}}, true);
  const Model twice = After({{1.0, 0.5}, {0.4, 0.1}, {0.4, 0.1}}, true);
  EXPECT_LT((once.hessian - twice.hessian).norm(), 1e-12);
}

// A number that nothing depends on stays, and so does everything where nothing is left.
TEST_F(Secants, ColumnsWithoutInformationAndCostsOfZeroHaveRows) {
  StructuredSecants secants(true);
  SecondOrder rows = SecondOrder::Zero(2);
  rows.information(0, 0) = 4.0;
  secants.Add(Vector2d::Zero(), 0.0, rows, nothing_);
  const Model model(secants.Rows());
  EXPECT_EQ(model.cost, 0.0);
  EXPECT_LT(model.gradient.norm(), 1e-12);
  EXPECT_NEAR(model.hessian(0, 0), 4.0, 1e-9);
  EXPECT_LT(std::abs(model.hessian(1, 1)), 1e-9);
}

// Priors are linear: what they say is known already, and only recordings differ from it.
TEST_F(Secants, LinearRowsStayWhatTheyAre) {
  StructuredSecants secants(true);
  SecondOrder prior = SecondOrder::Zero(2);
  prior.information = MatrixXd::Identity(2, 2);
  for (const Vector2d& x : {Vector2d(1.0, 0.5), Vector2d(0.4, 0.1)}) {
    prior.gradient = x;
    secants.Add(x, CostOf(h_, x) + 0.5 * x.squaredNorm(), Quadratic(g_, g_, x), prior);
  }
  const MatrixXd both = g_ + MatrixXd::Identity(2, 2);
  EXPECT_LT((Model(secants.Rows()).hessian - both).norm(), 1e-9);
}

// Brown and Dennis (1971), problem 16 of More, Garbow and Hillstrom (1981): residuals are large at
// the optimum, whose squares sum to 85822.2.
struct BrownDennis {
  double t;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    const T a = x[0] + t * x[1] - std::exp(t);
    const T b = x[2] + std::sin(t) * x[3] - std::cos(t);
    residual[0] = a * a + b * b;
    return true;
  }
};

SolveStage SolveBrownDennis(bool learns, std::vector<double>* x) {
  FitProblem::Built built;
  built.problem = std::make_unique<ceres::Problem>();
  built.problem->AddParameterBlock(x->data(), 4);
  built.parameter_blocks = {x->data()};
  for (int i = 1; i <= 20; ++i) {
    auto* cost = new ceres::AutoDiffCostFunction<BrownDennis, 1, 4>(new BrownDennis{0.2 * i});
    built.blocks.push_back({built.problem->AddResidualBlock(cost, nullptr, x->data()), 0, cost});
  }
  FitOptions options;
  options.max_iterations = 1000;
  options.function_tolerance = 1e-12;
  std::string message;
  return SolveBuilt(&built, SolverOptions(options, *built.problem), 0, &message,
                    StructuredSecants(learns));
}

TEST(SummedCost, FindsTheOptimumOfLargeResiduals) {
  std::vector<double> by_secants = {25.0, 5.0, -5.0, -1.0}, plain = by_secants;
  const SolveStage with = SolveBrownDennis(true, &by_secants);
  const SolveStage without = SolveBrownDennis(false, &plain);
  EXPECT_NEAR(2.0 * with.final_cost, 85822.2, 0.05);
  EXPECT_GT(2.0 * without.final_cost, 1e5);  // as far as it comes in a thousand steps
}

struct Difference {
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    residual[0] = a[0] - b[0];
    residual[1] = a[0] * b[0] - 6.0;
    return true;
  }
};

TEST(SummedCost, BlocksStayAndBoundsHold) {
  double a = 0.5, b = 2.0;
  FitProblem::Built built;
  built.problem = std::make_unique<ceres::Problem>();
  auto* cost = new ceres::AutoDiffCostFunction<Difference, 2, 1, 1>(new Difference);
  built.blocks.push_back({built.problem->AddResidualBlock(cost, nullptr, &a, &b), 0, cost});
  built.parameter_blocks = {&a, &b};
  built.problem->SetParameterBlockConstant(&b);
  built.problem->SetParameterUpperBound(&a, 0, 2.1);
  std::string message;
  const SolveStage stage = SolveBuilt(&built, SolverOptions(FitOptions(), *built.problem), 0,
                                      &message, StructuredSecants(true));
  EXPECT_TRUE(stage.converged) << message;
  EXPECT_EQ(b, 2.0);
  EXPECT_DOUBLE_EQ(a, 2.1);
}

// Away from zero alone.
struct Logarithm {
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = log(x[0]) - T(0.5);
    return true;
  }
};

TEST(SummedCost, PointsThatCannotBeEvaluatedAreRefused) {
  double x = -1.0;
  FitProblem::Built built;
  built.problem = std::make_unique<ceres::Problem>();
  auto* cost = new ceres::AutoDiffCostFunction<Logarithm, 1, 1>(new Logarithm);
  built.blocks.push_back({built.problem->AddResidualBlock(cost, nullptr, &x), 0, cost});
  built.parameter_blocks = {&x};
  const SummedCost summed(&built, StructuredSecants(true), {});
  double residuals[2], jacobian[2];
  double* jacobians[] = {jacobian};
  for (double at : {-1.0, 2.0}) {
    const double* const blocks[] = {&at};
    EXPECT_EQ(summed.Evaluate(blocks, residuals, nullptr), at > 0.0);
    EXPECT_EQ(summed.Evaluate(blocks, residuals, jacobians), at > 0.0);
  }
}

// Recordings of people alone reach the sum in lanes, without rows of their own.
TEST(SummedCost, LanesSumToWhatRowsDo) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  for (PendulumRecording& r : recordings) r.initial_velocity = InitialVelocity::kFree;
  const FitProblem problem(recordings, UnbiasedFit(TinyStudy()));
  FitPoint point = problem.NominalPoint();
  FitProblem::Built built = problem.Build(&point, 0);
  const ResidualRows rows = EvaluateRows(built);
  const RecordingSums expected = SumRows(rows, point, rows.RowsOfData());
  const SummedCost summed(&built, StructuredSecants(false), {});
  std::vector<double> at = summed.Values(), elsewhere = at;
  for (double& value : elsewhere) value += 0.01;
  const size_t columns = at.size();
  std::vector<double> residuals(columns + 1), jacobian((columns + 1) * columns);
  double* jacobians[] = {jacobian.data()};
  for (const std::vector<double>& asked : {at, elsewhere, at}) {
    const double* const blocks[] = {asked.data()};
    ASSERT_TRUE(summed.Evaluate(blocks, residuals.data(), nullptr));
    ASSERT_TRUE(summed.Evaluate(blocks, residuals.data(), jacobians));
  }
  const RecordingSums& found = summed.recordings();
  EXPECT_EQ(found.at, expected.at);
  EXPECT_NEAR(found.squares, expected.squares, 1e-12 * expected.squares);
  const VectorXd scale = expected.sums.information.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    EXPECT_NEAR(found.sums.gradient[i], expected.sums.gradient[i],
                1e-11 * scale[i] * std::sqrt(expected.squares));
    for (Eigen::Index j = 0; j < scale.size(); ++j) {
      EXPECT_NEAR(found.sums.information(i, j), expected.sums.information(i, j),
                  1e-11 * scale[i] * scale[j]);
    }
  }
}

// r = factor max(0, x - from), counting how often it is asked.
class CountedHinge : public ceres::SizedCostFunction<1, 1> {
 public:
  CountedHinge(double from, double factor, int* asked)
      : from_(from), factor_(factor), asked_(*asked) {}
  bool Evaluate(double const* const* x, double* residual, double** jacobian) const override {
    ++asked_;
    const bool beyond = x[0][0] > from_;
    *residual = beyond ? factor_ * (x[0][0] - from_) : 0.0;
    if (jacobian != nullptr && jacobian[0] != nullptr) jacobian[0][0] = beyond ? factor_ : 0.0;
    return true;
  }

 private:
  const double from_, factor_;
  int& asked_;
};

class SumsOfRecordings : public ::testing::Test {
 protected:
  SumsOfRecordings() {
    built_.evaluation = std::make_unique<ParallelEvaluation>(1);
    built_.problem = std::make_unique<ceres::Problem>();
    built_.evaluation->set_problem(built_.problem.get());
    built_.problem->AddParameterBlock(&x_, 1);
    built_.parameter_blocks = {&x_};
    built_.AddRollout(std::make_unique<CountedHinge>(-1.0, 1.0, &of_recording_), {&x_}, 0);
    built_.AddRollout(std::make_unique<CountedHinge>(2.0, 100.0, &of_demand_), {&x_},
                      FitProblem::kSettlingCluster);
  }
  // Twice the cost.
  double Squares(const SummedCost& summed, double x, bool derivatives) const {
    double residuals[2], jacobian[2];
    double* jacobians[] = {jacobian};
    const double* const blocks[] = {&x};
    EXPECT_TRUE(summed.Evaluate(blocks, residuals, derivatives ? jacobians : nullptr));
    return residuals[0] * residuals[0] + residuals[1] * residuals[1];
  }

  double x_ = 1.0;
  int of_recording_ = 0, of_demand_ = 0;
  FitProblem::Built built_;
};

TEST_F(SumsOfRecordings, ThatAreKnownAreNotAskedForAgain) {
  const RecordingSums known{Eigen::VectorXd::Constant(1, 1.0),
                            4.0,
                            {MatrixXd::Constant(1, 1, 1.0), VectorXd::Constant(1, 2.0)}};
  const SummedCost summed(&built_, StructuredSecants(true), known);
  EXPECT_DOUBLE_EQ(Squares(summed, 1.0, true), 4.0);
  EXPECT_EQ(of_recording_, 0);
  EXPECT_EQ(of_demand_, 1);
  EXPECT_DOUBLE_EQ(Squares(summed, 2.5, true), 3.5 * 3.5 + 50.0 * 50.0);
  EXPECT_EQ(of_recording_, 1);
  EXPECT_EQ(summed.recordings().at[0], 2.5);
  EXPECT_DOUBLE_EQ(summed.recordings().squares, 3.5 * 3.5);
}

TEST_F(SumsOfRecordings, AreNotAskedForWhereDemandsAloneRefuseATrial) {
  const SummedCost summed(&built_, StructuredSecants(true), {});
  EXPECT_DOUBLE_EQ(Squares(summed, 1.0, true), 4.0);
  of_recording_ = 0;
  EXPECT_DOUBLE_EQ(Squares(summed, 2.5, false), 50.0 * 50.0);
  EXPECT_EQ(of_recording_, 0);
  EXPECT_NEAR(Squares(summed, 2.01, false), 3.01 * 3.01 + 1.0, 1e-9);
  EXPECT_EQ(of_recording_, 1);
}

}  // namespace
}  // namespace pushid
