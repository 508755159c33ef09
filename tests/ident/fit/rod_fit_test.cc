// Fits with a rod that moves: a planted law is found again in what it predicts, and results keep
// it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/diagnostics/diagnostics.h"
#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/parameters/presets.h"
#include "ident/prediction/prediction.h"
#include "ident/report/page/build_report.h"
#include "ident/solver/solver.h"
#include "tests/ident/network_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Knees that give way to a lean, to speed and to the force on the cart, and straighten again: one
// unit, far from where it is rectified.
std::shared_ptr<const LearnedTerms> PlantedRod() {
  LearnedTerms network;
  network.rod = {RodKind::kLdp, {1}};
  network.weights = {-1.0, 0.3, -2.5, 0.5, -0.5, 0.0, 1.0,  0.0,
                     0.0,  0.0, -1.0, 0.0, 20.0, 1.0, -20.0};
  return std::make_shared<const LearnedTerms>(network);
}

FitResult FitRod(const Study& study, const RodShape& rod) {
  FitOptions options = study.options;
  options.model.learned = InitialNetwork({}, 1, rod);
  FreeTerms(&options);
  return Fit(study.training, options);
}

TEST(RodFit, PlantedLawsPredictUnseenPushes) {
  Study study = PlantedStudy(PlantedRod(), 0.0);
  study.options.network_prior = 0.0;
  const double constant = HeldOutAde(study, FitWith(study, {}));
  EXPECT_GT(constant, 0.01);
  EXPECT_LT(HeldOutAde(study, FitRod(study, {RodKind::kLdp, {4}})), 0.25 * constant);
}

TEST(RodFit, ResultsComeBackFromJsonWithoutLoss) {
  Study study = PlantedStudy(PlantedRod(), 0.002);
  study.options.network_prior = 1.0;
  const FittedModel model{FitRod(study, {RodKind::kLdp, {2}}), {}, {}, {}, {}};
  const nlohmann::ordered_json json = ToJson(model, RunInfo{});
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(ToJson(read, RunInfo{}).dump(), json.dump());
  EXPECT_EQ(HeldOutAde(study, read.fit), HeldOutAde(study, model.fit));
  const std::string text = DetailsText(read);
  EXPECT_TRUE(Contains(text, "rod ldp:2 (29 weights, prior 1)"));
}

// A law of too many weights for a Jacobian learns by its gradient.
TEST(RodFit, LargeLawsLearnByTheirGradient) {
  Study study = PlantedStudy(PlantedRod(), 0.0);
  study.options.network_prior = 0.0;
  study.options.max_iterations = 100;
  const RodShape large{RodKind::kLdp, {64, 32}};
  ASSERT_GT(large.num_weights(), kMostGaussNewtonWeights);
  const double constant = HeldOutAde(study, FitWith(study, {}));
  const FitResult result = FitRod(study, large);
  ASSERT_TRUE(result.ok()) << result.message;
  EXPECT_LT(HeldOutAde(study, result), constant);
}

}  // namespace
}  // namespace pushid
