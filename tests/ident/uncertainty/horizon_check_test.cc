// Estimates from fewer frames: what means something keeps its value, what stands for something that
// the model leaves out drifts. And estimates under other priors.
#include <gtest/gtest.h>

#include <limits>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/push/push_check.h"
#include "ident/report/report_text.h"
#include "ident/solver/solver.h"
#include "ident/uncertainty/refit_checks.h"
#include "ident/uncertainty/uncertainty.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

FittedModel Checked(const std::vector<PendulumRecording>& recordings, const FitOptions& options) {
  FittedModel model;
  model.fit = Fit(recordings, options);
  AddHorizonCheck(recordings, 2, nullptr, &model);
  return model;
}

// By hand: 3 errors of the larger kind apart at 8 frames, 1 at 16; an infinite error tells nothing.
TEST(Drifts, AreJudgedByTheLargerError) {
  RefitTable table;
  table.parameters = {"mu", "a_x", "tail_gain"};
  table.units = {"N s/m", "m/s^2/rad", "1"};
  table.value = {10.0, -9.0, 1.0};
  table.standard_error = {1.0, 2.0, 0.1};
  const double infinity = std::numeric_limits<double>::infinity();
  table.rows = {{"horizon", "one step", {90.0, -50.0, 1.0}, {2.0, 1.0, 0.1}, "", kOneStep},
                {"horizon", "8 frames", {16.0, -8.0, 5.0}, {2.0, 1.0, infinity}, "", 8},
                {"horizon", "16 frames", {11.0, -9.0, 1.1}, {1.0, 1.0, 0.1}, "", 16},
                {"horizon", "32 frames", {}, {}, "no start could be solved", 32}};
  const std::vector<Drift> drifts = Drifts(table);
  ASSERT_EQ(drifts.size(), 1u);
  EXPECT_EQ(drifts[0].parameter, 0u);
  EXPECT_EQ(drifts[0].row, 1u) << "single steps do not drift";
  EXPECT_DOUBLE_EQ(drifts[0].in_errors, 3.0);
  EXPECT_TRUE(
      Contains(DriftText(table), "mu drifts: 16 +- 2 in the first 8 frames of the push, 10 +- 1"));
  EXPECT_FALSE(Contains(DriftText(table), "a_x drifts"));
  EXPECT_TRUE(Contains(DriftText(table), "single steps give other values of mu, a_x (more than"));
  EXPECT_TRUE(Contains(HorizonTable(table).ToString(), "-"));
}

// What other pushes do says nothing where those of the same window are other pushes.
TEST(PushCheckText, SaysBeforeTheTableThatItsErrorsAreNone) {
  RefitTable table;
  table.parameters = {"mu"};
  table.units = {"N s/m"};
  table.value = {10.0};
  table.standard_error = {1.0};
  table.rows = {{"window", "-2 frames", {14.0}, {}, "", 0},
                {"window", kSameWindow, {11.0}, {}, "", 0}};
  EXPECT_TRUE(Contains(PushErrorTable(table).ToString(), "2.92"));
  table.rows[1].value[0] = 15.0;
  EXPECT_FALSE(Contains(PushErrorTable(table).ToString(), "4.5"));
  EXPECT_EQ(PushCheckText(table).find("even the same window moves mu by 5 standard errors"), 0u);
}

// An interval that other priors leave is not the data's.
TEST(PriorCheck, SaysWhoseIntervalOtherPriorsLeave) {
  Uncertainty uncertainty;
  uncertainty.estimates.resize(2);
  uncertainty.estimates[0].lower95 = 8.0;
  uncertainty.estimates[0].upper95 = 12.0;
  uncertainty.estimates[1].lower95 = -11.0;
  uncertainty.estimates[1].upper95 = -7.0;
  RefitTable table;
  table.parameters = {"mu", "a_x"};
  table.units = {"N s/m", "m/s^2/rad"};
  table.value = {10.0, -9.0};
  table.standard_error = {1.0, 1.0};
  table.rows = {{"priors", "halved", {9.5, -8.0}, {}, "", 0},
                {"priors", "doubled", {13.0, -9.5}, {}, "", 0}};
  EXPECT_FALSE(PriorsLeaveInside(table, 0, uncertainty));
  EXPECT_TRUE(PriorsLeaveInside(table, 1, uncertainty));
  EXPECT_TRUE(Contains(PriorCheckText(table),
                       "determined by priors, as they move by more than twice their errors: mu\n"));
  table.rows[1].value.clear();
  table.rows[1].failure = "did not converge";
  EXPECT_FALSE(PriorsLeaveInside(table, 1, uncertainty)) << "a refit that failed says nothing";
  EXPECT_TRUE(Contains(PriorCheckText(table), "priors doubled: did not converge"));
}

// The model that made the motion: horizons beyond the push find the same parameters.
TEST(HorizonCheck, TheTruthDoesNotDrift) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.0005;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FittedModel model = Checked(recordings, options);
  const RefitTable& check = *model.horizon_check;
  ASSERT_EQ(check.rows.size(), 5u);  // one step; 8, 16, 32 and 64 of 69
  EXPECT_EQ(check.rows[0].frames, kOneStep);
  EXPECT_EQ(check.rows[1].frames, 8);
  EXPECT_LT(check.rows[4].standard_error[0], check.rows[2].standard_error[0])
      << "more frames tell more";
  // While the push lasts a fit without priors may end anywhere; from 32 frames on it may not.
  RefitTable later = check;
  later.rows.erase(later.rows.begin(), later.rows.begin() + 3);
  for (const Drift& drift : Drifts(later)) {
    EXPECT_LT(drift.in_errors, 4.0) << check.parameters[drift.parameter];
  }
}

// The same recordings, with people who stand for `frames` frames before they are pushed.
std::vector<PendulumRecording> Waiting(std::vector<PendulumRecording> recordings, int frames) {
  for (PendulumRecording& r : recordings) {
    for (int n = 0; n < r.num_people(); ++n) {
      r.states[n].insert(r.states[n].begin(), frames, r.states[n][0]);
      r.rod_length[n].insert(r.rod_length[n].begin(), frames, r.rod_length[n][0]);
      r.hip[n].insert(r.hip[n].begin(), frames, r.hip[n][0]);
    }
    for (ScenePush& push : r.scene.pushes) push.start_frame += frames;
  }
  return recordings;
}

// Of frames before the push nothing is learned: they move neither stages nor horizons.
TEST(HorizonCheck, HorizonsCountFromThePush) {
  SyntheticOptions study = TinyStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.0005;
  const std::vector<PendulumRecording> at_once = MakePendulums(study);
  const std::vector<PendulumRecording> later = Waiting(at_once, 50);
  EXPECT_EQ(PushFrame(later[0]), PushFrame(at_once[0]) + 50);
  FitOptions options = UnbiasedFit(study), same = options;
  ASSERT_FALSE(PrepareFit(at_once, &options));
  ASSERT_FALSE(PrepareFit(later, &same));
  const FitProblem problem(later, same);
  EXPECT_EQ(problem.Frames(0, 8), PushFrame(later[0]) + 8);
  EXPECT_EQ(problem.Frames(0, 0), 0) << "all";
  const FittedModel one = Checked(at_once, options), other = Checked(later, same);
  ASSERT_EQ(one.horizon_check->rows.size(), other.horizon_check->rows.size());
  for (size_t r = 0; r < one.horizon_check->rows.size(); ++r) {
    const RefitRow &a = one.horizon_check->rows[r], &b = other.horizon_check->rows[r];
    if (a.frames == kOneStep) continue;  // its noise is of all steps
    ASSERT_EQ(a.value.size(), b.value.size()) << a.name;
    EXPECT_NEAR(b.value[0], a.value[0], 0.01 * a.standard_error[0]) << a.name;
  }
}

// Feet that drag more and more: one friction cannot be right for every horizon.
TEST(HorizonCheck, WhatTheModelLeavesOutDrifts) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.0005;
  study.parameters[kCq] = 0.8;  // quadratic drag, which the fit does not have
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  options.table[kCq].nominal = 0.0;
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FittedModel model = Checked(recordings, options);
  EXPECT_FALSE(Drifts(*model.horizon_check).empty());
  EXPECT_TRUE(Contains(DriftText(*model.horizon_check), "drifts"));
}

// Refits under other priors: what they hold, and from where they start.
class PriorCheckOf : public ::testing::Test {
 protected:
  PriorCheckOf() : study_(TinyStudy()) {
    study_.push_kind = PushKind::kExternal;
    study_.joint_noise_m = 0.0005;
    recordings_ = MakePendulums(study_);
    options_ = UnbiasedFit(study_);
    options_.table[kMu].prior = Prior{30.0, 100.0};  // which the recordings outweigh
  }
  void Prepare() { ASSERT_FALSE(PrepareFit(recordings_, &options_)); }
  // Of the check, asked from a point: of the best one, no parameter is moved by a standard error.
  void ExpectNothingMoves(const FitPoint* from = nullptr) {
    const FitProblem problem(recordings_, options_);
    const FitPoint best = Solve(problem).Best().to;
    const Uncertainty uncertainty = ComputeUncertainty(problem, best);
    const RefitTable known = RefitTableOf(problem, best, uncertainty);
    const RefitTable check = CheckPriors(problem, from != nullptr ? *from : best, uncertainty);
    ASSERT_EQ(check.rows.size(), 2u);
    for (const RefitRow& row : check.rows) {
      ASSERT_EQ(row.value.size(), known.value.size()) << row.name << ": " << row.failure;
      for (size_t i = 0; i < known.value.size(); ++i) {
        EXPECT_NEAR(row.value[i], known.value[i], known.standard_error[i])
            << known.parameters[i] << ", priors " << row.name;
      }
    }
  }

  SyntheticOptions study_;
  std::vector<PendulumRecording> recordings_;
  FitOptions options_;
};

// Stiffness that is halved with its prior would let people fall.
TEST_F(PriorCheckOf, AFixedParameterKeepsItsValue) {
  ParameterSpec& stiffness = options_.table[kKpTheta];
  stiffness.free = false;
  stiffness.nominal = study_.parameters[kKpTheta];
  stiffness.prior = Prior{study_.parameters[kKpTheta], study_.parameters[kKpTheta]};
  Prepare();
  ExpectNothingMoves();
}

TEST_F(PriorCheckOf, AsksNothingOfAModelWithoutPriors) {
  options_.table[kMu].prior.reset();
  options_.table[kKpX].prior = Prior{10.0, 10.0};  // of what is held
  Prepare();
  const FitProblem problem(recordings_, options_);
  const FitPoint point = problem.NominalPoint();
  EXPECT_TRUE(CheckPriors(problem, point, ComputeUncertainty(problem, point)).rows.empty());
}

// Where the estimate is no good start - here people fall who are hardly held - the centres of the
// priors are one.
TEST_F(PriorCheckOf, StartsFromTheCentresToo) {
  Prepare();
  const FitProblem problem(recordings_, options_);
  FitPoint poor = problem.NominalPoint();
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    if (fitted[i].parameter == kMu) poor.shared[i] = ToFitted(fitted[i].transform, -1900.0);
    if (fitted[i].parameter == kKpTheta) poor.shared[i] = ToFitted(fitted[i].transform, 2.0);
  }
  ExpectNothingMoves(&poor);
}

// Feet that are slow to stop: a demand to settle within two seconds is dropped, as by a fit.
TEST(PriorCheck, DropsADemandThatIsContradicted) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.002;
  study.parameters[kMu] = 12.0;
  study.parameters[kKpTheta] = 2200.0;
  study.parameters[kAx] = -6.0;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult fit = Fit(recordings, options);
  ASSERT_EQ(fit.options.settling_weight, 0.0) << "dropped";
  const FitPoint& estimate = fit.starts[fit.best_start].to;
  FitOptions demanding = fit.options;
  demanding.settling_weight = options.settling_weight;
  const FitProblem problem(recordings, demanding);
  const double held = SharedValues(problem, Refit(problem, estimate).to)[0];
  const RefitTable check = CheckPriors(problem, estimate, fit.uncertainty);
  ASSERT_EQ(check.rows.size(), 2u);
  ASSERT_EQ(check.parameters[0], "mu");
  EXPECT_GT(held, check.value[0] + 1.0);
  for (const RefitRow& row : check.rows) {
    ASSERT_FALSE(row.value.empty()) << row.failure;
    EXPECT_NEAR(row.value[0], check.value[0], 0.5) << row.name;
  }
}

}  // namespace
}  // namespace pushid
