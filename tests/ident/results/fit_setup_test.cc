// From named options to a fit: presets, edits, what acts on nothing, and what a fit is prepared
// for.
#include "ident/results/fit_setup.h"

#include <gtest/gtest.h>

#include "ident/results/fit.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

std::string Complaint(const GivenOptions& given) {
  const Result<FitOptions> options = MakeFitOptions(given);
  if (!options.ok()) return options.error().ToString();
  const MaybeError error = CheckGivenAct(given, options.value());
  return error ? error->ToString() : "";
}

TEST(FitSetup, OptionsOverThePreset) {
  const FitOptions plain = MakeFitOptions({}).value();
  EXPECT_EQ(plain.preset, "tail");  // auto, and no recordings are known
  const FitOptions o = MakeFitOptions({{"fix", "mu=30"},
                                       {"self_force", "linear"},
                                       {"preset_priors", "false"},
                                       {"prior", "a_x:-9:3"},
                                       {"horizons", "4,9"}})
                           .value();
  EXPECT_EQ(o.self_force, SelfForceKind::kLinear);
  EXPECT_GT(o.mode_weight, 0.0);  // comes with the linear self force
  EXPECT_FALSE(o.table[kMu].free);
  EXPECT_EQ(o.table[kMu].nominal, 30.0);
  EXPECT_TRUE(o.table[kBx].free);
  EXPECT_FALSE(o.table[kBx].prior);
  EXPECT_EQ(o.table[kAx].prior->mean, -9.0);  // an edit comes after the preset's priors went
  EXPECT_EQ(o.horizons, (std::vector<int>{4, 9, 0}));
  EXPECT_EQ(MakeFitOptions({{"self_force", "linear"}, {"mode_weight", "0"}}).value().mode_weight,
            0.0);
}

TEST(FitSetup, PoolingFollowsTheTerms) {
  const FitOptions group = MakeFitOptions({{"preset", "group"}}).value();
  EXPECT_TRUE(group.table[kContactDistance].pooled);
  const FitOptions drive =
      MakeFitOptions({{"preset", "group"}, {"interaction", "contact,drive"}}).value();
  EXPECT_TRUE(drive.table[kDriveGain].pooled);
  const FitOptions none = MakeFitOptions({{"preset", "group"}, {"pool", "none"}}).value();
  EXPECT_FALSE(AnyPooled(none.table));
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
}

TEST(FitSetup, BadOptionsAreNamed) {
  const std::pair<GivenOptions, std::string> cases[] = {
      {{{"preset", "tial"}}, "--preset is 'tial'"},
      {{{"posture", "flat"}}, "--posture is 'flat'; it must be one of upright, initial"},
      {{{"sigma_hip", "wide"}}, "--sigma_hip is 'wide'; it must be positive"},
      {{{"starts", "two"}}, "--starts is 'two'; it must be a whole number"},
      {{{"starts", "0"}}, "--starts is 0; it must be positive"},
      {{{"horizons", "8,x"}}, "--horizons: 'x'"},
      {{{"seed", "-1"}}, "--seed is '-1'"},
      {{{"fix", "nu"}}, "--fix names 'nu'"},
      {{{"rod_input", "true"}}, "--rod_input is for a network"},
      {{{"interaction", "network"}}, "--interaction_network must name"},
      {{{"interaction_network", "n.json"}}, "--interaction does not name network"},
      {{{"network_prior", "0.5"}}, "--network_prior acts on networks"},
      {{{"pooling_sigma", "0.3"}}, "--pooling_sigma says how parameters differ"},
      {{{"rod", "linear"}, {"takeover_weight", "1"}}, "only the rod has a network"},
      {{{"self_force", "lstm:64"}, {"ensemble", "2"}}, "--ensemble is for small networks"},
      {{{"preset", "group"}, {"self_force", "mlp:4"}, {"ensemble", "2"}},
       "--ensemble does not go together with --pool"},
      {{{"self_from", "no/such.json"}}, "no/such.json"},
  };
  for (const auto& [given, says] : cases) EXPECT_TRUE(Contains(Complaint(given), says)) << says;
  EXPECT_EQ(Complaint({{"self_force", "mlp:4"}, {"network_prior", "0.5"}}), "");
}

TEST(FitSetup, WordsOfACandidate) {
  const GivenOptions words = ParseOptionWords(" --preset=ldp  --fix=mu=3 ").value();
  EXPECT_EQ(words, (GivenOptions{{"preset", "ldp"}, {"fix", "mu=3"}}));
  const GivenOptions both = Merged({{"preset", "tail"}, {"seed", "2"}}, words);
  EXPECT_EQ(both, (GivenOptions{{"preset", "ldp"}, {"seed", "2"}, {"fix", "mu=3"}}));
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
  std::vector<std::string> warnings;
  ASSERT_FALSE(PrepareFit(recordings, &options, &warnings));
  EXPECT_FALSE(options.table[kTailTime].free);
  for (Parameter id : {kMu, kKpTheta, kAx}) options.table[id].free = false;
  const MaybeError error = PrepareFit(recordings, &options);
  ASSERT_TRUE(error);
  EXPECT_TRUE(Contains(error->ToString(), "every parameter is fixed"));
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
  EXPECT_TRUE(Contains(PrepareFit(recordings, &options)->ToString(), "--sigma_hip is -1"));
}

}  // namespace
}  // namespace pushid
