// Parameters that the data cannot tell apart are said so, by name, and leaves the rest alone.
#include <gtest/gtest.h>

#include <set>

#include "ident/fit/fit.h"
#include "ident/report/page/build_report.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using NameSet = std::set<std::string>;

NameSet Unidentifiable(const FitResult& result) {
  NameSet names;
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kUnidentifiable) names.insert(e.name);
  }
  return names;
}

FitResult FitEdited(const SyntheticOptions& study, const TableEdits& edits) {
  FitOptions options = UnbiasedFit(study);
  EXPECT_EQ(ProblemOf(EditTable(edits, &options.table)), "no error");
  FitResult result = Fit(MakePendulums(study), options);
  EXPECT_TRUE(result.ok());
  return result;
}

SyntheticOptions StudyWithNoise() {
  SyntheticOptions study = SmallStudy();
  study.joint_noise_m = 0.002;
  return study;
}

void ExpectOthersFinite(const FitResult& result, const NameSet& null) {
  for (const Estimate& e : result.estimates) {
    if (e.status == EstimateStatus::kFixed) continue;
    if (null.count(e.name) > 0) {
      EXPECT_TRUE(std::isinf(e.standard_error)) << e.name;
      EXPECT_TRUE(std::isinf(e.standard_error_naive)) << e.name;
    } else {
      EXPECT_TRUE(std::isfinite(e.standard_error)) << e.name;
      EXPECT_GT(e.standard_error, 0.0) << e.name;
      EXPECT_NE(e.status, EstimateStatus::kUnidentifiable) << e.name;
    }
  }
}

// With one friction for both axes, mu, Kp_x and Kp_y make one null direction of three.
TEST(Identifiability, FrictionAndCartGainsTogether) {
  SyntheticOptions study = StudyWithNoise();
  study.model.friction = FrictionKind::kIsotropic;
  const FitResult result = FitEdited(study, {"", "Kp_x,Kp_y", "", "", ""});
  const NameSet three = {"mu", "Kp_x", "Kp_y"};
  EXPECT_EQ(Unidentifiable(result), three);
  ExpectOthersFinite(result, three);

  ASSERT_EQ(result.uncertainty.null_directions.size(), 1u);
  const NullDirection& null = result.uncertainty.null_directions[0];
  EXPECT_EQ(NameSet(null.parameters.begin(), null.parameters.end()), three);
  EXPECT_TRUE(Contains(null.sentence, "mu, Kp_x and Kp_y cannot be separated"));
  EXPECT_TRUE(Contains(null.sentence, "mu + Kp_x"));
  EXPECT_TRUE(Contains(null.sentence, "mu + Kp_y"));
  ASSERT_EQ(null.identified.size(), 2u);
  const double truth = study.parameters[kMu] + study.parameters[kKpX];
  for (const Combination& c : null.identified) {
    EXPECT_GT(c.standard_error, 0.0);
    EXPECT_LE(c.lower95, truth) << c.name;
    EXPECT_GE(c.upper95, truth) << c.name;
  }
  std::string text = DetailsText({result, {}, {}, {}, {}});
  std::replace(text.begin(), text.end(), '\n', ' ');
  EXPECT_TRUE(Contains(text, "mu, Kp_x and Kp_y cannot be separated"));
}

// One friction per axis: only what acts on x is confounded with mu.
TEST(Identifiability, OneFrictionPerAxis) {
  SyntheticOptions study = StudyWithNoise();
  study.model.friction = FrictionKind::kAnisotropic;
  study.parameters[kMuY] = 100.0;
  const FitResult result = FitEdited(study, {"", "Kp_x,Kp_y", "", "", ""});
  const NameSet two = {"mu", "Kp_x"};
  EXPECT_EQ(Unidentifiable(result), two);
  ExpectOthersFinite(result, two);
}

// A prior chooses a value; it does not make the data know it.
TEST(Identifiability, APriorIdentifiesNothing) {
  SyntheticOptions study = StudyWithNoise();
  study.model.friction = FrictionKind::kIsotropic;
  const FitResult result = FitEdited(study, {"", "Kp_x,Kp_y", "mu:100:10", "", ""});
  EXPECT_EQ(Unidentifiable(result), (NameSet{"mu", "Kp_x", "Kp_y"}));
  // The prior holds mu where it says, and the sums stay what the data say.
  EXPECT_NEAR(result.parameters[kMu], 100.0, 1e-3);
  EXPECT_NEAR(result.parameters[kMu] + result.parameters[kKpX], study.parameters[kMu], 3.0);
}

TEST(Identifiability, NoEffectIsNamed) {
  SyntheticOptions study = StudyWithNoise();
  study.push_kind = PushKind::kExternal;
  study.strengths = {{"weak", 0.5}, {"strong", 1.0}};
  const FitResult result = FitEdited(study, {});
  const NameSet tail = {"tail_gain", "tail_torque", "tail_time", "tail_base"};
  EXPECT_EQ(Unidentifiable(result), tail);
  ExpectOthersFinite(result, tail);
  NameSet named;
  for (const NullDirection& null : result.uncertainty.null_directions) {
    ASSERT_EQ(null.parameters.size(), 1u);
    named.insert(null.parameters[0]);
    EXPECT_TRUE(Contains(null.sentence, null.parameters[0] + " has no effect"));
    EXPECT_TRUE(Contains(null.sentence, "--fix=" + null.parameters[0]));
  }
  EXPECT_EQ(named, tail);
  bool warned = false;
  for (const Warning& warning : result.warnings) {
    warned = warned || warning.text.find("the push tail has no effect") != std::string::npos;
  }
  EXPECT_TRUE(warned);
}

TEST(Identifiability, NothingToReportForThePreset) {
  const FitResult result = FitEdited(StudyWithNoise(), {});
  EXPECT_TRUE(result.uncertainty.null_directions.empty());
  EXPECT_TRUE(Unidentifiable(result).empty());
  EXPECT_TRUE(std::isfinite(result.uncertainty.condition_number));
}

}  // namespace
}  // namespace pushid
