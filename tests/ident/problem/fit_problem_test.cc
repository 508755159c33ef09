// A problem's points.
#include "ident/problem/fit_problem.h"

#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

// A model's file keeps a point as one row of numbers.
TEST(FitProblem, FindsThePointOfARow) {
  const auto recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  options.pool = "mu,tail_time";
  options.pool_by = kSubjectUnit;
  ASSERT_FALSE(PoolParameters(&options));
  const FitProblem problem(recordings, options);
  FitPoint point = problem.NominalPoint();
  ASSERT_EQ(point.unit.size(), 2u);
  double value = 0.0;
  for (double& x : point.shared) x += ++value;
  for (auto& [unit, deviations] : point.unit) {
    for (double& x : deviations) x += ++value;
  }
  const std::optional<FitPoint> found = problem.PointAt(point.Flat());
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->shared, point.shared);
  EXPECT_EQ(found->unit, point.unit);
  std::vector<double> short_row = point.Flat();
  short_row.pop_back();
  EXPECT_FALSE(problem.PointAt(short_row).has_value());
}

std::vector<std::string> FamiliesOf(const FitOptions& options, const FitStage& stage) {
  std::vector<std::string> names;
  for (const ResidualFamily& family : ResidualFamilies()) {
    if (family.on(options, stage)) names.push_back(family.name);
  }
  return names;
}

// Which rows of the table a fit minimizes, stage by stage.
TEST(FitProblem, FamiliesOfAStage) {
  using Names = std::vector<std::string>;
  const FitStage start{0, true}, first{10, false}, last{0, false};
  FitOptions options = MakePreset("tail").value();
  options.network_prior = 0.0;
  EXPECT_EQ(FamiliesOf(options, start), (Names{"equation error", "priors", "pooling"}));
  EXPECT_EQ(FamiliesOf(options, first), (Names{"trajectory", "priors", "pooling", "stage priors"}));
  EXPECT_EQ(FamiliesOf(options, last), (Names{"trajectory", "priors", "pooling", "settling"}));
  SetSelfForce(SelfForceKind::kLinear, &options);
  options.network_prior = 0.5;
  EXPECT_EQ(FamiliesOf(options, last),
            (Names{"trajectory", "priors", "pooling", "network prior", "settling", "modes"}));
  SetLikelihood(Likelihood::kInnovation, &options);
  EXPECT_EQ(FamiliesOf(options, last), (Names{"likelihood", "priors", "pooling", "network prior"}));
}

// Rows of recordings come first, by recording; then what is added once, then what units are asked.
TEST(FitProblem, BlocksFollowTheTable) {
  const auto recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  SetSelfForce(SelfForceKind::kLinear, &options);
  const FitProblem problem(recordings, options);
  FitPoint point = problem.NominalPoint();
  const FitProblem::Built built = problem.Build(&point, 0);
  std::vector<int> clusters;
  for (const FitProblem::Built::Block& block : built.blocks) {
    if (clusters.empty() || clusters.back() != block.cluster) clusters.push_back(block.cluster);
  }
  std::vector<int> expected;
  for (int i = 0; i < static_cast<int>(recordings.size()); ++i) expected.push_back(i);
  expected.push_back(FitProblem::kPriorCluster);
  if (!point.unit.empty()) expected.push_back(FitProblem::kPoolingCluster);
  expected.push_back(FitProblem::kSettlingCluster);
  EXPECT_EQ(clusters, expected);
}

}  // namespace
}  // namespace pushid
