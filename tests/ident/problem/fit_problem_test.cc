// A problem's points.
#include "ident/problem/fit_problem.h"

#include <algorithm>
#include <cmath>

#include "ident/fit/fit_setup.h"
#include "ident/problem/residual_rows.h"
#include "residuals/cost_functions/rest_residual.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

FitOptions PooledBySubject() {
  FitOptions options = MakePreset("tail").value();
  options.pool = "mu,tail_time";
  options.pool_by = kSubjectUnit;
  EXPECT_FALSE(PoolParameters(&options));
  return options;
}

// A model's file keeps a point as one row of numbers.
TEST(FitProblem, FindsThePointOfARow) {
  const auto recordings = MakePendulums(TinyStudy());
  const FitOptions options = PooledBySubject();
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

TEST(FitProblem, RawResidualsSideBySideAreThoseOfEachRecording) {
  const auto recordings = MakePendulums(TinyStudy());
  const FitOptions options = PooledBySubject();
  const FitProblem problem(recordings, options);
  FitPoint point = problem.NominalPoint();
  double step = 0.0;
  for (auto& [unit, deviations] : point.unit) {
    for (double& x : deviations) x += step += 0.05;
  }
  ResidualSigmas plain = options.sigmas;
  plain.robust = 0.0;
  const FitProblem without(recordings, options, [&] {
    std::vector<int> counts(recordings.size(), 1);
    counts[1] = 0;
    return counts;
  }());
  const auto all = RawResiduals(problem, point), some = RawResiduals(without, point, true);
  EXPECT_TRUE(some[1].empty());
  for (size_t i = 0; i < recordings.size(); ++i) {
    const auto rollout =
        MakeRolloutProblem(problem.recordings()[i], options.model, problem.map(), plain, 1.0, 0);
    std::vector<double> alone(rollout->num_residuals());
    ASSERT_TRUE(RolloutResiduals(
        *rollout, problem.RecordingBlocks(&point, static_cast<int>(i)).data(), alone.data()));
    ASSERT_EQ(all[i].size(), alone.size());
    for (size_t k = 0; k < alone.size(); ++k) EXPECT_NEAR(all[i][k], alone[k], 1e-11);
    if (without.Count(static_cast<int>(i)) > 0) {
      EXPECT_EQ(some[i], all[i]);
    }
  }
}

double CostOf(const FitProblem& problem, FitPoint point) {
  const FitProblem::Built built = problem.Build(&point, 0);
  double cost = 0.0;
  EXPECT_TRUE(built.problem->Evaluate({}, &cost, nullptr, nullptr, nullptr));
  return cost;
}

// Rollouts are laid out once for all copies of a problem, and anew where weights change.
TEST(FitProblem, WhatIsLaidOutGoesWithTheWeights) {
  const auto recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  const FitProblem problem(recordings, options);
  const FitPoint point = problem.NominalPoint();
  const double before = CostOf(problem, point);
  FitProblem weighed = problem;
  EXPECT_EQ(CostOf(weighed, point), before);
  FitOptions weights = problem.options();
  weights.sigmas.hip *= 2.0;
  weighed.SetWeights(weights);
  options.sigmas = weights.sigmas;
  EXPECT_EQ(CostOf(weighed, point), CostOf(FitProblem(recordings, options), point));
  EXPECT_LT(CostOf(weighed, point), before);
  EXPECT_EQ(CostOf(problem, point), before);
  EXPECT_EQ(EvaluateRows(weighed.WithoutRecordings(), point).num_data_rows, 0);
}

// The clusters of a problem's blocks, in order, each run once.
std::vector<int> ClustersOf(const FitProblem& problem, int horizon) {
  FitPoint point = problem.NominalPoint();
  const FitProblem::Built built = problem.Build(&point, horizon);
  std::vector<int> clusters;
  for (const FitProblem::Built::Block& block : built.blocks) {
    if (clusters.empty() || clusters.back() != block.cluster) clusters.push_back(block.cluster);
  }
  return clusters;
}

// Rows of recordings come first, by recording; then what is added once, then what units are asked,
// stage by stage and likelihood by likelihood.
TEST(FitProblem, BlocksOfAStage) {
  constexpr int kPrior = FitProblem::kPriorCluster, kPooling = FitProblem::kPoolingCluster,
                kNetwork = FitProblem::kNetworkCluster, kSettling = FitProblem::kSettlingCluster;
  constexpr int kFirst = 10, kLast = 0;
  const auto recordings = MakePendulums(TinyStudy());
  const auto with = [&recordings](std::vector<int> more) {
    for (int i = static_cast<int>(recordings.size()) - 1; i >= 0; --i) more.insert(more.begin(), i);
    return more;
  };
  FitOptions options = MakePreset("tail").value();
  // All free parameters of the preset have priors, so that a first stage adds none.
  EXPECT_EQ(ClustersOf(FitProblem(recordings, options), kFirst), with({kPrior, kPooling}));
  FitOptions without = options;
  for (ParameterSpec& spec : without.table.specs) spec.prior.reset();
  EXPECT_EQ(ClustersOf(FitProblem(recordings, without), kFirst), with({kPooling, kPrior}));
  EXPECT_EQ(ClustersOf(FitProblem(recordings, options), kLast),
            with({kPrior, kPooling, kSettling}));
  FitOptions mlp = Unwrapped(MakeFitOptions({{"preset", "tail"}, {"self_force", "mlp:4"}}));
  EXPECT_EQ(ClustersOf(FitProblem(recordings, mlp), kLast),
            with({kPrior, kPooling, kNetwork, kSettling}));
  SetLikelihood(Likelihood::kInnovation, &options);
  EXPECT_EQ(ClustersOf(FitProblem(recordings, options), kLast), with({kPrior, kPooling}));
}

// The harder the push, the sooner: of those that are rolled out side by side the others stay.
TEST(FitProblem, LeavesOutTheSettlingSimulationsThatFall) {
  const auto recordings = MakePendulums(TinyStudy());
  const FitProblem problem(recordings, MakePreset("tail").value());
  const auto& fitted = problem.map().fitted;
  const auto balance = std::find_if(fitted.begin(), fitted.end(), [](const FittedParameter& f) {
    return f.parameter == kKpTheta;
  });
  int left_out = 0;
  for (double share : {1.0, 0.53, 0.52, 0.51}) {
    FitPoint point = problem.NominalPoint();
    point.shared[balance - fitted.begin()] += std::log(share);
    const FitProblem::Built built = problem.Build(&point, 0);
    EXPECT_EQ(built.rests_left_out, left_out);
    int rows = 0;
    for (const FitProblem::Built::Block& block : built.blocks) {
      const auto* settling = dynamic_cast<const SettlingResidual*>(block.cost);
      if (settling != nullptr) rows += settling->num_residuals();
    }
    EXPECT_EQ(rows, (3 - left_out) * 60 * 3);
    ++left_out;
  }
}

// Everything that a preset puts into its cost, priors, demands and values that others follow
// among it, where people neither settle nor stay stable.
TEST(FitProblem, TheGradientIsThatOfTheCostInEveryPreset) {
  SyntheticOptions study = TinyStudy();
  study.subjects = study.people_in_row = 3;
  study.frames = 40;
  study.model.interaction.spring = study.model.interaction.damping = true;
  for (Parameter id :
       {kContactStiffness, kContactDistance, kContactKappa, kContactDamping, kContactHeight}) {
    study.parameters[id] = BaseTable()[id].nominal;
  }
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  for (const std::string preset : {"tail", "group", "ldp"}) {
    FitOptions options = MakePreset(preset).value();
    ASSERT_FALSE(PrepareFit(recordings, &options));
    const FitProblem problem(recordings, options);
    FitPoint point = problem.NominalPoint();
    for (size_t i = 0; i < point.shared.size(); ++i) {
      const Parameter id = problem.map().fitted[i].parameter;
      if (id == kMu) point.shared[i] = -20.0;
      if (id == kBx) point.shared[i] = -1.0;
    }
    const FitProblem::Built built = problem.Build(&point, 0);
    std::vector<double> gradient, at = point.Flat();
    ASSERT_TRUE(built.problem->Evaluate({}, nullptr, nullptr, &gradient, nullptr)) << preset;
    ASSERT_EQ(gradient.size(), at.size());
    for (size_t i = 0; i < at.size(); ++i) {
      const double step = 1e-6 * std::max(1.0, std::abs(at[i]));
      double cost[2];
      for (int up : {0, 1}) {
        std::vector<double> moved = at;
        moved[i] += up == 1 ? step : -step;
        point.SetFlat(moved);
        ASSERT_TRUE(built.problem->Evaluate({}, &cost[up], nullptr, nullptr, nullptr));
      }
      const double numeric = (cost[1] - cost[0]) / (2.0 * step);
      EXPECT_NEAR(gradient[i], numeric, 1e-4 * std::abs(numeric) + 1e-6 * cost[0])
          << preset << ", number " << i;
    }
  }
}

}  // namespace
}  // namespace pushid
