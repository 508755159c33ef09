// Scores by hand: hipADE, hipFDE, both means, baselines, failures.
#include "ident/prediction/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// One person whose hip is at (t^2, 0, 1) cm-wise: 0, 0.01, 0.04, 0.09, ... m.
PendulumRecording Parabola(const std::string& id, int frames) {
  PendulumRecording recording;
  recording.id = id;
  recording.labels.Set(kSettingLabel, "single");
  recording.labels.Set(kMagnitudeLabel, frames > 4 ? "strong" : "weak");
  recording.subject_ids = {"S" + id};
  recording.scene.people.resize(1);
  recording.scene.people[0].body = {80.0, 1.0, 0.0};
  recording.hip.resize(1);
  recording.states.resize(1, std::vector<PendulumState<double>>(frames));
  for (int t = 0; t < frames; ++t) recording.hip[0].push_back({0.01 * t * t, 0.0, 1.0});
  recording.scene.pushes.push_back(
      MakeScenePush(0, 0, PushKind::kNet, {Vector4<double>::Zero(), Vector4<double>::Zero()}));
  return recording;
}

TEST(Evaluation, StaticByHand) {
  const PendulumRecording r = Parabola("a", 4);
  const RecordingScore score = ScoreHip(r, StaticBaseline(r));
  EXPECT_EQ(score.id, "a");
  EXPECT_EQ(score.frames, 4);
  EXPECT_NEAR(score.value[kHipAde], (0.01 + 0.04 + 0.09) / 3.0, 1e-15);  // frame 0 does not count
  EXPECT_NEAR(score.value[kHipFde], 0.09, 1e-15);
}

// The push ends at frame 2: known up to there, then 0.03 m a frame.
TEST(Evaluation, ConstantVelocityByHand) {
  const PendulumRecording r = Parabola("a", 5);
  const HipPaths path = ConstantVelocityBaseline(r);
  const double expected[] = {0.0, 0.01, 0.04, 0.07, 0.10};
  for (int t = 0; t < 5; ++t) EXPECT_NEAR(path[0][t][0], expected[t], 1e-15) << t;
  const RecordingScore score = ScoreHip(r, path);
  EXPECT_NEAR(score.value[kHipAde], (0.02 + 0.06) / 4.0, 1e-15);
  EXPECT_NEAR(score.value[kHipFde], 0.06, 1e-15);
}

TEST(Evaluation, ConstantVelocityOfAPushBeyondTheEnd) {
  PendulumRecording r = Parabola("a", 4);
  r.scene.pushes[0].start_frame = 10;
  // Something is left to predict: frame 3, 0.09 m, by 0.03 m a frame from frame 2 on.
  EXPECT_NEAR(ScoreHip(r, ConstantVelocityBaseline(r)).value[kHipFde], 0.02, 1e-15);
  r = Parabola("a", 30);
  r.scene.pushes[0].start_frame = 28;
  const HipPaths path = ConstantVelocityBaseline(r);
  EXPECT_EQ(path[0][19], r.hip[0][19]);  // the last frame but ten
  EXPECT_NE(path[0][20], r.hip[0][20]);
}

TEST(Evaluation, APushPaddedByZerosEndsWithItsLastForce) {
  PendulumRecording r = Parabola("a", 30);
  const Vector4<double> force{50.0, 0.0, 0.0, 0.0}, none = Vector4<double>::Zero();
  r.scene.pushes[0] = MakeScenePush(0, 0, PushKind::kExternal, {force, none, force});
  const HipPaths exact = ConstantVelocityBaseline(r);
  std::vector<Vector4<double>> padded(29, none);
  padded[0] = padded[2] = force;
  r.scene.pushes[0] = MakeScenePush(0, 0, PushKind::kExternal, padded);
  EXPECT_EQ(r.scene.pushes[0].EndFrame(), 3);
  EXPECT_EQ(ConstantVelocityBaseline(r), exact);
}

// Frames 0 to 2 are seen: 0, 0.01, 0.04 m, and the last step was 0.03 m.
TEST(Evaluation, BaselinesAfterFirstFramesByHand) {
  const PendulumRecording r = Parabola("a", 5);
  const HipPaths still = StaticBaseline(r, 3), velocity = ConstantVelocityBaseline(r, 3);
  const double stays[] = {0.0, 0.01, 0.04, 0.04, 0.04}, goes[] = {0.0, 0.01, 0.04, 0.07, 0.10};
  for (int t = 0; t < 5; ++t) {
    EXPECT_NEAR(still[0][t][0], stays[t], 1e-15) << t;
    EXPECT_NEAR(velocity[0][t][0], goes[t], 1e-15) << t;
  }
  const RecordingScore score = ScoreHip(r, still, 3);
  EXPECT_NEAR(score.value[kHipAde], (0.05 + 0.12) / 4.0, 1e-15);
  EXPECT_NEAR(score.value[kAfterHipAde], (0.05 + 0.12) / 2.0, 1e-15);
  EXPECT_NEAR(score.value[kHipFde], 0.12, 1e-15);
}

TEST(Evaluation, TheKinematicBaselineFades) {
  const PendulumRecording r = Parabola("a", 60);
  const double dt = r.scene.dt;
  const HipPaths path = KinematicBaseline(r, 20);
  double place = 0.01 * 19 * 19, velocity = 0.02 * 19 / dt, acceleration = 0.02 / (dt * dt);
  for (int t = 20; t < 60; ++t) {
    velocity += dt * (acceleration - velocity);
    acceleration *= std::exp(-dt / 0.25);
    place += dt * velocity;
    EXPECT_NEAR(path[0][t].x(), place, 1e-6) << t;
  }
}

// Frames that were not seen may say anything, the last one too.
TEST(Evaluation, BaselinesLookAtNothingUnseen) {
  PendulumRecording r = Parabola("a", 30);
  r.weight = {std::vector<double>(30, 1.0)};
  r.weight[0][12] = r.weight[0][19] = 0.0;
  PendulumRecording wild = r;
  for (int t : {12, 19}) wild.hip[0][t].setConstant(7.0);
  for (const auto baseline : {ConstantVelocityBaseline, KinematicBaseline}) {
    const HipPaths a = baseline(r, 20), b = baseline(wild, 20);
    for (int t = 20; t < 30; ++t) EXPECT_EQ(a[0][t], b[0][t]) << t;
  }
  EXPECT_NEAR(ConstantVelocityBaseline(r, 20)[0][20].x(), 0.01 * 18 * 18 + 2 * 0.35, 1e-12);
}

TEST(Evaluation, TooManyFirstFramesAreRefusedByName) {
  const std::vector<PendulumRecording> recordings = {Parabola("a", 30), Parabola("b", 11)};
  EXPECT_FALSE(CheckObserved(recordings, 10));
  const std::string error = ProblemOf(CheckObserved(recordings, 11));
  EXPECT_TRUE(Contains(error, "recording b has 11 frames"));
  EXPECT_TRUE(Contains(error, "at most 10"));
  for (int observed : {0, -3}) {
    EXPECT_TRUE(Contains(ProblemOf(CheckObserved(recordings, observed)), "must be at least 1"));
  }
}

TEST(Evaluation, PeopleCountTheSame) {
  PendulumRecording r = Parabola("a", 4);
  r.hip.push_back(std::vector<Vector3<double>>(4, Vector3<double>(0.0, 1.0, 1.0)));
  const RecordingScore score = ScoreHip(r, StaticBaseline(r));
  EXPECT_NEAR(score.value[kHipAde], 0.5 * (0.01 + 0.04 + 0.09) / 3.0, 1e-15);
  EXPECT_NEAR(score.value[kHipFde], 0.5 * 0.09, 1e-15);
}

RecordingScore Scored(double hip_ade, double hip_fde, const std::string& id, int frames) {
  RecordingScore score;
  score.id = id;
  score.frames = frames;
  score.value[kHipAde] = hip_ade;
  score.value[kHipFde] = hip_fde;
  return score;
}

TEST(Evaluation, MeansByHand) {
  const std::vector<PendulumRecording> recordings = {Parabola("a", 4), Parabola("b", 11),
                                                     Parabola("c", 6)};
  const RecordingScore a = Scored(0.1, 0.2, "a", 4), b = Scored(0.4, 0.6, "b", 11);
  RecordingScore c = Scored(9.0, 9.0, "c", 6);
  c.failure = "theta of person 0 leaves the model's domain";
  const ScoreSummary s = Summarize(recordings, {a, b, c});
  EXPECT_EQ(s.recordings.size(), 3u);  // named, but in no mean
  EXPECT_EQ(s.mean.recordings, 2);
  EXPECT_NEAR(s.mean.value[kHipAde], 0.25, 1e-15);
  EXPECT_NEAR(s.mean.value[kHipFde], 0.40, 1e-15);
  // Standard deviation 0.3 / sqrt(2), over sqrt(2).
  EXPECT_NEAR(s.mean.error[kHipAde], 0.15, 1e-15);
  EXPECT_NEAR(s.mean.error[kHipFde], 0.20, 1e-15);
  EXPECT_EQ(s.by.at("magnitude").at("weak").recordings, 1);
  EXPECT_NEAR(s.by.at("magnitude").at("strong").value[kHipAde], 0.4, 1e-15);
  EXPECT_EQ(s.by.at("magnitude").at("strong").error[kHipAde], 0.0);
  EXPECT_EQ(s.by.at("subject").count("Sc"), 0u);
  EXPECT_NEAR(s.by.at("subject").at("Sa").value[kHipFde], 0.2, 1e-15);
  EXPECT_EQ(s.by.at("setting").at("single").recordings, 2);
  EXPECT_TRUE(s.without_label.empty());
}

// A label that no program knows groups as the usual ones do.
TEST(Evaluation, AnyLabelGroupsScores) {
  std::vector<PendulumRecording> recordings = {Parabola("a", 4), Parabola("b", 4),
                                               Parabola("c", 4)};
  recordings[0].labels.Set("footwear", "boots");
  recordings[1].labels.Set("footwear", "boots");
  const RecordingScore a = Scored(0.1, 0.2, "a", 4), b = Scored(0.4, 0.6, "b", 4),
                       c = Scored(9.0, 9.0, "c", 4);
  const ScoreSummary s =
      Summarize(recordings, {a, b, c}, 0, false, ParseLabelKeys("footwear, subject"));
  EXPECT_EQ(s.by.size(), 2u);
  EXPECT_EQ(s.by.at("footwear").size(), 1u);  // c has none
  EXPECT_NEAR(s.by.at("footwear").at("boots").value[kHipAde], 0.25, 1e-15);
  EXPECT_EQ(s.without_label, (WithoutLabel{{"footwear", 1}}));
  EXPECT_EQ(WithoutLabelText(s.without_label),
            "1 recording has no footwear: it is in no group by footwear\n");
  EXPECT_EQ(s.by.at("subject").size(), 3u);
  EXPECT_FALSE(CheckGroups(recordings, {"footwear", "subject"}));
  const MaybeError error = CheckGroups(recordings, {"subject", "shoes"});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message,
            "--group_by is 'shoes', a label that no recording has; there are "
            "footwear, magnitude, setting, subject");
}

TEST(Evaluation, NothingScored) {
  RecordingScore failed = Scored(0.0, 0.0, "a", 4);
  failed.failure = "fails";
  const ScoreSummary s = Summarize({Parabola("a", 4)}, {failed});
  EXPECT_EQ(s.mean.recordings, 0);
  EXPECT_EQ(s.mean.value[kHipAde], 0.0);
  EXPECT_TRUE(s.by.at("subject").empty());
}

TEST(Evaluation, TheTruthScoresZero) {
  const SyntheticOptions study = SmallStudy();
  const Evaluation e = Evaluate(TruthOf(study), MakePendulums(study));
  EXPECT_EQ(e.model.mean.recordings, 24);
  EXPECT_LT(e.model.mean.value[kHipAde], 1e-9);
  EXPECT_GT(e.Baseline("static").mean.value[kHipAde], 0.05);
  EXPECT_GT(e.Baseline("constant_velocity").mean.value[kHipAde], 0.0);
  EXPECT_EQ(e.model.by.at("subject").size(), 4u);
}

TEST(Evaluation, AFailedRolloutIsNamedAndInNoMean) {
  const SyntheticOptions study = SmallStudy();
  std::vector<PendulumRecording> recordings = MakePendulums(study);
  recordings[5].scene = ScalePushes(recordings[5].scene, 40.0);
  const Evaluation e = Evaluate(TruthOf(study), recordings);
  const RecordingScore& failed = e.model.recordings[5];
  EXPECT_EQ(failed.id, recordings[5].id);
  EXPECT_TRUE(Contains(failed.failure, "of person 0 leaves the model's domain at frame"));
  EXPECT_TRUE(failed.fell);
  EXPECT_EQ(e.model.mean.recordings, 23);
  EXPECT_LT(e.model.mean.value[kHipAde], 1e-9);
  EXPECT_EQ(e.Baseline("static").mean.recordings, 24);
}

}  // namespace
}  // namespace pushid
