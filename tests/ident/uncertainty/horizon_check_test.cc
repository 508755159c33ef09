// Estimates from fewer frames: what means something keeps its value, what stands for something that
// the model leaves out drifts.
#include <gtest/gtest.h>

#include <limits>

#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/uncertainty.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

HorizonCheck Checked(const std::vector<PendulumRecording>& recordings, const FitOptions& options) {
  const FitResult fit = Fit(recordings, options);
  return CheckHorizons(FitProblem(recordings, fit.options), fit.starts[fit.best_start].to,
                       fit.uncertainty, 2);
}

// By hand: 3 errors of the larger kind apart at 8 frames, 1 at 16; an infinite error tells nothing.
TEST(Drifts, AreJudgedByTheLargerError) {
  HorizonCheck check;
  check.parameters = {"mu", "a_x", "tail_gain"};
  check.units = {"N s/m", "m/s^2/rad", "1"};
  check.value = {10.0, -9.0, 1.0};
  check.standard_error = {1.0, 2.0, 0.1};
  const double infinity = std::numeric_limits<double>::infinity();
  check.refits = {{8, {16.0, -8.0, 5.0}, {2.0, 1.0, infinity}, ""},
                  {16, {11.0, -9.0, 1.1}, {1.0, 1.0, 0.1}, ""},
                  {32, {}, {}, "no start could be solved"}};
  const std::vector<Drift> drifts = Drifts(check);
  ASSERT_EQ(drifts.size(), 1u);
  EXPECT_EQ(drifts[0].parameter, 0u);
  EXPECT_EQ(drifts[0].refit, 0u);
  EXPECT_DOUBLE_EQ(drifts[0].in_errors, 3.0);
  const std::string text = DriftText(check);
  EXPECT_TRUE(Contains(text, "mu drifts: 16 +- 2 in the first 8 frames of the push, 10 +- 1"));
  EXPECT_FALSE(Contains(text, "a_x drifts"));
  EXPECT_TRUE(Contains(text, "32 frames: no start could be solved"));
  EXPECT_TRUE(Contains(HorizonTable(check).ToString(), "-"));
}

// The model that made the motion: horizons beyond the push find the same parameters.
TEST(HorizonCheck, TheTruthDoesNotDrift) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.0005;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  ASSERT_FALSE(PrepareFit(recordings, &options));
  HorizonCheck check = Checked(recordings, options);
  ASSERT_EQ(check.refits.size(), 4u);  // 8, 16, 32 and 64 of 69
  EXPECT_EQ(check.refits[0].frames, 8);
  EXPECT_LT(check.refits[3].standard_error[0], check.refits[1].standard_error[0])
      << "more frames tell more";
  // While the push lasts a fit without priors may end anywhere; from 32 frames on it may not.
  check.refits.erase(check.refits.begin(), check.refits.begin() + 2);
  for (const Drift& drift : Drifts(check)) {
    EXPECT_LT(drift.in_errors, 4.0) << check.parameters[drift.parameter];
  }
}

// Recordings with people who stand for `frames` frames before they are pushed.
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

// Nothing is learned of frames before the push: they move neither stages nor horizons.
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
  const HorizonCheck one = Checked(at_once, options), other = Checked(later, same);
  ASSERT_EQ(one.refits.size(), other.refits.size());
  for (size_t r = 0; r < one.refits.size(); ++r) {
    const HorizonFit &a = one.refits[r], &b = other.refits[r];
    ASSERT_EQ(a.value.size(), b.value.size()) << a.frames;
    EXPECT_NEAR(b.value[0], a.value[0], 0.01 * a.standard_error[0]) << a.frames;
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
  const HorizonCheck check = Checked(recordings, options);
  EXPECT_FALSE(Drifts(check).empty());
  EXPECT_TRUE(Contains(DriftText(check), "drifts"));
}

}  // namespace
}  // namespace pushid
