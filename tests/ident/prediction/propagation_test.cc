// Onsets, movers and bystanders, speed, momentum: by hand and on planted waves.
#include "ident/prediction/propagation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/loading/load_recordings.h"
#include "ident/prediction/evaluation.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/scores_report.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr double kFrameTime = 1.0 / 60.0;

// A hip that stands until `onset`, is 3 cm further then and goes on at 3 cm a frame; -1: it stands.
std::vector<Vector3<double>> HipFrom(double x, int onset, int frames) {
  std::vector<Vector3<double>> hip(frames, Vector3<double>(x, 0.3, 1.0));
  for (int t = onset; onset >= 0 && t < frames; ++t) hip[t][0] += 0.03 * (t - onset + 1);
  return hip;
}

HipPaths Hips(const std::vector<double>& x, const std::vector<int>& onsets, int frames) {
  HipPaths hips;
  for (size_t n = 0; n < x.size(); ++n) hips.push_back(HipFrom(x[n], onsets[n], frames));
  return hips;
}

// People in a row along x, the first pushed along x.
PendulumRecording Row(const std::vector<double>& x, const std::vector<int>& onsets, int frames) {
  PendulumRecording recording;
  recording.id = "row";
  recording.labels.Set(kSettingLabel, "row");
  recording.scene.dt = kFrameTime;
  for (double position : x) {
    ScenePerson person;
    person.body = {80.0, 0.95, 0.0};
    person.start.q[0] = position;
    recording.scene.people.push_back(person);
    recording.subject_ids.push_back("S" + std::to_string(recording.subject_ids.size()));
  }
  recording.hip = Hips(x, onsets, frames);
  recording.scene.pushes.push_back(
      MakeScenePush(0, 0, PushKind::kExternal,
                    HalfSinePush(recording.scene.people[0].body, 80.0, 12, recording.scene.dt)));
  return recording;
}

double Value(const PropagationScore& score, PropagationFigure figure) {
  return score.figures[figure].sum / score.figures[figure].weight;
}

TEST(Onset, IsTheFirstFrameTwoCentimetresAway) {
  EXPECT_EQ(OnsetFrame(HipFrom(1.0, 17, 60)), 17);
  EXPECT_EQ(OnsetFrame(HipFrom(1.0, -1, 60)), -1);
  std::vector<Vector3<double>> hip(30, Vector3<double>::Zero());
  for (int t = 0; t < 30; ++t) hip[t][2] = 0.01 * t;  // height is no motion
  EXPECT_EQ(OnsetFrame(hip), -1);
  for (int t = 0; t < 30; ++t) hip[t].head<2>() << -0.0031 * t, 0.0031 * t;
  EXPECT_EQ(OnsetFrame(hip), 5);  // 4.56 steps of 4.38 mm
}

TEST(Propagation, MoversAndBystandersByHand) {
  const std::vector<double> x = {0.0, 0.5, 1.0, 1.5, 2.0};
  const PendulumRecording row = Row(x, {5, 20, 30, -1, -1}, 60);
  const PropagationScore score = ScorePropagation(row, Hips(x, {7, 14, -1, 50, -1}, 60));
  EXPECT_EQ(score.figures[kOnsetError].weight, 2.0);
  EXPECT_DOUBLE_EQ(Value(score, kOnsetError), 4.0);
  EXPECT_DOUBLE_EQ(Value(score, kOnsetBias), -2.0);
  EXPECT_DOUBLE_EQ(Value(score, kOnsetErrorReached), 6.0);
  EXPECT_DOUBLE_EQ(Value(score, kMissedMovers), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(Value(score, kFalseMovers), 0.5);
  EXPECT_EQ(score.people[2].onset_measured, 30);
  EXPECT_EQ(score.people[2].onset_predicted, -1);
  const PropagationSummary summary = SummarizePropagation({&score});
  EXPECT_EQ(summary.movers, 3.0);
  EXPECT_EQ(summary.bystanders, 2.0);
  EXPECT_EQ(summary.missed_movers, 1.0);
  EXPECT_EQ(summary.false_movers, 1.0);
}

// No person moves, none is said to: no figure is made up, and nothing divides by zero.
TEST(Propagation, NobodyMoves) {
  const std::vector<double> x = {0.0, 0.5, 1.0};
  const PendulumRecording row = Row(x, {-1, -1, -1}, 60);
  const PropagationScore score = ScorePropagation(row, row.hip);
  const PropagationSummary summary = SummarizePropagation({&score});
  EXPECT_EQ(summary.recordings, 1);
  EXPECT_EQ(summary.bystanders, 3.0);
  for (PropagationFigure figure :
       {kOnsetError, kMissedMovers, kSlownessMeasured, kMomentumMeasured, kContactWork}) {
    EXPECT_FALSE(summary.figures[figure].known()) << kPropagationFigures[figure].key;
  }
  EXPECT_EQ(summary.figures[kFalseMovers].value, 0.0);
  EXPECT_FALSE(Speed(summary.figures[kSlownessMeasured]));
  ScoreSummary scores;
  scores.propagation = summary;
  EXPECT_TRUE(ToJson(scores, false).at("propagation").at("onset_error_frames").is_null());
  EXPECT_TRUE(Contains(PropagationText({{"model", &summary}}), "0 of 3"));
}

TEST(Propagation, SinglePeopleHaveNone) {
  const PendulumRecording alone = Row({0.0}, {5}, 60);
  const PropagationScore score = ScorePropagation(alone, alone.hip);
  EXPECT_TRUE(score.people.empty());
  EXPECT_EQ(SummarizePropagation({&score}).recordings, 0);
}

// A model that misses all but the pushed person has no onset error to be praised for.
TEST(Propagation, OnsetErrorsOfAModelThatMissesMostMoversAreNotShown) {
  PropagationSummary misses;
  misses.recordings = 1;
  misses.movers = 5.0;
  misses.missed_movers = 4.0;
  misses.figures[kOnsetError] = {1.25, 0.0, 1.0};
  misses.figures[kMissedMovers] = {0.835, 0.0, 5.0};
  PropagationSummary finds = misses;
  finds.missed_movers = 2.0;
  const std::string text = PropagationText({{"misses", &misses}, {"finds", &finds}});
  EXPECT_EQ(text.find("1.25"), text.rfind("1.25")) << text;
  EXPECT_TRUE(Contains(text, "0.835"));
  EXPECT_TRUE(Contains(text, "most movers are missed"));
  EXPECT_FALSE(Contains(PropagationText({{"finds", &finds}}), "most movers are missed"));
}

// A wave of 2.5 m/s, people unevenly apart.
TEST(Propagation, SpeedOfAPlantedWave) {
  const std::vector<double> x = {0.0, 0.6, 1.1, 1.9, 2.4};
  std::vector<int> onsets;
  std::vector<double> times;
  for (double s : x) times.push_back(0.1 + s / 2.5);
  EXPECT_NEAR(*Slowness(x, times), 0.4, 1e-12);
  for (double time : times) onsets.push_back(static_cast<int>(std::lround(time / kFrameTime)));
  const PendulumRecording row = Row(x, onsets, 90);
  const PropagationScore score = ScorePropagation(row, StaticBaseline(row));
  const PropagationSummary summary = SummarizePropagation({&score});
  EXPECT_NEAR(Speed(summary.figures[kSlownessMeasured])->value, 2.5, 0.05);  // half a frame
  EXPECT_FALSE(summary.figures[kSlownessPredicted].known());
}

TEST(Propagation, SpeedWhereThereIsNone) {
  EXPECT_FALSE(Slowness({0.0, 1.0}, {0.0, 0.4}));            // two people
  EXPECT_FALSE(Slowness({1.0, 1.0, 1.0}, {0.0, 0.4, 0.5}));  // all at one distance
  const std::vector<double> x = {0.0, 0.5, 1.0};
  const PendulumRecording row = Row(x, {10, 10, 10}, 60);  // all at once
  const PropagationScore score = ScorePropagation(row, row.hip);
  const PropagationSummary summary = SummarizePropagation({&score});
  EXPECT_EQ(summary.figures[kSlownessMeasured].value, 0.0);
  EXPECT_FALSE(Speed(summary.figures[kSlownessMeasured]));
  EXPECT_TRUE(Contains(PropagationText({{"model", &summary}}), "undefined"));
}

TEST(Propagation, DoesNotDependOnTheOrderOfPeople) {
  const std::vector<double> x = {0.0, 0.5, 1.0, 1.7}, shuffled = {1.0, 0.0, 1.7, 0.5};
  const PendulumRecording row = Row(x, {4, 15, 30, -1}, 60);
  PendulumRecording other = Row(shuffled, {30, 4, -1, 15}, 60);
  other.pushed_person = other.scene.pushes[0].person = 1;
  const PropagationScore a = ScorePropagation(row, Hips(x, {5, 19, 28, 50}, 60));
  const PropagationScore b = ScorePropagation(other, Hips(shuffled, {28, 5, 50, 19}, 60));
  for (int i = 0; i < kNumPropagationFigures; ++i) {
    EXPECT_NEAR(a.figures[i].sum, b.figures[i].sum, 1e-9) << i;
    EXPECT_NEAR(a.figures[i].weight, b.figures[i].weight, 1e-9) << i;
  }
  EXPECT_EQ(b.people[0].rank, 2);
}

// Everybody ends at the same speed: as much momentum leaves a person as came.
TEST(Propagation, MomentumPassedOn) {
  const std::vector<double> x = {0.0, 0.5, 1.0};
  const PendulumRecording row = Row(x, {4, 10, 20}, 60);
  const PropagationScore score = ScorePropagation(row, Hips(x, {4, 10, -1}, 60));
  EXPECT_NEAR(Value(score, kMomentumMeasured), 1.0, 1e-9);
  EXPECT_NEAR(Value(score, kMomentumPredicted), 0.5, 1e-9);  // (1 + 0) / (1 + 1)
  EXPECT_NEAR(score.people[0].peak_momentum_measured, 80.0 * 0.03 / kFrameTime, 1e-9);
}

// 1 of 2 and 2 of 2: 3/4 of four people; residuals -1/2 and 1/2.
TEST(Propagation, ErrorsAreClusteredByRecording) {
  PropagationScore a, b, single;
  a.figures[kFalseMovers] = {1.0, 2.0};
  b.figures[kFalseMovers] = {2.0, 2.0};
  const PropagationSummary summary = SummarizePropagation({&a, &b, &single});
  EXPECT_EQ(summary.recordings, 2);
  EXPECT_DOUBLE_EQ(summary.figures[kFalseMovers].value, 0.75);
  EXPECT_DOUBLE_EQ(summary.figures[kFalseMovers].error, std::sqrt(2.0 * 0.5) / 4.0);
}

TEST(Propagation, CrossValidationAveragesOverRepeats) {
  std::vector<PendulumRecording> recordings;
  for (int i = 0; i < 4; ++i) {
    recordings.push_back(Row({0.0, 0.5, 1.0}, {5, 20 + i, -1}, 60));
    recordings.back().id = "row " + std::to_string(i);
  }
  const auto folds = Unwrapped(MakeFolds(recordings, FoldScheme::kStratified, 2, 3, 1));
  const CrossValidation still =
      CrossValidate(recordings, folds, BaselinePredictor(Baselines(0)[0]), 1);
  EXPECT_DOUBLE_EQ(still.summary.propagation.movers, 8.0);  // not times three
  EXPECT_DOUBLE_EQ(still.summary.propagation.missed_movers, 8.0);
  EXPECT_DOUBLE_EQ(still.summary.propagation.bystanders, 4.0);
  EXPECT_FALSE(still.summary.propagation.figures[kOnsetError].known());
  ASSERT_EQ(still.folds.size(), 6u);
  const nlohmann::ordered_json json = ToJson(still);
  EXPECT_EQ(json["propagation"]["missed_movers_share"]["value"], 1.0);
  const std::string text = CrossValidationText({still});
  EXPECT_TRUE(Contains(text, "8 of 8"));
}

TEST(Propagation, EvaluationListsEveryPersonsOnsets) {
  const PendulumRecording row = Row({0.0, 0.5, 1.0}, {5, 20, -1}, 60);
  IdentifiedModel model;
  model.parameters[kKpTheta] = model.parameters[kKpPhi] = 2000.0;
  model.parameters[kTailTime] = 0.2;
  model.options.interaction = {};
  const Evaluation evaluation = Evaluate(model, {row});
  const nlohmann::ordered_json json = ToJson(evaluation);
  ASSERT_EQ(json["recordings"][0]["people"].size(), 3u);
  EXPECT_EQ(json["recordings"][0]["people"][1]["onset_measured_frame"], 20);
  EXPECT_EQ(json["recordings"][0]["people"][1]["onset_predicted_frame"], -1);
  EXPECT_EQ(json["recordings"][0]["people"][2]["onset_measured_frame"], -1);
  EXPECT_TRUE(json["propagation"]["contact_work_J"].is_null());  // no contact, no work
  EXPECT_EQ(json["baselines"]["static"]["propagation"]["missed_movers"], 2.0);
}

TEST(Propagation, RealRecordings) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions load;
  load.setting = "groups";
  const auto loaded = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", load));
  std::vector<PendulumRecording> recordings = AsPendulums(loaded);
  std::vector<RecordingScore> scores;
  for (const PendulumRecording& r : recordings) scores.push_back(ScoreHip(r, r.hip));
  const PropagationSummary summary = Summarize(recordings, scores).propagation;
  EXPECT_EQ(summary.recordings, 49);
  EXPECT_EQ(summary.movers + summary.bystanders, 223.0);
  EXPECT_EQ(summary.bystanders, 25.0);
  EXPECT_EQ(summary.missed_movers + summary.false_movers, 0.0);  // predicted is measured
  EXPECT_EQ(summary.figures[kOnsetError].value, 0.0);
  const auto speed = Speed(summary.figures[kSlownessMeasured]);
  ASSERT_TRUE(speed);
  EXPECT_GT(speed->value, 1.5);
  EXPECT_LT(speed->value, 3.0);
  EXPECT_GT(summary.figures[kMomentumMeasured].value, 0.7);
  EXPECT_LT(summary.figures[kMomentumMeasured].value, 1.1);
}

}  // namespace
}  // namespace pushid
