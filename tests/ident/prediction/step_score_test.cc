// Brier score, AUC and calibration against values worked out by hand.
#include <gtest/gtest.h>

#include "ident/prediction/predicted_steps.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

StepPrediction Track(double p, bool stepped, const std::string& person = "A") {
  StepPrediction prediction;
  prediction.probability = p;
  prediction.stepped = stepped;
  prediction.person = person;
  return prediction;
}

TEST(StepScore, BrierAndAucByHand) {
  const StepScore score =
      ScoreSteps({Track(0.9, true), Track(0.4, true, "B"), Track(0.4, false), Track(0.1, false)});
  EXPECT_EQ(score.tracks, 4);
  EXPECT_EQ(score.stepped, 2);
  EXPECT_EQ(score.people, 2);
  EXPECT_NEAR(score.brier, (0.01 + 0.36 + 0.16 + 0.01) / 4, 1e-12);
  // Three of four pairs are won and one is a tie.
  EXPECT_NEAR(score.auc, 3.5 / 4, 1e-12);
}

TEST(StepScore, NobodyToTellApartIsHalf) {
  EXPECT_EQ(ScoreSteps({Track(0.9, true), Track(0.8, true)}).auc, 0.5);
  EXPECT_FALSE(ScoreSteps({}).known());
}

TEST(StepScore, FifthsAreByProbabilityAndOfOneSize) {
  std::vector<StepPrediction> predictions;
  for (int i = 0; i < 50; ++i) predictions.push_back(Track(i / 50.0, i >= 25));
  const StepScore score = ScoreSteps(predictions);
  ASSERT_EQ(score.fifths.size(), 5u);
  for (const StepFifth& fifth : score.fifths) EXPECT_EQ(fifth.tracks, 10);
  EXPECT_NEAR(score.fifths[0].predicted, 0.09, 1e-12);
  EXPECT_EQ(score.fifths[0].observed, 0.0);
  EXPECT_EQ(score.fifths[2].observed, 0.5);
}

// Recordings have groups too: those by P(step) are called something else.
TEST(StepScore, FifthsAreNotCalledGroups) {
  std::vector<StepPrediction> predictions;
  for (int i = 0; i < 50; ++i) predictions.push_back(Track(i / 50.0, i >= 25));
  const StepScore score = ScoreSteps(predictions);
  const std::string text = StepScoresText({{"model", &score}});
  EXPECT_TRUE(Contains(text, "fifth 1 of P(step)"));
  EXPECT_FALSE(Contains(text, "group"));
}

// The jackknife by person: a person more with the same tracks changes nothing but the count.
TEST(StepScore, ErrorsAreByPerson) {
  std::vector<StepPrediction> same, differ;
  for (const char* person : {"A", "B", "C"}) {
    same.push_back(Track(0.8, true, person));
    same.push_back(Track(0.3, false, person));
    const bool odd = person[0] == 'C';
    differ.push_back(Track(odd ? 0.2 : 0.8, true, person));
    differ.push_back(Track(0.3, false, person));
  }
  EXPECT_NEAR(ScoreSteps(same).brier_error, 0.0, 1e-12);
  EXPECT_GT(ScoreSteps(differ).brier_error, 0.05);
  EXPECT_GT(ScoreSteps(differ).auc_error, 0.05);
}

}  // namespace
}  // namespace pushid
