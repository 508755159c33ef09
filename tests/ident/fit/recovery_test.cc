// Known parameters come back from noise-free synthetic recordings, and what the defaults add.
#include <gtest/gtest.h>

#include "ident/fit/fit.h"
#include "ident/model/fitted_model.h"
#include "ident/parameters/presets.h"
#include "ident/problem/fit_problem.h"
#include "ident/solver/solver.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

constexpr double kRelative = 1e-6;

void ExpectTruth(const FitProblem& problem, const FitPoint& point,
                 const ParameterSet<double>& truth) {
  const ParameterSet<double> found = problem.Parameters(point, "");
  for (const FittedParameter& f : problem.map().fitted) {
    EXPECT_NEAR(found[f.parameter], truth[f.parameter],
                kRelative * std::max(1e-3, std::abs(truth[f.parameter])))
        << kParameterNames[f.parameter];
  }
}

TEST(Recovery, NoiseFreeFromStartsWrongByUpToFive) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const FitOptions options = ExactFit(study);
  const FitProblem problem(recordings, options);
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("start " + std::to_string(seed));
    const FitPoint from = WrongStart(problem, study.parameters, seed);
    const SolveStart solved = SolveFrom(problem, from, "random", nullptr);
    ASSERT_TRUE(solved.usable) << solved.message;
    EXPECT_TRUE(solved.failed.empty());
    EXPECT_LT(solved.cost, 1e-12);
    ExpectTruth(problem, solved.to, study.parameters);
  }
}

TEST(Recovery, NoiseFreeWithTheRobustLoss) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = ExactFit(study);
  options.sigmas = ResidualSigmas();
  ASSERT_GT(options.sigmas.robust, 0.0);
  const FitProblem problem(recordings, options);
  const SolveStart solved =
      SolveFrom(problem, WrongStart(problem, study.parameters, 3), "random", nullptr);
  ExpectTruth(problem, solved.to, study.parameters);
}

// Both directions, not only the forward ones that the preset frees.
TEST(Recovery, NoiseFreeWithLateralGains) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = ExactFit(study);
  for (Parameter id : {kMuY, kKpPhi, kKdTheta, kKdPhi}) options.table[id].free = true;
  const FitProblem problem(recordings, options);
  const SolveStart solved =
      SolveFrom(problem, WrongStart(problem, study.parameters, 5), "random", nullptr);
  ASSERT_TRUE(solved.usable);
  ExpectTruth(problem, solved.to, study.parameters);
}

// LDP's model: pushes that are the whole force while they last, no tail, upright.
TEST(Recovery, NoiseFreeLdpPreset) {
  const FitOptions preset = MakePreset("ldp").value();
  SyntheticOptions study = SmallStudy();
  study.model = preset.model;
  study.push_kind = PushKind::kExternal;
  study.strengths = {{"weak", 0.5}, {"strong", 1.0}};
  study.parameters[kKpX] = study.parameters[kKpY] = 30.0;
  study.parameters[kMu] = 150.0;
  study.parameters[kAx] = 0.0;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = ExactFit(study);
  options.table = preset.table;
  const FitProblem problem(recordings, options);
  const Solution solution = Solve(problem);
  ASSERT_TRUE(solution.ok());
  ExpectTruth(problem, solution.start.to, study.parameters);
}

// The defaults hold a fit to settle and to weak priors. How far off that puts noise-free recordings
// stands in the properties; the bounds here only say that it stays small beside what people differ.
struct DefaultsCase {
  const char* name;
  bool priors, settling;
  double largest;  // |bias| over the truth, of any parameter
};
class Defaults : public ::testing::TestWithParam<DefaultsCase> {};

TEST_P(Defaults, Bias) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = DefaultFit(study);
  if (!GetParam().settling) options.settling_weight = 0.0;
  for (ParameterSpec& spec : options.table.specs) {
    if (!GetParam().priors) spec.prior.reset();
  }
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok());
  for (Parameter id : options.table.Free()) {
    // The error of a truth of zero is over a typical size.
    const double truth = study.parameters[id];
    const double bias =
        (result.parameters[id] - truth) / (truth != 0.0 ? truth : options.table[id].scale);
    const std::string name(kParameterNames[id]);
    RecordProperty("bias_over_truth_" + name, std::to_string(bias));
    EXPECT_LT(std::abs(bias), GetParam().largest) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Recovery, Defaults,
                         ::testing::Values(DefaultsCase{"All", true, true, 0.3},
                                           DefaultsCase{"PriorsAlone", true, false, 0.3},
                                           DefaultsCase{"SettlingAlone", false, true, 0.3},
                                           DefaultsCase{"RobustLossAlone", false, false, 1e-4}),
                         [](const ::testing::TestParamInfo<DefaultsCase>& one) {
                           return one.param.name;
                         });

}  // namespace
}  // namespace pushid
