// Fits by likelihoods of single steps: planted noise and gains, scores, and what is refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/fit/fit.h"
#include "ident/fit/fit_setup.h"
#include "ident/model/model_json.h"
#include "models/parameters.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

SyntheticOptions ProcessNoiseStudy(uint64_t seed) {
  SyntheticOptions study = SmallStudy();
  study.model.process_noise = ProcessNoise::kDiagonal;
  study.parameters[kSigmaX] = 12.0, study.parameters[kSigmaY] = 9.0;
  study.parameters[kSigmaTheta] = 6.0, study.parameters[kSigmaPhi] = 5.0;
  study.joint_noise_m = 0.002;
  study.noise_at_first_frame = false;
  study.seed = seed;
  return study;
}

FitOptions ByLikelihood(const SyntheticOptions& study, const std::string& likelihood) {
  FitOptions options =
      MakeFitOptions({{"preset", "tail"}, {"pool", "none"}, {"likelihood", likelihood}}).value();
  options.model.directions = Directions::kAxes;  // those of the planted noise
  for (ParameterSpec& spec : options.table.specs) {
    spec.tied_to.reset();
    if (!spec.free && !IsNoiseParameter(spec.id)) spec.nominal = study.parameters[spec.id];
  }
  options.model.gain_scaling = study.model.gain_scaling;
  options.model.push = study.model.push;
  return HoldDamping(options);
}

// Noise of the joints alone, and a measured push: from errors of measurement that start far too low
// the likelihood climbs to a place where all roughness is force, and damping is four times the
// truth.
TEST(InnovationFit, FindsErrorsOfMeasurementWhereNothingElseDrives) {
  SyntheticOptions study = SmallStudy();
  study.push_kind = PushKind::kExternal;
  study.joint_noise_m = 0.002;
  study.frames = 90;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = MakeFitOptions({{"likelihood", "innovation"}, {"stance", "slide"}}).value();
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok()) << result.message;
  EXPECT_NEAR(result.parameters[kMeasuredHip], 0.002, 0.0002);
  EXPECT_LT(result.parameters[kKdTheta], 2.5 * study.parameters[kKdTheta]);
  for (const Estimate& e : result.estimates) {
    if (e.name != "Kd_theta") continue;
    EXPECT_LE(e.lower95, study.parameters[kKdTheta]);
    EXPECT_GE(e.upper95, study.parameters[kKdTheta]);
  }
}

TEST(InnovationFit, FindsPlantedNoiseAndGains) {
  int covered = 0, free = 0;
  for (uint64_t seed : {1, 2, 3}) {
    const SyntheticOptions study = ProcessNoiseStudy(seed);
    const std::vector<PendulumRecording> recordings = MakePendulums(study);
    FitOptions options = ByLikelihood(study, "innovation");
    ASSERT_FALSE(PrepareFit(recordings, &options));
    const FitResult result = Fit(recordings, options);
    ASSERT_TRUE(result.ok() && result.converged) << result.message;
    for (const Estimate& e : result.estimates) {
      const Parameter id = result.options.table.Find(e.name)->id;
      if (!result.options.table[id].free) continue;
      // Two millimetres on hip and each of two ankles, of which the cart is the middle.
      const double truth = id == kMeasuredCart  ? 0.002 / std::sqrt(2.0)
                           : id == kMeasuredHip ? 0.002
                                                : study.parameters[id];
      ++free;
      covered += e.lower95 <= truth && truth <= e.upper95;
      if (IsNoiseParameter(id)) {
        EXPECT_NEAR(e.value, truth, 0.15 * truth) << e.name;
      }
    }
    ASSERT_TRUE(result.likelihood);
    EXPECT_EQ(result.likelihood->parameters, 13);
    EXPECT_NEAR(result.likelihood->Aic() - result.likelihood->deviance, 26.0, 1e-9);
  }
  EXPECT_EQ(free, 39);
  EXPECT_GE(covered, 34);  // 87 %
}

// Errors of measured states count as noise.
TEST(TransitionFit, OnExactStatesFindsTheNoise) {
  SyntheticOptions study = ProcessNoiseStudy(4);
  study.joint_noise_m = 0.0;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = ByLikelihood(study, "transition");
  ASSERT_FALSE(PrepareFit(recordings, &options));
  const FitResult result = Fit(recordings, options);
  ASSERT_TRUE(result.ok()) << result.message;
  for (Parameter id : {kSigmaX, kSigmaY, kSigmaTheta, kSigmaPhi}) {
    EXPECT_NEAR(result.parameters[id], study.parameters[id], 0.08 * study.parameters[id])
        << result.options.table[id].name;
  }
}

TEST(InnovationFit, ComesBackFromJson) {
  SyntheticOptions study = TinyStudy();
  study.model.process_noise = ProcessNoise::kDiagonal;
  study.parameters[kSigmaX] = study.parameters[kSigmaY] = 10.0;
  study.parameters[kSigmaTheta] = study.parameters[kSigmaPhi] = 6.0;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions options = ByLikelihood(study, "innovation");
  ASSERT_FALSE(PrepareFit(recordings, &options));
  FittedModel model;
  model.fit = Fit(recordings, options);
  ASSERT_TRUE(model.fit.ok());
  const auto back = Unwrapped(FittedModelFromJson(ToJson(model, {}), "model.json"));
  const FitResult& fit = back.fit;
  EXPECT_EQ(fit.parameters, model.fit.parameters);
  EXPECT_EQ(fit.options.likelihood, Likelihood::kInnovation);
  EXPECT_EQ(fit.options.model.process_noise, ProcessNoise::kDiagonal);
  ASSERT_TRUE(fit.likelihood);
  EXPECT_EQ(fit.likelihood->deviance, model.fit.likelihood->deviance);
  EXPECT_EQ(fit.likelihood->measured, model.fit.likelihood->measured);
}

TEST(Likelihoods, ModelsWithAMemoryAreRefused) {
  const SyntheticOptions study = TinyStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  const auto refused = [&](const GivenOptions& more, const std::string& says) {
    GivenOptions given = {{"preset", "tail"}, {"likelihood", "innovation"}};
    given.insert(given.end(), more.begin(), more.end());
    FitOptions options = Unwrapped(MakeFitOptions(given));
    const std::string error = ProblemOf(PrepareFit(recordings, &options));
    EXPECT_TRUE(Contains(error, says));
  };
  refused({{"stance", "steps"}}, "--stance=steps");
  refused({{"self_force", "mlp:4"}}, "a network");
  recordings[1].initial_velocity = InitialVelocity::kFree;
  refused({}, recordings[1].id);
}

}  // namespace
}  // namespace pushid
