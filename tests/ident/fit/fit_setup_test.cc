// From named options to a fit: presets, edits, what acts on nothing, and what a fit is prepared
// for.
#include "ident/fit/fit_setup.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <tuple>

#include "ident/fit/fit.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/option_table.h"
#include "ident/problem/fit_problem.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// All that decides what a fit of given recordings finds.
nlohmann::ordered_json SettingsJson(const FitOptions& options) {
  return {{"model", OptionsJson(options)}, {"table", TableJson(options.table)}};
}

std::string Complaint(const GivenOptions& given) {
  const Result<FitOptions> options = MakeFitOptions(given, nullptr, given);
  return options.ok() ? "" : options.error().ToString();
}

TEST(FitSetup, OptionsOverThePreset) {
  const FitOptions plain = MakeFitOptions({}).value();
  EXPECT_EQ(plain.preset, "tail");  // auto, and no recordings are known
  const FitOptions o = MakeFitOptions({{"fix", "mu=30"},
                                       {"self_force", "linear"},
                                       {"preset_priors", "false"},
                                       {"prior", "a_x:-9:3"}})
                           .value();
  EXPECT_EQ(o.self_force, SelfForceKind::kLinear);
  EXPECT_FALSE(o.table[kMu].free);
  EXPECT_EQ(o.table[kMu].nominal, 30.0);
  EXPECT_TRUE(o.table[kBx].free);
  EXPECT_FALSE(o.table[kBx].prior);
  EXPECT_EQ(o.table[kAx].prior->mean, -9.0);  // an edit comes after the preset's priors went
}

TEST(FitSetup, PoolingFollowsTheTerms) {
  const FitOptions group = MakeFitOptions({{"preset", "group"}}).value();
  EXPECT_TRUE(group.table[kContactDistance].pooled);
  const FitOptions undamped =
      MakeFitOptions({{"preset", "group"}, {"interaction", "spring"}}).value();
  EXPECT_TRUE(undamped.table[kContactStiffness].pooled);
  EXPECT_FALSE(undamped.table[kContactDamping].pooled);
  const FitOptions none = MakeFitOptions({{"preset", "group"}, {"pool", "none"}}).value();
  EXPECT_FALSE(AnyPooled(none.table));
}

// Groups have linear self forces where their feet slide alone, and the help says so.
TEST(FitSetup, ThePresetOfGroupsIsWhatItsHelpSays) {
  const auto self_force = [](const char* stance) {
    return MakeFitOptions({{"preset", "group"}, {"stance", stance}}).value().self_force;
  };
  EXPECT_EQ(self_force("slide"), SelfForceKind::kLinear);
  EXPECT_EQ(self_force("steps"), SelfForceKind::kNone);
  EXPECT_TRUE(Contains(FindFitOption("preset")->help, "feet that slide, linear self forces too"));
}

// The preset's own pooling gives way to what else is asked for; that of a user does not.
TEST(FitSetup, ThePresetPoolsWhatItCan) {
  const FitOptions tail = MakeFitOptions({{"preset", "tail"}}).value();
  EXPECT_TRUE(tail.table[kTailBase].pooled);
  EXPECT_EQ(tail.pool_by, kConditionLabel);
  EXPECT_EQ(tail.pooling_sigma, 0.5);
  for (const GivenOptions& given :
       {GivenOptions{{"fix", "tail_base"}}, GivenOptions{{"push_tail", "none"}}}) {
    const FitOptions made = Unwrapped(MakeFitOptions(Merged(given, {{"preset", "tail"}})));
    EXPECT_FALSE(AnyPooled(made.table)) << given[0].first;
  }
  // A large network is trained beside what units differ in.
  for (const auto& [preset, option, value] :
       {std::tuple("tail", "self_force", "ldp:64"),
        {"group", "interaction", "spring,damping,network:64-64"}}) {
    const FitOptions made = Unwrapped(MakeFitOptions({{"preset", preset}, {option, value}}));
    EXPECT_TRUE(NeedsGradientTraining(made));
    EXPECT_TRUE(AnyPooled(made.table)) << preset;
  }
  EXPECT_TRUE(Contains(Complaint({{"fix", "tail_time"}, {"pool", "tail_time"}}), "which is fixed"));
}

// Feet that hold bring what goes with them, and refuse what is for sliding feet.
TEST(FitSetup, StanceBringsWhatGoesWithIt) {
  const FitOptions slide = MakeFitOptions({{"preset", "tail"}}).value();
  EXPECT_EQ(slide.model.stance, Stance::kSlide);
  EXPECT_FALSE(slide.table[kStepOnset].free);
  const FitOptions holds = MakeFitOptions({{"preset", "tail"}, {"stance", "steps"}}).value();
  EXPECT_EQ(holds.model.push, PushUse::kAsRecorded);
  for (Parameter id :
       {kTailGain, kSupportFront, kStepOnset, kStepSwing, kKpTheta, kKpPhi, kKdTheta, kKdPhi}) {
    EXPECT_TRUE(holds.table[id].free) << holds.table[id].name;
    EXPECT_TRUE(holds.table[id].prior.has_value()) << holds.table[id].name;
  }
  for (Parameter id : {kTailTorque, kSupportBack}) {
    EXPECT_FALSE(holds.table[id].free) << holds.table[id].name;
  }
  for (const auto& [flag, value] : {std::pair("rod", "ldp:4"), std::pair("self_force", "ldp:64")}) {
    EXPECT_TRUE(Contains(Complaint({{"preset", "tail"}, {"stance", "steps"}, {flag, value}}),
                         "is for feet that slide"))
        << flag;
  }
  EXPECT_TRUE(Contains(Complaint({{"stance", "walk"}}), "--stance is 'walk'"));
}

TEST(PrepareFit, StepsNeedFrames) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  FitOptions options = MakeFitOptions({{"preset", "tail"}, {"stance", "steps"}}).value();
  recordings[2].scene.dt = 0.05;
  EXPECT_TRUE(Contains(PrepareFit(recordings, &options)->ToString(), "20 frames per second"));
}

TEST(FitSetup, AutoLooksAtTheRecordings) {
  const std::vector<PendulumRecording> single = MakePendulums(TinyStudy());
  EXPECT_EQ(MakeFitOptions({}, &single).value().preset, "tail");
  SyntheticOptions study = TinyStudy();
  study.subjects = study.people_in_row = 3;
  std::vector<PendulumRecording> groups = MakePendulums(study);
  const FitOptions o = MakeFitOptions({}, &groups).value();
  EXPECT_EQ(o.preset, "group");
  EXPECT_TRUE(o.model.interaction.Contact());
  groups.insert(groups.end(), single.begin(), single.end());
  EXPECT_EQ(MakeFitOptions({{"preset", "auto"}}, &groups).value().preset, "group");
  EXPECT_EQ(MakeFitOptions({{"preset", "tail"}}, &groups).value().preset, "tail");  // told so
  const FitSetup setup = Unwrapped(FitSetup::Make({{"fix", "mu=40"}}));
  for (const auto& recordings : {single, groups}) {
    const FitOptions made = MakeFitOptions({{"fix", "mu=40"}}, &recordings).value();
    EXPECT_EQ(SettingsJson(setup.For(recordings).value()), SettingsJson(made));
  }
}

TEST(FitSetup, LdpsLossWeighsItsRowsAlike) {
  const FitOptions o = MakeFitOptions({{"loss", "ldp"}}).value();
  EXPECT_EQ(o.sigmas.loss, FrameLoss::kLdp);
  EXPECT_EQ(o.sigmas.hip, 0.1);
  EXPECT_EQ(o.sigmas.velocity, 0.1);
  EXPECT_FALSE(EstimatesSigmas(o));
  EXPECT_EQ(OptionsFrom(OptionsJson(o)).sigmas.loss, FrameLoss::kLdp);
  EXPECT_EQ(MakeFitOptions({{"loss", "hip"}}).value().sigmas.hip, ResidualSigmas().hip);
}

TEST(FitSetup, WhatDoesNotGoTogetherIsNamed) {
  const auto violation = [](FitOptions o) {
    std::string error;
    EXPECT_FALSE(o.IsValid(&error));
    return error;
  };
  FitOptions o = MakeFitOptions({{"preset", "group"}}).value();
  o.model.interaction.learned = true;  // without its network
  EXPECT_TRUE(Contains(violation(o), "names a network to be fitted, but there is none"));
}

TEST(FitSetup, BadOptionsAreNamed) {
  const std::pair<GivenOptions, std::string> cases[] = {
      {{{"preset", "tial"}}, "--preset is 'tial'"},
      {{{"posture", "flat"}}, "--posture is 'flat'; it must be upright or initial"},
      {{{"marker_noise", "wide"}}, "--marker_noise is 'wide'; it must be positive"},
      {{{"max_iterations", "two"}}, "--max_iterations is 'two'; it must be a whole number"},
      {{{"max_iterations", "0"}}, "--max_iterations is 0; it must be positive"},
      {{{"friction", "anisotropic"}}, "--friction=anisotropic is for --preset=ldp"},
      {{{"seed", "-1"}}, "--seed is '-1'"},
      {{{"fix", "nu"}}, "--fix names 'nu'"},
      {{{"fix", "mu"}, {"free", "mu"}}, "mu is both fixed (--fix) and free (--free)"},
      {{{"free", "Kd_theta,mu=30"}, {"fix", "Kp_theta,mu=3"}}, "mu is both fixed"},
      {{{"fix", "mu=3,mu=4"}}, "--fix names mu twice"},
      {{{"interaction", "network"}}, "a network is network:4"},
      {{{"network_prior", "0.5"}}, "--network_prior acts on networks"},
      {{{"preset_priors", "of course"}},
       "--preset_priors is 'of course'; it must be true or false"},
      {{{"seed", "2x"}}, "--seed is '2x'"},
  };
  for (const auto& [given, says] : cases) EXPECT_TRUE(Contains(Complaint(given), says)) << says;
  EXPECT_EQ(Complaint({{"self_force", "mlp:4"}, {"network_prior", "0.5"}}), "");
}

// Before the recordings are known auto may be either preset: what one of them takes is no error.
TEST(FitSetup, OptionsOfGroupsAreNotRefusedTooEarly) {
  for (const GivenOptions& given :
       {GivenOptions{{"pool", "contact_stiffness"}},
        GivenOptions{
            {"fix", "mu,Kp_theta,Kd_theta,a_x,tail_gain,tail_torque,tail_time,tail_base"}}}) {
    EXPECT_EQ(Complaint(given), "") << given[0].first;
    EXPECT_FALSE(MakeFitOptions(Merged(given, {{"preset", "tail"}}), nullptr, given).ok());
  }
}

// Flags that a candidate takes over need not act in it; what it is given itself
// must.
TEST(FitSetup, OnlyACandidatesOwnOptionsMustAct) {
  const GivenOptions given = {{"self_force", "mlp:2"}, {"network_prior", "0.5"}};
  EXPECT_TRUE(MakeFitOptions(Merged(given, {{"self_force", "none"}})).ok());
  const GivenOptions more = {{"self_force", "none"}, {"network_prior", "1"}};
  EXPECT_FALSE(MakeFitOptions(Merged(given, more), nullptr, more).ok());
}

TEST(FitSetup, SeedsAndBoolsAsFlagsTakeThem) {
  EXPECT_EQ(MakeFitOptions({{"seed", "18446744073709551615"}}).value().seed, UINT64_MAX);
  for (const char* yes : {"true", "1", "yes"}) {
    EXPECT_TRUE(MakeFitOptions({{"preset_priors", yes}}).value().preset_priors) << yes;
  }
  EXPECT_FALSE(MakeFitOptions({{"preset_priors", "0"}}).value().preset_priors);
}

// The way of the library and that of the flags are one.
TEST(FitSetup, TermsChangedByHandAreTheSameProblem) {
  FitOptions by_hand = MakePreset("group").value();
  by_hand.model.interaction.damping = false;
  by_hand.table[kContactDamping].prior.reset();  // which the preset had freed
  FreeTerms(&by_hand);
  const FitOptions by_flags =
      MakeFitOptions({{"preset", "group"}, {"interaction", "spring"}}).value();
  EXPECT_EQ(SettingsJson(by_hand).dump(), SettingsJson(by_flags).dump());
  by_hand.pool = "none";
  FreeTerms(&by_hand);
  EXPECT_FALSE(AnyPooled(by_hand.table));
  FitOptions linear = MakePreset("tail").value();
  linear.self_force = SelfForceKind::kLinear;
  FreeTerms(&linear);
  EXPECT_EQ(
      SettingsJson(linear).dump(),
      SettingsJson(MakeFitOptions({{"preset", "tail"}, {"self_force", "linear"}}).value()).dump());
}

TEST(FitSetup, WordsOfACandidate) {
  const GivenOptions words = ParseOptionWords(" --preset=ldp  --fix=mu=3 ").value();
  EXPECT_EQ(words, (GivenOptions{{"preset", "ldp"}, {"fix", "mu=3"}}));
  const GivenOptions both = Merged({{"preset", "tail"}, {"seed", "2"}}, words);
  EXPECT_EQ(both, (GivenOptions{{"preset", "ldp"}, {"seed", "2"}, {"fix", "mu=3"}}));
  // A candidate may fix what the flags free, and free what they fix.
  const GivenOptions flags = {{"free", "mu,Kp_x"}, {"fix", "Kd_theta=70,tail_base"}};
  EXPECT_EQ(Merged(flags, {{"fix", "mu=3"}}), (GivenOptions{{"free", "Kp_x"}, {"fix", "mu=3"}}));
  EXPECT_EQ(Merged(flags, {{"free", "Kd_theta"}}),
            (GivenOptions{{"free", "Kd_theta"}, {"fix", "tail_base"}}));
  for (const char* wrong : {"--model_out=x", "preset=ldp", "--preset"}) {
    EXPECT_FALSE(ParseOptionWords(wrong).ok()) << wrong;
  }
}

TEST(PrepareFit, HoldsWhatHasNoEffectAndSaysWhatIsLeft) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  EXPECT_TRUE(options.table[kTailTime].free);
  for (PendulumRecording& r : recordings) {
    for (ScenePush& push : r.scene.pushes) push.kind = PushKind::kExternal;
  }
  Warnings warnings;
  ASSERT_FALSE(PrepareFit(recordings, &options, &warnings));
  EXPECT_FALSE(options.table[kTailTime].free);
  for (Parameter id : {kMu, kKpTheta, kKdTheta, kAx}) options.table[id].free = false;
  EXPECT_TRUE(Contains(ProblemOf(PrepareFit(recordings, &options)), "every parameter is fixed"));
}

// By content or by motion; a replica's copies go by one id and are meant.
TEST(PrepareFit, WarnsOfIdenticalRecordings) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  const auto warnings = [&recordings] {
    FitOptions options = MakePreset("tail").value();
    Warnings told;
    EXPECT_FALSE(PrepareFit(recordings, &options, &told));
    std::string text;
    for (const Warning& warning : told) text += warning.text + "\n";
    return text;
  };
  EXPECT_FALSE(Contains(warnings(), "is repeated"));
  recordings.push_back(recordings[0]);
  EXPECT_FALSE(Contains(warnings(), "is repeated"));
  recordings.back().id = "copy";
  recordings.push_back(recordings[1]);
  recordings.back().id = "other";
  recordings.back().content_hash = "another file";  // and yet the same motion
  EXPECT_TRUE(Contains(warnings(), "is repeated in 2 cases (" + recordings[0].id + " in copy; " +
                                       recordings[1].id + " in other)"));
  recordings[6].content_hash = recordings[0].content_hash = "same";
  for (auto& point : recordings[6].hip[0]) point[1] += 1e-9;
  EXPECT_TRUE(Contains(warnings(), recordings[0].id + " in copy"));
}

// A copy, even under another person's name, changes nothing.
TEST(FitProblem, CopiesCountOnce) {
  const SyntheticOptions study = TinyStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = UnbiasedFit(study);
  const FitResult alone = Fit(recordings, options);
  recordings.push_back(recordings[0]);
  recordings.back().id = "copy";
  recordings.back().subject_ids = {"somebody"};
  const FitResult with = Fit(recordings, options);
  ASSERT_TRUE(alone.ok() && with.ok());
  EXPECT_EQ(with.uncertainty.num_clusters, alone.uncertainty.num_clusters);
  ASSERT_EQ(with.estimates.size(), alone.estimates.size());
  for (size_t i = 0; i < alone.estimates.size(); ++i) {
    EXPECT_DOUBLE_EQ(with.estimates[i].value, alone.estimates[i].value);
    EXPECT_DOUBLE_EQ(with.estimates[i].standard_error, alone.estimates[i].standard_error);
  }
}

TEST(PrepareFit, RefusesWhatCannotBeFitted) {
  const std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  FitOptions options = MakePreset("tail").value();
  EXPECT_TRUE(Contains(PrepareFit({}, &options)->ToString(), "no recordings"));
  options.table[kContactStiffness].free = true;
  EXPECT_TRUE(Contains(PrepareFit(recordings, &options)->ToString(),
                       "contact_stiffness has no effect on any of these recordings"));
  options = MakePreset("tail").value();
  options.sigmas.hip = -1.0;
  EXPECT_TRUE(Contains(PrepareFit(recordings, &options)->ToString(), "sigma_hip is -1"));
}

}  // namespace
}  // namespace pushid
