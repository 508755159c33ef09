// Fits with a rod that moves: a planted law is found again in what it predicts, together with the
// cart's lift, and results keep it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/diagnostics/diagnostics.h"
#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/behaviour.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/page/build_report.h"
#include "ident/solver/solver.h"
#include "tests/ident/network_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kPlantedLift = 0.6;

// Knees that give way to a lean, to speed and to the force on the cart, and straighten again.
std::shared_ptr<const LearnedTerms> PlantedRod() {
  LearnedTerms network;
  network.rod.kind = RodKind::kLinear;
  network.weights = {-1.0, 0.3, -2.5, 0.5, -0.5, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0};
  return std::make_shared<const LearnedTerms>(network);
}

FitResult FitRod(const Study& study, const RodShape& rod) {
  FitOptions options = study.options;
  options.model.learned = InitialNetwork({}, 1, rod);
  options.table[kRodLift].nominal = 1.0;
  FreeTerms(&options);
  options.table[kRodLift].prior.reset();
  return Fit(study.training, options);
}

TEST(RodFit, PlantedLawsPredictUnseenPushes) {
  Study study = PlantedStudy(PlantedRod(), 0.0, kPlantedLift);
  study.options.network_prior = 0.0;
  const double constant = HeldOutAde(study, FitWith(study, {}));
  EXPECT_GT(constant, 0.01);
  const FitResult linear = FitRod(study, {RodKind::kLinear, {}});
  EXPECT_LT(HeldOutAde(study, linear), 0.02 * constant);
  EXPECT_NEAR(linear.parameters[kRodLift], kPlantedLift, 0.02);
  EXPECT_LT(HeldOutAde(study, FitRod(study, {RodKind::kMlp, {3}})), 0.25 * constant);
}

TEST(RodFit, ResultsComeBackFromJsonWithoutLoss) {
  Study study = PlantedStudy(PlantedRod(), 0.002, kPlantedLift);
  study.options.network_prior = 1.0;
  const FittedModel model{FitRod(study, {RodKind::kMlp, {2}}), {}, {}, {}, {}};
  const nlohmann::ordered_json json = ToJson(model, RunInfo{});
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(ToJson(read, RunInfo{}).dump(), json.dump());
  EXPECT_EQ(HeldOutAde(study, read.fit), HeldOutAde(study, model.fit));
  const std::string text = DetailsText(read);
  EXPECT_TRUE(Contains(text, "rod mlp:2 (26 weights, prior 1)"));
  EXPECT_TRUE(Contains(text, "rod_lift"));
}

// A law of too many weights for a Jacobian learns by its gradient; the lift is fitted after it.
TEST(RodFit, LargeLawsLearnByTheirGradient) {
  Study study = PlantedStudy(PlantedRod(), 0.0, kPlantedLift);
  study.options.network_prior = 0.0;
  study.options.max_iterations = 100;
  const RodShape large{RodKind::kMlp, {64, 32}};
  ASSERT_GT(large.num_weights(), kMostGaussNewtonWeights);
  const double constant = HeldOutAde(study, FitWith(study, {}));
  const FitResult result = FitRod(study, large);
  ASSERT_TRUE(result.ok()) << result.message;
  EXPECT_LT(HeldOutAde(study, result), constant);
  EXPECT_NE(result.parameters[kRodLift], 1.0);
}

// A law that begins without any output hides the lift from a look at the start alone.
TEST(RodFit, TheLiftHasAnEffectThoughTheLawBeginsAtZero) {
  const Study study = PlantedStudy(PlantedRod(), 0.002, kPlantedLift);
  FitOptions options = study.options;
  options.model.learned = InitialNetwork({}, 1, {RodKind::kMlp, {2}});
  FreeTerms(&options);
  EXPECT_FALSE(CheckEffects(FitProblem(study.training, options)));
}

// A law that drives the rod away from its length is found at rest, whatever moves it; one that
// leaves it where it is, is not.
TEST(RodFit, FreeModesKnowTheRod) {
  const Study study = PlantedStudy(PlantedRod(), 0.0, kPlantedLift);
  ModelOptions options = study.options.model;
  const ParameterSet<double> p = SyntheticOptions().parameters;
  const double constant = ComputeBehaviour(options, p).fastest_growth;
  LearnedTerms network = *InitialNetwork({}, 1, {RodKind::kLinear, {}});
  const auto growth = [&](double by_rod) {
    network.weights.back() = by_rod;
    options.learned = std::make_shared<const LearnedTerms>(network);
    return ComputeBehaviour(options, p);
  };
  ASSERT_LT(constant, 0.0);
  EXPECT_NEAR(growth(0.0).fastest_growth, constant, 1e-9);  // switched off
  network.weights.front() = 0.1;                            // moved, and never back
  EXPECT_NEAR(growth(0.0).fastest_growth, 0.0, 1e-9);
  EXPECT_FALSE(growth(0.0).unstable());
  network.weights.front() = 0.0;
  EXPECT_NEAR(growth(-3.0).fastest_growth, constant, 1e-6);  // gone at 6 1/s
  // 0.1 m/s for 0.05 m: a rate of 2 1/s, up to a step's square.
  EXPECT_NEAR(growth(1.0).fastest_growth, 2.0, 0.1);
  EXPECT_TRUE(growth(1.0).self_propelling);
}

}  // namespace
}  // namespace pushid
