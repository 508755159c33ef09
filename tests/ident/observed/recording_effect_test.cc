// Spread and error scale of planted effects; where there are none; the file.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "ident/model/model_fields.h"
#include "ident/observed/recording_filter.h"
#include "tests/ident/effect_samples.h"

namespace pushid {
namespace {

// 64 recordings: the drawn effects' own spread has a standard error of 0.035.
SyntheticOptions ManyRecordings() {
  SyntheticOptions study = SmallStudy();
  study.subjects = 8;
  study.recordings_per_subject = 8;
  return study;
}

TEST(RecordingEffect, FindsPlantedSpreadAndErrorScale) {
  const SyntheticOptions study = ManyRecordings();
  const IdentifiedModel model = TrueModel(study);
  const std::vector<PendulumRecording> scenes = MakePendulums(study);
  for (uint64_t seed : {1, 2, 3}) {
    std::vector<double> drawn;
    const auto recordings = PlantEffects(model, scenes, {0.4, 0.1, seed}, &drawn);
    const auto effect = FitRecordingEffect(model, recordings, 2);
    ASSERT_TRUE(effect.has_value());
    EXPECT_NEAR(effect->spread, 0.4, 0.1) << seed;
    EXPECT_NEAR(effect->error_scale, 0.1, 0.005) << seed;
    EXPECT_GT(effect->spread_error, 0.01);
    EXPECT_LT(effect->spread_error, 0.15);
    EXPECT_EQ(effect->clusters, 8);
    EXPECT_GT(effect->explained, 0.2);
    EXPECT_LT(effect->explained, 1.0);
    ASSERT_EQ(effect->recordings.size(), drawn.size());
    double within = 0.0;
    for (size_t i = 0; i < drawn.size(); ++i) {
      const EffectOfRecording& r = effect->recordings[i];
      EXPECT_LT(r.error, 0.41) << r.id;
      within += std::abs(r.mean - drawn[i]) < 1.96 * r.error;
    }
    EXPECT_GE(within / static_cast<double>(drawn.size()), 0.87) << seed;
  }
}

TEST(RecordingEffect, IsSmallWhereRecordingsDoNotDiffer) {
  const SyntheticOptions study = ManyRecordings();
  const IdentifiedModel model = TrueModel(study);
  const auto recordings = PlantEffects(model, MakePendulums(study), {0.0, 0.1, 4});
  const auto effect = FitRecordingEffect(model, recordings);
  ASSERT_TRUE(effect.has_value());
  EXPECT_LT(effect->spread, 0.15);
  EXPECT_NEAR(effect->error_scale, 0.1, 0.005);
}

// A sideways push is as good as one forwards: axes go with it.
TEST(RecordingEffect, DoesNotCareWhereAPushComesFrom) {
  SyntheticOptions study = SmallStudy();
  const IdentifiedModel model = TrueModel(study);
  const auto recordings = PlantEffects(model, MakePendulums(study), {0.4, 0.1, 5});
  const RecordingFilter filter(model, recordings[0], recordings[0].num_frames());
  const Eigen::Vector2d u = PushDirection(recordings[0]);
  EXPECT_NEAR(filter.Axes().col(0).head<2>().dot(u), 1.0, 1e-12);
  EXPECT_NEAR(filter.Axes().determinant(), 1.0, 1e-12);
}

TEST(RecordingEffect, NeedsATailAndOnePersonAlone) {
  const SyntheticOptions study = TinyStudy();
  IdentifiedModel model = TrueModel(study);
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  EXPECT_TRUE(EffectActs(model.options, recordings[0]));
  PendulumRecording measured = recordings[0];
  for (ScenePush& push : measured.scene.pushes) push.kind = PushKind::kExternal;
  EXPECT_FALSE(EffectActs(model.options, measured));
  const auto effect = FitRecordingEffect(model, {measured});
  ASSERT_TRUE(effect.has_value());
  EXPECT_EQ(effect->spread, 0.0);
  EXPECT_TRUE(effect->recordings.empty());
  model.options.push_tail = PushTail::kNone;
  EXPECT_FALSE(EffectActs(model.options, recordings[0]));
  EXPECT_FALSE(FitRecordingEffect(model, recordings).has_value());
}

TEST(RecordingEffect, GroupsHaveErrorsAlone) {
  SyntheticOptions study = TinyStudy();
  study.people_in_row = 3;
  study.model.interaction.spring = study.model.interaction.damping = true;
  study.parameters[kContactStiffness] = 2900.0, study.parameters[kContactDistance] = 0.42;
  study.parameters[kContactKappa] = 0.41, study.parameters[kContactDamping] = 270.0;
  study.parameters[kContactHeight] = 0.5;
  study.subjects = 3;
  const IdentifiedModel model = TrueModel(study);
  const auto recordings = PlantEffects(model, MakePendulums(study), {0.0, 0.05, 6});
  const auto effect = FitRecordingEffect(model, recordings);
  ASSERT_TRUE(effect.has_value());
  EXPECT_EQ(effect->spread, 0.0);
  EXPECT_NEAR(effect->error_scale, 0.05, 0.004);
}

// Weights follow Bayes' rule at three nodes by hand.
TEST(RecordingEffect, WeightsByHand) {
  std::vector<double> misfit(kEffectNodes, INFINITY);
  misfit[16] = 0.0, misfit[20] = 0.02;
  const std::vector<double> weights = EffectWeights(misfit, 0.4, 0.1);
  const double odds = std::exp(-0.5 * (0.4 * 0.4 / 0.16 + 0.02 / 0.01));
  EXPECT_NEAR(weights[20] / weights[16], odds, 1e-12);
  EXPECT_NEAR(weights[16] + weights[20], 1.0, 1e-12);
  EXPECT_NEAR(MeanEffect(weights).mean, 0.4 * weights[20], 1e-12);
  EXPECT_EQ(EffectWeights(std::vector<double>(kEffectNodes, 0.0), 0.0, 0.1)[16], 1.0);
}

TEST(RecordingEffect, SurvivesAFile) {
  const SyntheticOptions study = TinyStudy();
  const IdentifiedModel model = TrueModel(study);
  const auto effect =
      FitRecordingEffect(model, PlantEffects(model, MakePendulums(study), {0.4, 0.1, 7}));
  ASSERT_TRUE(effect.has_value());
  const auto json = JsonOf(*effect);
  EXPECT_EQ(JsonOf(FromJson<RecordingEffect>(json)), json);
  auto damaged = json;
  damaged["error_scale_m"] = 0.0;
  EXPECT_THROW(FromJson<RecordingEffect>(damaged), std::runtime_error);
  damaged = json;
  damaged.erase("spread");
  EXPECT_ANY_THROW(FromJson<RecordingEffect>(damaged));
}

}  // namespace
}  // namespace pushid
