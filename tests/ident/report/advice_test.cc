// What is advised after a fit of people whose model is known.
#include "ident/report/advice.h"

#include <algorithm>

#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/report/report_text.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticOptions AdvisedStudy(uint64_t seed) {
  SyntheticOptions study;
  study.subjects = 6;
  study.recordings_per_subject = 3;
  study.frames = 70;
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.003;
  study.subject_spread = 0.1;
  study.seed = seed;
  return study;
}

FittedModel AdvisedFit(const SyntheticOptions& study,
                       FitOptions options = MakePreset("tail").value()) {
  const auto recordings = MakePendulums(study);
  EXPECT_FALSE(PrepareFit(recordings, &options));
  FittedModel model;
  model.fit = Fit(recordings, options);
  EXPECT_TRUE(model.fit.ok());
  return model;
}

bool ProposesTerms(const FittedModel& model) {
  for (const Advice& advice : Advise(model)) {
    for (const char* words : {"--self_force", "--free", "--rod", "--interaction"}) {
      if (advice.command.find(words) != std::string::npos) return true;
    }
  }
  return false;
}

// The model made the recordings: every further term is truly zero.
TEST(Advice, ProposesNoTermThatIsZero) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const FittedModel model = AdvisedFit(AdvisedStudy(seed));
    EXPECT_FALSE(model.fit.verdict.assumptions.empty());
    EXPECT_FALSE(ProposesTerms(model));
  }
}

// A term that is there, and left out of the fit, is found by its score; at 120 frames a second, as
// at 60 the stated error of the integrator's step could explain more of it.
TEST(Advice, ScoresFindAMissingTerm) {
  constexpr uint64_t kStudies = 10;
  int found = 0;
  for (uint64_t seed = 1; seed <= kStudies; ++seed) {
    SyntheticOptions study = AdvisedStudy(seed);
    study.subject_spread = 0.02;
    study.fps *= 2.0;
    study.frames *= 2;
    study.parameters[kTx] = 1.5;
    const FittedModel model = AdvisedFit(study, HoldDamping(MakePreset("tail").value()));
    const auto& tests = model.fit.verdict.assumptions;
    const auto missing = std::find_if(tests.begin(), tests.end(),
                                      [](const AssumptionTest& t) { return t.name == "t_x"; });
    ASSERT_NE(missing, tests.end());
    EXPECT_LT(missing->p, 0.05) << "study " << seed;
    found += missing->p < 0.01;
  }
  EXPECT_GE(found, 8);
}

// Where priors decide, the advice is to look at them, and no term.
// A command that pools what it fixes would be refused.
TEST(FitCommand, WhatIsFixedIsNeitherFreeNorPooled) {
  Provenance from;
  from.configuration = {{"free", "mu"}, {"pool", "mu,a_x"}, {"fix", "c_q"}};
  from.changed_flags = {"free", "pool", "fix"};
  EXPECT_EQ(FitCommand("pushid-fit", from).Append("fix", "mu=3").ToString(),
            "pushid-fit --recordings=M/manifest.json --free='' --pool=a_x --fix=c_q,mu=3");
  from.configuration["pool"] = "mu";
  EXPECT_TRUE(
      Contains(FitCommand("pushid-fit", from).Append("fix", "mu").ToString(), "--pool=none"));
}

}  // namespace
}  // namespace pushid
