// One fit, its Jacobian by sensitivities and by Jets through the whole rollout.
#include <gtest/gtest.h>

#include "ident/fit/fit.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "tests/ident/fit_samples.h"

namespace pushid {
namespace {

TEST(JacobianMethod, BothFindTheSameFit) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = DefaultFit(study);
  // One problem: estimated weights stay within 1 % of where their rounds end.
  options.sigma_source = SigmaSource::kFixed;
  options.recording_weight = RecordingWeight::kRecording;
  options.function_tolerance = 1e-30;  // on until rounding errors end it
  options.gradient_tolerance = 1e-30;
  options.parameter_tolerance = 1e-14;
  const FitResult fast = Fit(recordings, options);
  options.jacobian = JacobianMethod::kAutodiff;
  const FitResult oracle = Fit(recordings, options);
  ASSERT_TRUE(fast.ok());
  ASSERT_TRUE(oracle.ok());
  for (Parameter id : options.table.Free()) {
    EXPECT_NEAR(oracle.parameters[id], fast.parameters[id], 1e-8 * std::abs(fast.parameters[id]))
        << kParameterNames[id];
  }
  EXPECT_NEAR(oracle.cost, fast.cost, 1e-9 * fast.cost);
  for (size_t i = 0; i < fast.uncertainty.estimates.size(); ++i) {
    const Estimate &a = oracle.uncertainty.estimates[i], &b = fast.uncertainty.estimates[i];
    EXPECT_NEAR(a.standard_error, b.standard_error, 1e-6 * b.standard_error) << a.name;
  }
}

// That it is the other Jacobian that was asked for, not the same one twice.
TEST(JacobianMethod, ChoosesTheCostFunction) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  for (const auto& [name, method] : Names(JacobianMethod())) {
    FitOptions options = DefaultFit(study);
    options.jacobian = method;
    const FitProblem problem(recordings, options);
    FitPoint point = problem.NominalPoint();
    const FitProblem::Built built = problem.Build(&point, 0);
    int sensitivities = 0, recordings_seen = 0;
    for (const FitProblem::Built::Block& block : built.blocks) {
      if (block.cluster < 0) continue;
      ++recordings_seen;
      const auto* rollout = dynamic_cast<const CondensedRollout*>(block.cost);
      ASSERT_NE(rollout, nullptr);
      sensitivities += rollout->method() == JacobianMethod::kSensitivities;
    }
    EXPECT_EQ(recordings_seen, 6);
    EXPECT_EQ(sensitivities, method == JacobianMethod::kSensitivities ? 6 : 0) << name;
  }
}

}  // namespace
}  // namespace pushid
