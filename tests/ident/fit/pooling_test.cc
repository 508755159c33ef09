// Parameters by subject, tied to a shared value; initial velocities that are fitted.
#include <gtest/gtest.h>

#include "ident/fit/fit.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/evaluation.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "models/rollout.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

// Two people whose friction differs by a factor of two, noise-free.
std::vector<PendulumRecording> TwoFrictions(const SyntheticOptions& base) {
  std::vector<PendulumRecording> all;
  for (double factor : {1.0, 2.0}) {
    SyntheticOptions study = base;
    study.subjects = 1;
    study.seed = factor > 1.0 ? 2 : 1;
    study.parameters[kMu] *= factor;
    for (PendulumRecording& r : MakePendulums(study)) {
      r.subject_ids[0] = factor > 1.0 ? "rough" : "smooth";
      r.id = r.subject_ids[0] + "/" + r.id;
      all.push_back(r);
    }
  }
  return all;
}

TEST(Pooling, SubjectsKeepTheirOwnAndShrinkTogether) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = TwoFrictions(study);
  double last = 1e9;
  for (double sigma : {100.0, 0.2, 0.02, 0.002}) {
    FitOptions options = ExactFit(study);
    options.table[kMu].pooled = true;
    options.table[kMu].pooling_sigma = sigma;
    options.pooling_sigma = sigma;
    const FitResult result = Fit(recordings, options);
    ASSERT_TRUE(result.ok());
    ASSERT_EQ(result.subjects.size(), 2u);
    const Estimate& smooth = result.subjects.at("smooth").pooled.at("mu");
    const Estimate& rough = result.subjects.at("rough").pooled.at("mu");
    const double apart = rough.value - smooth.value;
    if (sigma == 100.0) {
      EXPECT_NEAR(smooth.value, study.parameters[kMu], 0.1);
      EXPECT_NEAR(rough.value, 2.0 * study.parameters[kMu], 0.1);
    }
    EXPECT_GT(apart, 0.0);
    EXPECT_LT(apart, last + 1e-9);
    last = apart;
    EXPECT_EQ(ModelOf(result).For("rough")[kMu], rough.value);
    EXPECT_EQ(ModelOf(result).For("a stranger")[kMu], result.parameters[kMu]);
    EXPECT_EQ(result.nuisance.size(), 2u);
    EXPECT_GE(rough.upper95, rough.value);
  }
  EXPECT_LT(last, 1.0);
}

// Two settings in which people touch at different distances: what two people share may differ by
// setting, and every setting has its settling simulations.
TEST(Pooling, SettingsKeepTheirOwnContact) {
  SyntheticOptions study = TinyStudy();
  study.joint_noise_m = 0.0;
  study.subjects = study.people_in_row = 3;
  study.frames = 60;
  study.model.interaction.spring = study.model.interaction.damping = true;
  study.parameters[kContactStiffness] = 2500.0, study.parameters[kContactKappa] = 0.5;
  study.parameters[kContactDamping] = 200.0, study.parameters[kContactHeight] = 0.5;
  std::vector<PendulumRecording> recordings;
  for (double distance : {0.38, 0.46}) {
    study.parameters[kContactDistance] = distance;
    for (PendulumRecording& r : MakePendulums(study)) {
      r.labels.Set(kSettingLabel, distance < 0.4 ? "near" : "far");
      recordings.push_back(r);
    }
  }
  FitOptions options = UnbiasedFit(study);
  FreeTerms(&options);
  for (ParameterSpec& spec : options.table.specs) spec.prior.reset();
  options.pool_by = kSettingLabel;
  options.table[kContactDistance].pooled = true;
  options.pooling_sigma = options.table[kContactDistance].pooling_sigma = 10.0;
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  EXPECT_NEAR(result.settings.at("near").at("contact_distance").value, 0.38, 1e-3);
  EXPECT_NEAR(result.settings.at("far").at("contact_distance").value, 0.46, 1e-3);
  const IdentifiedModel model = ModelOf(result);
  EXPECT_EQ(model.For("far")[kContactDistance],
            result.settings.at("far").at("contact_distance").value);
  EXPECT_NEAR(model.For("far")[kContactStiffness], 2500.0, 5.0);
  EXPECT_NEAR(model.For("elsewhere")[kContactDistance], std::sqrt(0.38 * 0.46), 0.01);
  EXPECT_LT(ScoreModel(model, recordings.front()).value[kHipAde], 1e-3);
  EXPECT_LT(ScoreModel(model, recordings.back()).value[kHipAde], 1e-3);
  int simulations = 0;
  for (const SettlingSimulation& d : result.behaviour.simulations) {
    simulations += d.setting == "near";
  }
  EXPECT_EQ(simulations, 12);
}

TEST(FreeVelocity, StartsThatMoveAreRecovered) {
  const SyntheticOptions study = SmallStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  const Vector4<double> velocity(0.15, -0.05, 0.1, 0.05);
  // Roll one recording out again from a moving start.
  PendulumRecording& moving = recordings[4];
  Scene scene = moving.scene;
  scene.people[0].start.qd = velocity;
  RolloutPath<double> path;
  const int frames = moving.num_frames();
  ASSERT_TRUE(
      Rollout<double>(scene, study.model, {study.parameters}, {velocity}, frames, &path).ok);
  for (int t = 0; t < frames; ++t) {
    moving.states[0][t] = path.At(t, 0);
    moving.hip[0][t] = HipPosition(scene.people[0].body, path.At(t, 0).q);
  }
  moving.initial_velocity = InitialVelocity::kFree;
  const FitOptions options = ExactFit(study);
  const FitProblem problem(recordings, options);
  const Solution solution = Solve(problem);
  ASSERT_TRUE(solution.ok());
  const std::vector<double>& found = solution.start.to.velocity.at(4);
  ASSERT_EQ(found.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[i], velocity[i], 1e-6) << i;
  const ParameterSet<double> p = problem.Parameters(solution.start.to, "");
  for (Parameter id : options.table.Free()) {
    const double truth = study.parameters[id];
    EXPECT_NEAR(p[id], truth, 1e-6 * std::max(1.0, std::abs(truth))) << kParameterNames[id];
  }
  const Uncertainty u = ComputeUncertainty(problem, solution.start.to);
  EXPECT_EQ(u.estimates.size(), options.table.Free().size() + 4);
  EXPECT_NE(FindEstimate(u.estimates, "initial xd[" + moving.id + "]"), nullptr);
}

}  // namespace
}  // namespace pushid
