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

}  // namespace
}  // namespace pushid
