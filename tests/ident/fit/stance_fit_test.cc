// Feet that hold and step: what made synthetic recordings is found again, and who steps is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/fit/step_probability.h"
#include "ident/model/identified_model.h"
#include "ident/prediction/evaluation.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Pushes of which some make people step and some do not.
SyntheticOptions StandingStudy(PushKind kind, double noise) {
  SyntheticOptions study;
  study.model.stance = Stance::kSteps;
  study.model.push = PushUse::kAsRecorded;
  study.parameters = PublishedStanceParameters();
  study.push_kind = kind;
  study.strengths = {{"weak", 0.8}, {"medium", 2.2}, {"strong", 3.0}};
  study.frames = 100;
  study.joint_noise_m = noise;
  study.direction_sigma_rad = 0.1;
  return study;
}

constexpr Parameter kFree[] = {kKpTheta,  kKdTheta,   kSupportFront,
                               kStepGain, kStepOnset, kStepSwing};

FitOptions FreeStance(const SyntheticOptions& study) {
  FitOptions options = MakePreset("tail").value();
  SetStance(Stance::kSteps, &options);
  options.pool = "none";
  options.pool_by = kSubjectUnit;
  for (ParameterSpec& spec : options.table.specs) {
    spec.prior.reset();
    spec.free = false;
    spec.nominal = study.parameters[spec.id];
  }
  for (Parameter id : kFree) options.table[id].free = true;
  (void)PoolParameters(&options);
  options.model = study.model;
  options.settling_weight = 0.0;
  return options;
}

// Whether a foot steps has no derivative: where one more step is taken the cost jumps, and a fit
// may end beside it.
constexpr double kBeside = 0.01;  // of the truth

TEST(StanceFit, ExactRecordingsGiveTheTruthFromMostStarts) {
  const SyntheticOptions study = StandingStudy(PushKind::kExternal, 0.0);
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  int found = 0;
  for (double wrong : {0.75, 0.8, 0.85, 0.9, 1.1, 1.15, 1.2, 1.25, 1.3}) {
    FitOptions options = FreeStance(study);
    for (Parameter id : kFree) options.table[id].nominal *= wrong;
    options.estimate_weights = false;
    options.effective_weight = 1.0;
    options.function_tolerance = 1e-16;
    const FitResult fit = Fit(recordings, options);
    ASSERT_TRUE(fit.ok()) << wrong << ": " << fit.message;
    found += std::all_of(std::begin(kFree), std::end(kFree), [&](Parameter id) {
      return std::abs(fit.parameters[id] / study.parameters[id] - 1.0) < kBeside;
    });
  }
  EXPECT_GE(found, 6);
}

TEST(StanceFit, NoisyRecordingsHoldTheTruthWithinTheirErrors) {
  for (double noise : {0.001, 0.003, 0.01}) {
    for (PushKind kind : {PushKind::kExternal, PushKind::kNet}) {
      SyntheticOptions study = StandingStudy(kind, noise);
      study.noise_at_first_frame = false;
      const FitOptions options = FreeStance(study);
      const FitResult fit = Fit(MakePendulums(study), options);
      ASSERT_TRUE(fit.ok()) << fit.message;
      for (Parameter id : kFree) {
        const Estimate* e = FindEstimate(fit.estimates, options.table[id].name);
        ASSERT_NE(e, nullptr);
        const double truth = study.parameters[id];
        EXPECT_LT(std::abs(e->value - truth), 4.5 * e->standard_error + kBeside * truth)
            << e->name << " " << e->value << " +- " << e->standard_error << " at noise " << noise;
      }
    }
  }
}

// Feet that hold: pushes from all sides, gains that differ by direction.
SyntheticOptions HeldStudy(double noise) {
  SyntheticOptions study = StandingStudy(PushKind::kExternal, noise);
  study.model.stance = Stance::kFixed;
  study.parameters[kKpTheta] = 1300.0, study.parameters[kKpPhi] = 1600.0;
  study.parameters[kKdTheta] = 330.0, study.parameters[kKdPhi] = 250.0;
  study.parameters[kComHeight] = 1.05;
  study.strengths = {{"weak", 0.4}, {"medium", 0.8}, {"strong", 1.2}};
  study.direction_sigma_rad = 1.0;
  study.noise_at_first_frame = false;
  return study;
}

constexpr Parameter kHeld[] = {kKpTheta, kKpPhi, kKdTheta, kKdPhi, kComHeight};

TEST(StanceFit, WhoStandsIsFittedStandingByDefault) {
  const SyntheticOptions study = HeldStudy(0.002);
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = MakeFitOptions({}, &recordings).value();
  ASSERT_EQ(options.model.stance, Stance::kFixed);
  ASSERT_FALSE(PrepareFit(recordings, &options).has_value());
  const FitResult fit = Fit(recordings, options);
  ASSERT_TRUE(fit.ok()) << fit.message;
  EXPECT_TRUE(fit.behaviour.settles);
  for (Parameter id : kHeld) {
    const Estimate* e = FindEstimate(fit.estimates, options.table[id].name);
    ASSERT_NE(e, nullptr);
    EXPECT_LT(std::abs(e->value - study.parameters[id]), 4.0 * e->standard_error)
        << e->name << " " << e->value << " +- " << e->standard_error;
  }
  EXPECT_EQ(FindEstimate(fit.estimates, "mu"), nullptr);
  for (const Combination& c : fit.derived) EXPECT_EQ(c.name.rfind("c_", 0), std::string::npos);
}

TEST(StanceFit, ExactStandingGivesTheTruthFromAnotherStart) {
  const SyntheticOptions study = HeldStudy(0.0);
  FitOptions options = MakeFitOptions({{"preset", "tail"}, {"stance", "fixed"}}).value();
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.estimate_weights = false;
  options.effective_weight = 1.0;
  options.function_tolerance = 1e-16;
  const FitResult fit = Fit(MakePendulums(study), options);
  ASSERT_TRUE(fit.ok()) << fit.message;
  for (Parameter id : kHeld) {
    EXPECT_NEAR(fit.parameters[id], study.parameters[id], 1e-4 * study.parameters[id])
        << options.table[id].name;
  }
}

// Nobody asked for a stance, and the one that the feet suggest loses to standing still.
TEST(StanceFit, AFitThatLosesToStaticTriesTheOtherStances) {
  const std::vector<PendulumRecording> recordings =
      MakePendulums(StandingStudy(PushKind::kExternal, 0.0005));
  const FitSetup setup = Unwrapped(FitSetup::Make({{"preset", "tail"}, {"pool", "none"}}));
  // On ice: the feet of the model run from under who is pushed.
  FitOptions ice = MakePreset("tail").value();
  for (ParameterSpec& spec : ice.table.specs) spec.free = spec.pooled = false;
  ice.table[kMu].nominal = 5.0;
  ice.table[kKpTheta].nominal = 3000.0;
  ice.table[kAx].nominal = 0.0;
  ice.table[kKdTheta].free = true;
  ASSERT_FALSE(PrepareFit(recordings, &ice));
  const std::vector<FitOptions> others = setup.OtherStances(recordings, ice);
  ASSERT_FALSE(others.empty());
  const FitResult fit = FitAnyStance(recordings, ice, others);
  ASSERT_TRUE(fit.ok()) << fit.message;
  EXPECT_EQ(fit.options.model.stance, Stance::kSteps);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_TRUE(Contains(fit.warnings[0].text, "this is the fit with --stance=steps"))
      << fit.warnings[0].text;
  const FitSetup asked = Unwrapped(FitSetup::Make({{"preset", "tail"}, {"stance", "slide"}}));
  EXPECT_TRUE(asked.OtherStances(recordings, ice).empty()) << "who asks for one has it";
}

TEST(StanceFit, TellsWhoSteps) {
  const SyntheticOptions study = StandingStudy(PushKind::kExternal, 0.001);
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  IdentifiedModel model;
  model.options = study.model;
  model.parameters = study.parameters;
  int stepped = 0;
  for (const PendulumRecording& recording : recordings) stepped += recording.Stepped(0);
  ASSERT_GT(stepped, 2);
  ASSERT_LT(stepped, static_cast<int>(recordings.size()) - 2);
  model.step_probability = FitStepProbability(model, recordings);
  ASSERT_TRUE(model.step_probability.has_value());
  const StepScore score = Evaluate(model, recordings).model.steps;
  EXPECT_EQ(score.tracks, static_cast<int>(recordings.size()));
  EXPECT_EQ(score.stepped, stepped);
  EXPECT_GT(score.auc, 0.95);
  EXPECT_LT(score.brier, 0.08);
}

}  // namespace
}  // namespace pushid
