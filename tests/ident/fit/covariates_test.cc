// Covariates and contrasts in a fit: slopes of exact data, who is asked for and what is missing,
// predictions of people whose values are known.
#include "ident/fit/covariates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/model/model_rollout.h"
#include "ident/report/report_text.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kAges[] = {20.0, 35.0, 60.0, 45.0};
constexpr double kSlope = -0.01;  // of the stiffness' logarithm, per year
constexpr double kRatio = 1.3;    // of patients' drag

// Four people: stiffness falls with age, and the drag of the last two, patients, is greater.
std::vector<PendulumRecording> PeopleOfAges(const SyntheticOptions& base) {
  std::vector<PendulumRecording> all;
  for (int s = 0; s < 4; ++s) {
    SyntheticOptions study = base;
    study.subjects = 1;
    study.seed = 10 + s;
    study.parameters[kKpTheta] *= std::exp(kSlope * (kAges[s] - 40.0));
    study.parameters[kMu] *= s >= 2 ? kRatio : 1.0;
    for (PendulumRecording& r : MakePendulums(study)) {
      r.subject_ids[0] = "S" + std::to_string(s);
      r.id = r.subject_ids[0] + "/" + r.id;
      r.known = {{{{"age", kAges[s]}}, {{"group", s >= 2 ? "patients" : "controls"}}}};
      all.push_back(r);
    }
  }
  return all;
}

FitOptions WithCovariates(FitOptions options, const std::string& contrast,
                          const std::string& covariates) {
  options.contrast = contrast;
  options.covariates = covariates;
  return options;
}

TEST(Covariates, SlopesOfExactDataAreFound) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = PeopleOfAges(study);
  FitOptions options = WithCovariates(ExactFit(study), "group", "Kp_theta ~ age");
  options.preset_priors = false;
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  const Estimate* slope = FindEstimate(result.estimates, "Kp_theta~age");
  ASSERT_NE(slope, nullptr);
  EXPECT_NEAR(slope->value, kSlope, 1e-5);
  EXPECT_EQ(slope->unit, "1 per age");

  // The centre is the mean age, of these four people 40.
  EXPECT_NEAR(result.parameters[kKpTheta], study.parameters[kKpTheta], 0.5);
  ASSERT_TRUE(result.contrast);
  const Contrast& contrast = *result.contrast;
  EXPECT_EQ(contrast.first, "controls");
  EXPECT_EQ(contrast.second, "patients");
  EXPECT_EQ(contrast.only_second, (std::vector<std::string>{"S2", "S3"}));
  EXPECT_TRUE(contrast.both.empty());
  for (const ContrastRow& row : contrast.rows) {
    if (row.name != "mu") continue;
    EXPECT_NEAR(row.first, study.parameters[kMu], 0.05);
    EXPECT_NEAR(row.second, kRatio * study.parameters[kMu], 0.05);
    EXPECT_NEAR(row.difference, row.second - row.first, 1e-12);
  }
  EXPECT_EQ(contrast.rows.size() + 1,
            result.options.table.specs.size() - static_cast<size_t>(kFirstOwnParameter));

  // Predictions are of a person's own values; of a stranger's, the centre's.
  const IdentifiedModel model = ModelOf(result);
  const auto own = PeoplesParameters(model, recordings.front());
  EXPECT_NEAR(own[0][kKpTheta], study.parameters[kKpTheta] * std::exp(-20.0 * kSlope), 0.5);
  EXPECT_NEAR(own[0][kMu], study.parameters[kMu], 0.05);
  PendulumRecording stranger = recordings.front();
  stranger.known.clear();
  EXPECT_EQ(PeoplesParameters(model, stranger)[0][kKpTheta], result.parameters[kKpTheta]);

  // Nothing is lost in the file.
  FittedModel fitted;
  fitted.fit = result;
  const auto json = ToJson(fitted, {});
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(ToJson(read, {}).dump(), json.dump());
  EXPECT_EQ(PeoplesParameters(ModelOf(read.fit), recordings.front())[0], own[0]);
  EXPECT_EQ(ContrastText(read.fit), ContrastText(result));
}

// People before and after: paired, by a label of the recordings.
TEST(Covariates, PeopleInBothAreNamed) {
  const SyntheticOptions study = TinyStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  for (size_t i = 0; i < recordings.size(); ++i) {
    recordings[i].labels.Set("time", i % 2 == 0 ? "before" : "after");
  }
  FitOptions options = WithCovariates(DefaultFit(study), "time", "");
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  ASSERT_TRUE(result.contrast);
  EXPECT_EQ(result.contrast->both.size(), 2u);
  const std::string text = ContrastText(result);
  EXPECT_TRUE(Contains(text, "2 people in both (S01, S02)"));
  for (const ContrastRow& row : result.contrast->rows) {
    EXPECT_GE(row.p_holm, row.p);
    EXPECT_LE(row.p_holm, 1.0);
    EXPECT_EQ(row.effect.has_value(), row.status != EstimateStatus::kUnidentifiable)
        << "everybody was recorded alone";
  }
  // Preparing again changes nothing.
  const size_t rows = options.table.specs.size();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  EXPECT_EQ(options.table.specs.size(), rows);
}

TEST(Covariates, ALabelThatIsComparedIsNotPooledBy) {
  const SyntheticOptions study = TinyStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  for (size_t i = 0; i < recordings.size(); ++i) {
    recordings[i].labels.Set(kConditionLabel, i % 2 == 0 ? "a" : "b");
  }
  FitOptions options = WithCovariates(MakePreset("tail").value(), kConditionLabel, "");
  Warnings warnings;
  ASSERT_FALSE(PrepareFit(recordings, &options, &warnings));
  EXPECT_FALSE(AnyPooled(options.table));
  EXPECT_NE(options.table.Find("tail_time~condition"), nullptr);
}

TEST(Covariates, BadInputIsNamed) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = [&] {
    SyntheticOptions four = study;
    four.subjects = 4;
    std::vector<PendulumRecording> all = MakePendulums(four);
    for (size_t i = 0; i < all.size(); ++i) {
      const double age = 20.0 + 10.0 * static_cast<double>(i / 3);
      all[i].known = {{{{"age", age}, {"shoe", i < 6 ? 41.0 : 43.0}}, {{"side", "left"}}}};
      if (i < 9) all[i].known[0].numbers["height"] = 1.7 + 0.01 * age;
      if (i < 9) all[i].known[0].texts["group"] = i < 6 ? "a" : "b";
    }
    return all;
  }();
  const std::string last = "person 'S04' of recording '" + recordings[9].id + "'";
  struct Case {
    std::string contrast, covariates, message;
  };
  const std::vector<Case> cases = {
      {"", "Kp_thet ~ age", "'Kp_thet', which is not a parameter; did you mean Kp_theta?"},
      {"", "Kp_x ~ age", "Kp_x, which is fixed; free it first (--free=Kp_x)"},
      {"", "mu ~ agee", "'agee', a number that nobody has; there are age, height, mass, rod, shoe"},
      {"", "mu ~ weight", "there are age, height, mass, rod, shoe"},
      {"", "mu ~ height", "height, which is not known of " + last},
      {"", "mu ~ shoe", "shoe, which has 2 distinct values among 4 people"},
      {"grupo", "", "'grupo', a label that no recording or person has"},
      {"side", "", "side has 1 (left)"},
      {"magnitude", "", "magnitude has 3 (medium, strong, weak)"},
      {"group", "", "'group', a label that " + last + " lacks"},
  };
  for (const Case& one : cases) {
    FitOptions options = WithCovariates(DefaultFit(study), one.contrast, one.covariates);
    const MaybeError error = PrepareFit(recordings, &options);
    ASSERT_TRUE(error) << one.contrast << one.covariates;
    EXPECT_TRUE(Contains(error->message, one.message));
  }
  // Facts that are always known.
  FitOptions by_mass = WithCovariates(DefaultFit(study), "", "Kp_theta ~ mass + rod");
  EXPECT_FALSE(PrepareFit(recordings, &by_mass));
  EXPECT_NE(by_mass.table.Find("Kp_theta~mass"), nullptr);
}

TEST(Covariates, ThereIsRoomForSoMany) {
  const SyntheticOptions study = TinyStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  std::string all;
  for (size_t i = 0; i < recordings.size(); ++i) {
    for (int k = 0; k <= kNumOwnParameters; ++k) {
      const std::string key = "k" + std::to_string(k);
      recordings[i].known.resize(1);
      recordings[i].known[0].numbers[key] = static_cast<double>(i * i + k);
      if (i == 0) all += (all.empty() ? "mu ~ " : " + ") + key;
    }
  }
  recordings[0].subject_ids[0] = "another";
  FitOptions options = WithCovariates(DefaultFit(study), "", all);
  const MaybeError error = PrepareFit(recordings, &options);
  ASSERT_TRUE(error);
  EXPECT_TRUE(Contains(error->message, "there is no room for the slope"));
}

}  // namespace
}  // namespace pushid
