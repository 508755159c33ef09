// Metrics of bodies against cases made by hand; means; baselines.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ident/bodies/body_evaluation.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

BodyRecording Standing(int frames, const std::string& id = "a") {
  BodyRecording recording;
  recording.pendulum.id = id;
  recording.pendulum.labels.Set(kSettingLabel, "single");
  recording.pendulum.labels.Set(kMagnitudeLabel, "weak");
  recording.pendulum.subject_ids = {"s"};
  const RestorationInput person = WithPendulum(StandingPose(), 80);
  recording.pendulum.scene.people.push_back({person.body, {person.q[0], Vector4<double>::Zero()}});
  recording.bodies = {BodyMotion(frames, StandingPose())};
  recording.pendulum.hip = {std::vector<Vector3<double>>(frames, StandingPose().col(0))};
  recording.pendulum.states = {
      std::vector<PendulumState<double>>(frames, {person.q[0], Vector4<double>::Zero()})};
  return recording;
}

TEST(BodyMetricsTest, TheRecordingItselfScoresZero) {
  const BodyRecording recording = Standing(10);
  const BodyScore score = ScoreBodies(recording, recording.bodies);
  for (double value : score.value) EXPECT_EQ(value, 0.0);
}

TEST(BodyMetricsTest, ABodyMovedAsAWhole) {
  const BodyRecording recording = Standing(11);
  std::vector<BodyMotion> moved = recording.bodies;
  for (int t = 0; t < 11; ++t) moved[0][t] = Placed(StandingPose(), 0.0, {0.01 * t, 0, 0});
  const BodyScore score = ScoreBodies(recording, moved);
  EXPECT_NEAR(score.value[kMpjpe], 0.055, 1e-12);  // mean of 0.01 .. 0.10
  EXPECT_NEAR(score.value[kHipAde], 0.055, 1e-12);
  EXPECT_NEAR(score.value[kHipFde], 0.10, 1e-12);
  EXPECT_NEAR(score.value[kRelativeMpjpe], 0.0, 1e-12);
  EXPECT_NEAR(score.value[kMble], 0.0, 1e-12);
  EXPECT_NEAR(score.value[kFse], 1.0, 1e-9);  // 1 cm a frame on the floor: 2 - 2^0 = 1
}

// Ten frames, of which six are shown; after them the body is 5, 10, 15 and 20 cm off.
TEST(BodyMetricsTest, ShownFramesDoNotCount) {
  const BodyRecording recording = Standing(10);
  std::vector<BodyMotion> moved = recording.bodies;
  for (int t = 6; t < 10; ++t) moved[0][t] = Placed(StandingPose(), 0.0, {0.05 * (t - 5), 0, 0});
  const BodyScore all = ScoreBodies(recording, moved), after = ScoreBodies(recording, moved, 6);
  EXPECT_NEAR(all.value[kMpjpe], 0.5 / 9.0, 1e-12);
  EXPECT_NEAR(after.value[kMpjpe], 0.125, 1e-12);
  EXPECT_NEAR(after.value[kHipAde], 0.125, 1e-12);
  EXPECT_NEAR(after.value[kHipFde], 0.20, 1e-12);
  EXPECT_NEAR(all.value[kFse], 5.0 * 4.0 / 9.0, 1e-9);  // four of nine ways
  EXPECT_NEAR(after.value[kFse], 5.0, 1e-9);
  EXPECT_EQ(after.first_frame, 6);
}

TEST(BodyMetricsTest, OneJointOffCountsOneInTwentyTwo) {
  const BodyRecording recording = Standing(5);
  std::vector<BodyMotion> bent = recording.bodies;
  for (int t = 1; t < 5; ++t) bent[0][t].col(kBodyHead) += Eigen::Vector3d(0, 0, 0.22);
  const BodyScore score = ScoreBodies(recording, bent);
  EXPECT_NEAR(score.value[kMpjpe], 0.01, 1e-12);
  EXPECT_NEAR(score.value[kRelativeMpjpe], 0.01, 1e-12);
  EXPECT_EQ(score.value[kHipAde], 0.0);
  // One bone, from neck to head (0.02, 0, 0.10), is longer.
  const double before = std::hypot(0.02, 0.10), after = std::hypot(0.02, 0.32);
  EXPECT_NEAR(score.value[kMble], (after - before) / 21.0, 1e-12);
}

TEST(BodyMetricsTest, FootSkateByHeight) {
  BodyMotion motion(3, StandingPose());
  EXPECT_EQ(FootSkate(motion), 0.0);
  // The left ankle slides 3 cm at a height of half of H: weight 2 - sqrt(2); the right one stands.
  motion[1].col(kLeftAnkle) += Eigen::Vector3d(0.03, 0, 0.0125);
  motion[2].col(kLeftAnkle) += Eigen::Vector3d(0.03, 0, 0.0125);
  EXPECT_NEAR(FootSkate(motion), 3.0 * (2.0 - std::sqrt(2.0)) / 4.0, 1e-9);
  // In the air it does not count at all.
  for (int t : {1, 2}) motion[t].col(kLeftAnkle).z() += 0.02;
  EXPECT_EQ(FootSkate(motion), 0.0);
  for (int t : {1, 2}) motion[t].col(kRightAnkle).z() += 0.05;
  EXPECT_LT(FootSkate(motion), 0.0) << "no foot touches the floor";
}

TEST(BodyMetricsTest, TheOrderOfPeopleMakesNoDifference) {
  BodyRecording recording = Standing(6);
  recording.bodies.push_back(BodyMotion(6, Placed(StandingPose(), 0.3, {1, 1, 0})));
  recording.pendulum.hip.push_back(recording.pendulum.hip[0]);
  std::vector<BodyMotion> predicted = recording.bodies;
  for (int t = 1; t < 6; ++t) predicted[1][t].col(kLeftAnkle) += Eigen::Vector3d(0.02 * t, 0, 0);
  const BodyScore one = ScoreBodies(recording, predicted);
  std::swap(recording.bodies[0], recording.bodies[1]);
  std::swap(predicted[0], predicted[1]);
  const BodyScore other = ScoreBodies(recording, predicted);
  EXPECT_TRUE(one.value.isApprox(other.value, 1e-15));
}

// One second is 60 frames; one recording lasts for it, none for two. All joints are t mm off at
// frame t, the head 0.22 m more: the mean of t over 1 .. 60 is 30.5, and 0.22 / 22 is 0.01.
TEST(BodyMetricsTest, ErrorsUpToFixedTimes) {
  const std::vector<BodyRecording> recordings = {Standing(70, "a"), Standing(40, "b")};
  std::vector<BodyScore> scores;
  for (const BodyRecording& recording : recordings) {
    std::vector<BodyMotion> predicted = recording.bodies;
    for (size_t t = 1; t < predicted[0].size(); ++t) {
      predicted[0][t].colwise() += Eigen::Vector3d(0.001 * t, 0, 0);
      predicted[0][t].col(kBodyHead) += Eigen::Vector3d(0.22, 0, 0);
    }
    scores.push_back(ScoreBodies(recording, predicted));
    EXPECT_FALSE(ScoreBodies(recording, predicted, 30).at[1]);
  }
  EXPECT_NEAR(ScoreBodies(recordings[0], recordings[0].bodies, 5).at[0]->maxCoeff(), 0.0, 1e-12);
  EXPECT_FALSE(ScoreBodies(recordings[0], recordings[0].bodies, 11).at[0]) << "frame 70 is no more";
  const BodySummary summary = SummarizeBodies(recordings, scores);
  EXPECT_EQ(summary.at[0].recordings, 1);
  const auto json = ToJson(summary, false)["errors_at"];
  EXPECT_NEAR(json[0]["root_m"].get<double>(), 0.0305, 1e-12);
  EXPECT_NEAR(json[0]["pose_m"].get<double>(), 0.01, 1e-12);
  EXPECT_NEAR(json[0]["total_m"].get<double>(), 0.0405, 1e-12);
  EXPECT_TRUE(json[1]["total_m"].is_null());
  EXPECT_EQ(summary.at[1].recordings, 0);
  const std::string text = TimedErrorsText({{"generator", summary}});
  EXPECT_TRUE(Contains(text, "total to 1 s"));
  EXPECT_TRUE(Contains(text, "0.041"));
  EXPECT_TRUE(Contains(text, "none"));
}

TEST(BodyMetricsTest, BothMeansAndTheirErrors) {
  const std::vector<BodyRecording> recordings = {Standing(11, "a"), Standing(31, "b"),
                                                 Standing(5, "c")};
  std::vector<BodyScore> scores(3);
  for (int i = 0; i < 3; ++i) scores[i].frames = recordings[i].num_frames();
  scores[2].failure = "it fell";
  scores[0].value[kMpjpe] = 0.1;
  scores[1].value[kMpjpe] = 0.3;
  const BodySummary summary = SummarizeBodies(recordings, scores);
  EXPECT_EQ(summary.mean.recordings, 2);
  EXPECT_NEAR(summary.mean.value[kMpjpe], 0.2, 1e-12);
  EXPECT_NEAR(summary.mean.error[kMpjpe], 0.1, 1e-12);  // 0.1414 / sqrt(2)
  EXPECT_EQ(summary.by.at("magnitude").at("weak").recordings, 2);
  EXPECT_EQ(summary.by.at("subject").at("s").recordings, 2);
}

TEST(BodyEvaluationTest, Baselines) {
  BodyRecording recording = Standing(8);
  for (int t = 0; t < 8; ++t) {
    recording.bodies[0][t] = Placed(StandingPose(), 0.0, {0.01 * t * t, 0, 0});
  }
  recording.pendulum.scene.pushes.push_back(MakeScenePush(
      0, 0, PushKind::kExternal, std::vector<Vector4<double>>(3, Vector4<double>::Zero())));
  const BodyMotion still = StaticBodies(recording)[0], going = ConstantVelocityBodies(recording)[0];
  EXPECT_EQ(still[7], StandingPose());
  for (int t = 0; t <= 3; ++t) EXPECT_EQ(going[t], recording.bodies[0][t]);
  EXPECT_NEAR(going[7](0, 5) - going[3](0, 5), 4 * 0.05, 1e-12);  // 0.09 - 0.04 a frame
}

TEST(BodyReportTest, KeysAreTheAgreedOnesAndJoinThoseOfThePendulum) {
  const std::vector<BodyRecording> recordings = {Standing(9)};
  BodyScores scores;
  for (const char* name : {"restoration", "rigid", "static", "true_pendulum", "recorded"}) {
    scores[name].push_back(ScoreBodies(recordings[0], recordings[0].bodies));
  }
  nlohmann::ordered_json json = {{"mean", {{"hipADE_m", 0.5}, {"recordings", 1}}},
                                 {"recordings", {{{"id", "a"}, {"fell", false}}}},
                                 {"baselines", {{"static", {{"mean", {{"hipADE_m", 0.7}}}}}}}};
  AddBodyJson(SummarizeAll(recordings, scores), &json);
  for (const char* key :
       {"MPJPE_m", "hipADE_m", "hipFDE_m", "MBLE_m", "FSE_cm", "relative_MPJPE_m"}) {
    EXPECT_TRUE(json["mean"].contains(key)) << key;
    EXPECT_TRUE(json["recordings"][0].contains(key)) << key;
    EXPECT_TRUE(json["baselines"]["rigid"]["mean"].contains(key)) << key;
    EXPECT_TRUE(json["by_setting"]["single"].contains(key)) << key;
    EXPECT_TRUE(json["true_pendulum"]["mean"].contains(key)) << key;
  }
  EXPECT_EQ(json["recordings"][0]["fell"], false);
}

// Groups are judged together; a recording of one person says nothing of groups.
TEST(BodyReportTest, GroupsHaveMetricsOfTheirOwn) {
  BodyRecording group = Standing(30), alone = Standing(30, "b");
  group.bodies.push_back(BodyMotion(30, Placed(StandingPose(), 0.0, {0.6, 0, 0})));
  group.pendulum.hip.push_back(group.pendulum.hip[0]);
  group.pendulum.states.push_back(group.pendulum.states[0]);
  for (int t = 10; t < 30; ++t) {
    group.bodies[0][t] = Placed(StandingPose(), 0.0, {0.015 * (t - 9), 0, 0});
  }
  BodyScores scores;
  for (const BodyRecording* recording : {&group, &alone}) {
    scores["recorded"].push_back(ScoreBodies(*recording, recording->bodies));
    scores["static"].push_back(ScoreBodies(*recording, StaticBodies(*recording)));
  }
  const BodyEvaluation evaluation = SummarizeAll({group, alone}, scores);
  nlohmann::ordered_json json;
  AddBodyJson(evaluation, &json);
  const nlohmann::ordered_json& recorded = json["recorded"]["group_metrics"];
  EXPECT_EQ(recorded["recordings"], 1);
  EXPECT_EQ(recorded["pushed_named"], 1);
  EXPECT_EQ(recorded["sscp"], 0.0);
  // Steps at rest count half: 45 of one person and all 209 of the other, of 22 words of 19 steps.
  EXPECT_NEAR(recorded["ndms"].get<double>(), 1.0 - 0.5 * 254.0 / 418.0, 1e-9);
  EXPECT_EQ(json["baselines"]["static"]["group_metrics"]["missed_movers"], 1);
  EXPECT_TRUE(Contains(BodyText(evaluation), "pushed named"));
  const BodyEvaluation of_one = SummarizeAll({alone}, {{"static", {scores["static"][1]}}});
  EXPECT_FALSE(of_one.at("static").groups.has_value());
  EXPECT_FALSE(Contains(BodyText(of_one), "pushed named"));
}

}  // namespace
}  // namespace pushid
