// Fits with a self-force network: a planted one is found again (its predictions, not its weights),
// what guards a training, and what a result keeps of it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "ident/checks/model_checks.h"
#include "ident/fit/fit.h"
#include "ident/model/model_json.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/page/build_report.h"
#include "ident/solver/solver.h"
#include "tests/ident/network_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

TEST(NetworkFit, PredictsUnseenPushesAsTheTruthDoes) {
  const NetworkShape planted{NetworkKind::kMlp, 3};
  const Study study = PlantedStudy(PlantedNetwork(planted), 0.0);
  const double without = HeldOutAde(study, FitWith(study, {}));
  const double with = HeldOutAde(study, FitWith(study, planted));
  EXPECT_GT(without, 0.002);
  EXPECT_LT(with, 0.2 * without);
}

// Where there is nothing to learn, a weak network learns nothing that shows.
TEST(NetworkFit, LeavesPhysicsAloneWhereThereIsNothingToLearn) {
  SyntheticOptions synthetic = SmallStudy();
  synthetic.joint_noise_m = 0.002;
  FitOptions options = UnbiasedFit(synthetic);
  options.model.learned = InitialNetwork({NetworkKind::kMlp, 4}, 1);
  options.network_prior = 0.3;
  const FitResult result = Fit(MakePendulums(synthetic), options);
  ASSERT_TRUE(result.ok()) << result.message;
  EXPECT_NEAR(result.parameters[kKpTheta], synthetic.parameters[kKpTheta],
              0.1 * synthetic.parameters[kKpTheta]);
}

TEST(NetworkFit, ThreadsDoNotMatter) {
  Study study = PlantedStudy(PlantedNetwork({NetworkKind::kMlp, 2}), 0.002);
  study.options.network_prior = 1.0;
  const FitResult one = FitWith(study, {NetworkKind::kMlp, 2});
  const FitResult again = FitWith(study, {NetworkKind::kMlp, 2});
  study.options.num_threads = 2;
  const FitResult two = FitWith(study, {NetworkKind::kMlp, 2});
  EXPECT_EQ(one.parameters, again.parameters);
  EXPECT_EQ(one.options.model.learned->weights, again.options.model.learned->weights);
  EXPECT_NEAR(two.cost, one.cost, 1e-9 * one.cost);
  for (Parameter id : one.options.table.Free()) {
    EXPECT_NEAR(two.parameters[id], one.parameters[id], 1e-9 * std::abs(one.parameters[id]));
  }
}

TEST(NetworkFit, ResultsComeBackFromJsonWithoutLoss) {
  Study study = PlantedStudy(PlantedNetwork({NetworkKind::kMlp, 2}), 0.002);
  study.options.network_prior = 1.0;
  const FittedModel model{FitWith(study, {NetworkKind::kMlp, 2}), {}, {}, {}, {}};
  const FitResult& result = model.fit;
  const nlohmann::ordered_json json = ToJson(model, RunInfo{});
  const FittedModel read = Unwrapped(FittedModelFromJson(json, "model.json"));
  EXPECT_EQ(ToJson(read, RunInfo{}).dump(), json.dump());
  EXPECT_EQ(read.fit.options.model.learned->weights, result.options.model.learned->weights);
  EXPECT_EQ(HeldOutAde(study, read.fit), HeldOutAde(study, result));
  EXPECT_TRUE(Contains(DetailsText(read), "mlp:2"));
  // Weights are not in the table.
  for (const Estimate& e : read.fit.nuisance) {
    EXPECT_FALSE(Contains(e.name, "weight"));
  }
}

// The weights, of which a result keeps no covariance, follow along.
TEST(NetworkFit, ProfilesAreAsWideAsTheClusteredIntervals) {
  Study study = PlantedStudy(PlantedNetwork({NetworkKind::kMlp, 2}), 0.005);
  study.options.network_prior = 1.0;
  FittedModel model{FitWith(study, {NetworkKind::kMlp, 2}), {}, {}, {}, {}};
  const FitResult& result = model.fit;
  ASSERT_FALSE(AddProfiles(study.training, {"mu", "Kp_theta"}, 1, nullptr, &model));
  ASSERT_EQ(model.profiles.size(), 2u);
  for (const Profile& profile : model.profiles) {
    const auto estimate = std::find_if(result.estimates.begin(), result.estimates.end(),
                                       [&](const Estimate& e) { return e.name == profile.name; });
    ASSERT_NE(estimate, result.estimates.end());
    const double width = estimate->upper95 - estimate->lower95;
    EXPECT_NEAR(profile.lower95, estimate->lower95, 0.25 * width) << profile.name;
    EXPECT_NEAR(profile.upper95, estimate->upper95, 0.25 * width) << profile.name;
  }
}

TEST(NetworkFit, FilesThatContradictThemselvesAreNamed) {
  Study study = PlantedStudy(PlantedNetwork({NetworkKind::kMlp, 2}), 0.002);
  const nlohmann::ordered_json good =
      ToJson({FitWith(study, {NetworkKind::kMlp, 2}), {}, {}, {}, {}}, RunInfo{});
  const auto complaint = [](const nlohmann::ordered_json& json) {
    const Result<FittedModel> read = FittedModelFromJson(json, "model.json");
    return read.ok() ? "" : read.error().ToString();
  };
  EXPECT_EQ(complaint(good), "");
  nlohmann::ordered_json without = good;
  without.erase("self_network");
  EXPECT_TRUE(Contains(complaint(without), "self_force is mlp:2"));
}

}  // namespace
}  // namespace pushid
