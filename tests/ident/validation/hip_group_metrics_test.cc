// Groups of which hips alone are predicted: a case by hand, and cross-validation.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/validation/crossvalidation.h"
#include "ident/validation/group_metrics.h"
#include "ident/validation/scores_report.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr int kHipFrames = 60;

// Two stiff people, one 0.6 m before the other; each goes forwards by 1.5 cm a frame from a frame
// on.
std::vector<BodyMotion> Stiff(int begin, int begin_in_front) {
  std::vector<BodyMotion> people;
  for (const auto& [x, from] : {std::pair(0.0, begin), std::pair(0.6, begin_in_front)}) {
    BodyMotion motion;
    for (int t = 0; t < kHipFrames; ++t) {
      const double way = 0.015 * std::max(0, t - from);
      motion.push_back(Placed(StandingPose(), 0.0, {x + way, 0, 0}));
    }
    people.push_back(motion);
  }
  return people;
}

HipPaths HipsOf(const std::vector<BodyMotion>& people) {
  HipPaths hips;
  for (const BodyMotion& motion : people) {
    hips.emplace_back();
    for (const Pose& pose : motion) hips.back().push_back(pose.col(kBodyHip));
  }
  return hips;
}

PendulumRecording RecordingOf(const std::vector<BodyMotion>& people) {
  PendulumRecording recording;
  recording.id = "walkers";
  recording.scene.dt = 1.0 / 60.0;
  recording.scene.people.resize(people.size());
  recording.subject_ids = {"A", "B"};
  recording.hip = HipsOf(people);
  return recording;
}

TEST(HipGroupMetricsTest, OnsetsNeedNoBodies) {
  const std::vector<PendulumRecording> recordings = {RecordingOf(Stiff(4, 10))};
  EXPECT_FALSE(CompareHips(recordings, {}, {}).has_value());
  const auto metrics =
      CompareHips(recordings, {}, {{0, HipsOf(Stiff(4, 16))}, {0, HipsOf(Stiff(12, 6))}});
  ASSERT_TRUE(metrics.has_value());
  EXPECT_EQ(metrics->onsets.recordings, 2);
  EXPECT_EQ(metrics->onsets.pushed_named, 1);
  EXPECT_EQ(metrics->onsets.in_order, 1);
  EXPECT_NEAR(metrics->onsets.error_sum, (6 + 8 + 4) / 60.0, 1e-12);
  EXPECT_FALSE(metrics->social.sscp || metrics->social.sscp_changes || metrics->social.ndms);
}

// Where rigid people are compared with rigid bodies, all metrics are exact but who it was.
TEST(HipGroupMetricsTest, RigidBodiesAreJudgedWhereBodiesAreKnown) {
  const std::vector<BodyMotion> people = Stiff(4, 10), others = Stiff(20, 22);
  const std::vector<PendulumRecording> recordings = {RecordingOf(people), RecordingOf(others)};
  const RecordedBodies bodies = {people, others};
  const auto same = CompareHips(recordings, bodies, {{0, HipsOf(people)}, {1, HipsOf(others)}});
  EXPECT_NEAR(*same->social.sscp, 0.0, 1e-12);
  // Steps at rest count half: 10 + 55 + 209 + 247 of 164 words of 19 steps.
  const double alike = 1.0 - 0.5 * 521.0 / 3116.0;
  EXPECT_NEAR(*same->social.ndms, alike, 1e-9);
  // Predicted twice, it is the same motion, and twice as many onsets.
  const auto twice = CompareHips(
      recordings, bodies,
      {{0, HipsOf(people)}, {1, HipsOf(others)}, {0, HipsOf(people)}, {1, HipsOf(others)}});
  EXPECT_NEAR(*twice->social.sscp, 0.0, 1e-12);
  EXPECT_NEAR(*twice->social.ndms, alike, 1e-9);
  EXPECT_EQ(twice->onsets.movers, 2 * same->onsets.movers);
  const auto still = CompareHips(recordings, bodies, {{0, HipsOf(Stiff(99, 99))}});
  EXPECT_GT(*still->social.sscp, 0.3);
  EXPECT_FALSE(still->social.sscp_changes.has_value());
  EXPECT_EQ(still->onsets.missed_movers, 2);
}

TEST(HipGroupMetricsTest, CrossValidationHasThem) {
  const std::vector<BodyMotion> people = Stiff(4, 10);
  std::vector<PendulumRecording> recordings(3, RecordingOf(people));
  PendulumRecording alone = RecordingOf({people[0]});
  alone.subject_ids.resize(1);
  recordings.push_back(alone);
  const std::vector<Fold> folds = {{"a", {0, 3}}, {"b", {1, 2}}, {"c", {0}}};
  const Predictor still = BaselinePredictor(kBaselines[0]);
  const CrossValidation hips = CrossValidate(recordings, folds, still, 1);
  const nlohmann::ordered_json json = ToJson(hips)["group_metrics"];
  EXPECT_EQ(json["recordings"], 4) << "one of them twice, and nobody alone";
  EXPECT_EQ(json["pushed_named"], 0);
  EXPECT_EQ(json["missed_movers"], 8);
  EXPECT_TRUE(json["sscp"].is_null());
  const RecordedBodies bodies = {people, people, people, {people[0]}};
  const CrossValidation whole = CrossValidate(recordings, folds, still, 1, nullptr, bodies);
  EXPECT_GT(ToJson(whole)["group_metrics"]["sscp"].get<double>(), 0.3);
  EXPECT_TRUE(Contains(CrossValidationText({whole}), "missed movers"));
  EXPECT_TRUE(Contains(CrossValidationText({whole}), "0 of 4"));
  const CrossValidation single = CrossValidate(recordings, {{"d", {3}}}, still, 1);
  EXPECT_FALSE(ToJson(single).contains("group_metrics"));
}

}  // namespace
}  // namespace pushid
