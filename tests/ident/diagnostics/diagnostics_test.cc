// Findings before and after a fit, each provoked on purpose.
#include "ident/diagnostics/diagnostics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/advice.h"
#include "ident/report/page/build_report.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(StartDiagnostics, ParametersWithoutEffectAreNamed) {
  SyntheticOptions study = TinyStudy();
  study.push_kind = PushKind::kExternal;  // measured whole: no tail
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  const std::string error = ProblemOf(CheckEffects(FitProblem(recordings, options)));
  EXPECT_TRUE(Contains(error, "tail_gain,tail_torque,tail_time,tail_base have no"));
  EXPECT_TRUE(Contains(error, "--fix=tail_gain"));
  ASSERT_FALSE(
      EditTable({"tail_gain,tail_torque,tail_time,tail_base", "", "", "", ""}, &options.table));
  EXPECT_FALSE(CheckEffects(FitProblem(recordings, options)));
}

TEST(StartDiagnostics, StartsOnABoundAreMovedOff) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  ParameterSpec& gain = options.table[kTailGain];
  gain.nominal = gain.lower;
  const FitResult result = Fit(recordings, options);
  ASSERT_EQ(result.diagnostics.start.notes.size(), 1u);
  EXPECT_TRUE(Contains(result.diagnostics.start.notes[0], "tail_gain started on its bound"));
  EXPECT_TRUE(result.converged);
}

TEST(StartDiagnostics, FindingsAreKept) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  recordings[1].scene.people[0].body.mass *= 2.5;
  const FitResult result = Fit(recordings, UnbiasedFit(TinyStudy()));
  const std::vector<Finding>& findings = result.diagnostics.start.findings;
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, FindingKind::kMass);
  EXPECT_EQ(findings[0].recording, recordings[1].id);
}

TEST(Diagnostics, TheStartKnowsItsNullDirections) {
  const SyntheticOptions study = TinyStudy();
  FitOptions options = UnbiasedFit(study);
  ASSERT_FALSE(EditTable({"", "Kp_x,Kp_y", "", "", ""}, &options.table));
  const FitResult result = Fit(MakePendulums(study), options);
  ASSERT_EQ(result.diagnostics.start.null_directions.size(), 1u);
  EXPECT_GT(result.diagnostics.start.condition_number, 1.0);
}

class Judged : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    SyntheticOptions study = SmallStudy();
    study.recording_spread = 0.1;
    recordings_ = new std::vector<PendulumRecording>(MakePendulums(study));
    // A recording whose motion is not that of its push.
    for (Vector3<double>& hip : (*recordings_)[5].hip[0]) hip[0] += 3.0 * (hip[0] - 0.0);
    options_ = new FitOptions(UnbiasedFit(study));
    options_->sigmas.robust = 0.5;
    result_ = new FitResult(Fit(*recordings_, *options_));
  }
  static void TearDownTestSuite() {
    delete result_;
    delete options_;
    delete recordings_;
  }
  static std::vector<PendulumRecording>* recordings_;
  static FitOptions* options_;
  static FitResult* result_;
};
std::vector<PendulumRecording>* Judged::recordings_ = nullptr;
FitOptions* Judged::options_ = nullptr;
FitResult* Judged::result_ = nullptr;

TEST_F(Judged, FindsTheOddRecordingAndItsFrames) {
  const auto& all = result_->diagnostics.recordings;
  ASSERT_EQ(all.size(), recordings_->size());
  for (size_t g = 0; g < all.size(); ++g) {
    EXPECT_EQ(all[g].id, (*recordings_)[g].id);
    EXPECT_DOUBLE_EQ(all[g].cost, result_->recordings[g].cost);
    if (g != 5) {
      EXPECT_GT(all[g].explained, 80.0) << all[g].id;
      EXPECT_LT(all[g].outliers.size(), all[5].outliers.size()) << all[g].id;
    }
  }
  EXPECT_LT(all[5].explained, 80.0);
  ASSERT_FALSE(all[5].outliers.empty());
  for (const Outlier& outlier : all[5].outliers) {
    EXPECT_LT(outlier.weight, 0.5);
    EXPECT_GT(outlier.error, 0.5);
  }
}

TEST_F(Judged, ResidualsOfVaryingGainsAreNotWhite) {
  const auto& whiteness = result_->diagnostics.whiteness;
  ASSERT_EQ(whiteness.size(), 8u);
  EXPECT_EQ(whiteness[0].channel, "hip x");
  EXPECT_GT(whiteness[0].autocorrelation[0], 0.8);
  EXPECT_GT(whiteness[0].autocorrelation[0], whiteness[0].mean_band);
  EXPECT_LT(whiteness[0].ljung_box_p, 1e-6);
  EXPECT_EQ(whiteness[0].push.size(), whiteness[0].autocorrelation.size() + 1);
}

TEST_F(Judged, TraceFallsAndEndsAtTheCost) {
  const auto& trace = result_->diagnostics.trace;
  ASSERT_FALSE(trace.empty());
  EXPECT_EQ(trace.front().horizon, 8);
  EXPECT_EQ(trace.back().horizon, 0);
  EXPECT_NEAR(trace.back().cost, result_->cost, 1e-9 * result_->cost);
  EXPECT_LT(trace.back().gradient, 0.1 * trace.front().gradient);
}

// One Gauss-Newton step against fits that never saw the recording.
TEST(Leverage, IsWhatRefitsFind) {
  SyntheticOptions study = SmallStudy();
  study.recording_spread = 0.1;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = UnbiasedFit(study);
  options.table[kTailBase].free = false;  // it trades with the gain: one step is not the whole way
  options.sigmas.robust = 0.5;
  const FitResult result = Fit(recordings, options);
  const Leverage& leverage = result.diagnostics.leverage;
  const SolveStart& best = result.starts[result.best_start];
  ASSERT_EQ(leverage.recordings.size(), recordings.size());
  double off = 0.0, size = 0.0;
  for (size_t g = 0; g < recordings.size(); ++g) {
    std::vector<int> counts(recordings.size(), 1);
    counts[g] = 0;
    const FitProblem rest(recordings, options, counts);
    const SolveStart refit = Refit(rest, best.to);
    ASSERT_TRUE(refit.converged);
    const ParameterSet<double> without = rest.Parameters(refit.to, "");
    for (size_t p = 0; p < leverage.parameters.size(); ++p) {
      const Parameter id = options.table.Find(leverage.parameters[p])->id;
      const double error = FindEstimate(result.estimates, leverage.parameters[p])->standard_error;
      const double real = (without[id] - result.parameters[id]) / error;
      const double step = leverage.change[g][p] / error;
      off += (real - step) * (real - step);
      size += real * real;
      EXPECT_NEAR(step, real, 0.06 + 0.4 * std::abs(real))
          << leverage.recordings[g] << " " << leverage.parameters[p];
    }
  }
  RecordProperty("relative_error", std::to_string(std::sqrt(off / size)));
  EXPECT_LT(std::sqrt(off / size), 0.25);  // over all recordings and parameters
}

TEST_F(Judged, AdviceNamesTheRecordingAndACommand) {
  FittedModel model{*result_, {}, {}, {}, {}};
  model.provenance.configuration = {{"setting", "single"}, {"preset", "tail"}, {"fix", "mu_y=10"}};
  model.provenance.changed_flags = {"fix", "setting"};
  model.fit.diagnostics.leverage.in_errors[5][0] = 1.7;
  const std::vector<Advice> advice = Advise(model);
  const auto about = std::find_if(advice.begin(), advice.end(), [](const Advice& a) {
    return a.command.find("--leave_out") != std::string::npos;
  });
  ASSERT_NE(about, advice.end());
  EXPECT_TRUE(Contains(about->sentence, recordings_->at(5).id));
  EXPECT_TRUE(Contains(about->command, "--setting=single --fix=mu_y=10 --leave_out="));
  model.advice = advice;
  EXPECT_TRUE(Contains(DetailsText(model), CommandLines(about->command)));
}

std::string AllAdvice(const FitResult& result) {
  std::string all;
  for (const Advice& advice : Advise({result, {}, {}, {}, {}}))
    all += advice.sentence + "\n" + advice.command + "\n";
  return all;
}

TEST(Advice, RepeatsEveryChangedFlagOnceAndKeepsLists) {
  Provenance from;
  from.manifest = "my data/manifest.json";
  from.configuration = {{"preset", "group"},        {"pool", "none"},   {"interaction", "none"},
                        {"leave_out", "a,b"},       {"fix", "mu=3"},    {"seed", "1"},
                        {"preset_priors", "false"}, {"profile", "all"}, {"marker_noise", "0.15"}};
  from.changed_flags = {"fix",  "interaction", "leave_out",     "marker_noise",
                        "pool", "preset",      "preset_priors", "profile"};
  const FitCommand same("pushid-fit", from);
  EXPECT_EQ(same.ToString(),
            "pushid-fit --recordings='my data/manifest.json' --leave_out=a,b --preset=group "
            "--fix=mu=3 --interaction=none --marker_noise=0.15 --pool=none --preset_priors=false");
  EXPECT_TRUE(Contains(FitCommand(same).Append("fix", "a_x=1").ToString(), "--fix=mu=3,a_x=1 "));
  const std::string set = FitCommand(same).Set("interaction", "contact").ToString();
  EXPECT_TRUE(Contains(set, "--interaction=contact "));
  EXPECT_FALSE(Contains(set, "--interaction=none"));
}

TEST(Advice, IsNotWhatIsOnAlready) {
  FitResult result;
  result.options.table = BaseTable();
  result.recordings.resize(3);
  result.verdict.assumptions = {{"b_x", "m/s/rad", 0.0, 2.0, 1.0, 2.0, 0.06, {}},
                                {"t_x", "m/s", 0.0, 6.0, 1.0, 6.0, 1e-5, {}}};
  result.behaviour.settles = false;
  EXPECT_TRUE(Contains(AllAdvice(result), "--free=t_x"));
  EXPECT_FALSE(Contains(AllAdvice(result), "--free=b_x"));
  EXPECT_TRUE(Contains(AllAdvice(result), "--settling_weight=10"));
  EXPECT_TRUE(Contains(AllAdvice(result), "--bootstrap=199"));
  result.options.settling_weight = 20.0;
  EXPECT_TRUE(Contains(AllAdvice(result), "--settling_weight=40"));
  // Where the demand to settle explains the misfit, no term is proposed.
  result.uncertainty.settling.binds = true;
  EXPECT_FALSE(Contains(AllAdvice(result), "--free=t_x"));
}

TEST(Advice, OfGroupsAndOfSingleRecordings) {
  FitResult result;
  result.recordings.resize(1);
  EXPECT_FALSE(Contains(AllAdvice(result), "--bootstrap"));
  EXPECT_FALSE(Contains(AllAdvice(result), "--interaction"));
  result.recordings[0].people = 4;
  EXPECT_TRUE(Contains(AllAdvice(result), "--interaction=contact"));
  result.options.model.interaction.spring = true;
  EXPECT_FALSE(Contains(AllAdvice(result), "--interaction"));
}

TEST(Advice, OfNullDirectionsHoldsOneOfThem) {
  const SyntheticOptions study = TinyStudy();
  FitOptions options = UnbiasedFit(study);
  ASSERT_FALSE(EditTable({"", "Kp_x,Kp_y", "", "", ""}, &options.table));
  const std::vector<Advice> advice = Advise({Fit(MakePendulums(study), options), {}, {}, {}, {}});
  ASSERT_FALSE(advice.empty());
  EXPECT_TRUE(Contains(advice.front().sentence, "cannot be separated"));
  EXPECT_TRUE(Contains(advice.front().command, "--fix=Kp_"));
}

}  // namespace
}  // namespace pushid
