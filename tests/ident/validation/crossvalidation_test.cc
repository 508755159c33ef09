// Folds, held-out scores, paired differences.
#include "ident/validation/crossvalidation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "ident/validation/scores_report.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// 32 recordings like the published ones: three subjects, three strengths, unevenly.
std::vector<PendulumRecording> Labels() {
  std::vector<PendulumRecording> recordings;
  const char* const strengths[] = {"weak", "medium", "strong"};
  const int counts[3][3] = {{5, 4, 3}, {3, 4, 2}, {6, 3, 2}};
  for (int subject = 0; subject < 3; ++subject) {
    for (int strength = 0; strength < 3; ++strength) {
      for (int i = 0; i < counts[subject][strength]; ++i) {
        PendulumRecording r;
        r.id = std::to_string(recordings.size());
        r.labels.Set(kMagnitudeLabel, strengths[strength]);
        r.subject_ids = {"S" + std::to_string(subject)};
        r.scene.people.resize(1);
        recordings.push_back(r);
      }
    }
  }
  return recordings;
}

TEST(Folds, StratifiedHoldOutEachOncePerRepeat) {
  const std::vector<PendulumRecording> recordings = Labels();
  const int total = static_cast<int>(recordings.size());
  constexpr int kFolds = 4, kRepeats = 5;
  const auto folds = Unwrapped(MakeFolds(recordings, FoldScheme::kStratified, kFolds, kRepeats, 3));
  ASSERT_EQ(folds.size(), static_cast<size_t>(kFolds * kRepeats));
  std::map<std::pair<std::string, std::string>, int> strata;
  for (const PendulumRecording& r : recordings) ++strata[{r.subject_ids[0], r.labels.magnitude()}];
  std::set<std::vector<int>> distinct;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::vector<int> held(total, 0);
    for (int f = 0; f < kFolds; ++f) {
      const Fold& fold = folds[repeat * kFolds + f];
      distinct.insert(fold.held_out);
      EXPECT_EQ(fold.name,
                "repeat " + std::to_string(repeat + 1) + " fold " + std::to_string(f + 1));
      const int size = static_cast<int>(fold.held_out.size());
      EXPECT_GE(size, total / kFolds);
      EXPECT_LE(size, (total + kFolds - 1) / kFolds);
      std::map<std::pair<std::string, std::string>, int> own;
      for (int i : fold.held_out) {
        ++held[i];
        ++own[{recordings[i].subject_ids[0], recordings[i].labels.magnitude()}];
      }
      for (const auto& [stratum, count] : strata) {
        EXPECT_GE(own[stratum], count / kFolds);
        EXPECT_LE(own[stratum], (count + kFolds - 1) / kFolds);
      }
    }
    EXPECT_EQ(held, std::vector<int>(total, 1));
  }
  EXPECT_GT(distinct.size(), static_cast<size_t>(kFolds));  // repeats shuffle anew
}

TEST(Folds, SeedDecides) {
  const auto held = [](uint64_t seed) {
    std::vector<std::vector<int>> all;
    const auto folds = MakeFolds(Labels(), FoldScheme::kStratified, 4, 2, seed);
    for (const Fold& fold : folds.value()) {
      all.push_back(fold.held_out);
    }
    return all;
  };
  EXPECT_EQ(held(1), held(1));
  EXPECT_NE(held(1), held(2));
}

// A copy of what is held out is not fitted.
TEST(Folds, CopiesAreHeldOutTogether) {
  std::vector<PendulumRecording> recordings = Labels();
  recordings[3].content_hash = recordings[8].content_hash = "same";
  const auto folds = Unwrapped(MakeFolds(recordings, FoldScheme::kStratified, 4, 2, 1));
  for (const Fold& fold : folds) {
    const auto holds = [&fold](int i) {
      return std::binary_search(fold.held_out.begin(), fold.held_out.end(), i);
    };
    EXPECT_EQ(holds(3), holds(8)) << fold.name;
  }
}

// Two settings whose recordings take turns: the position counts within the setting.
TEST(Folds, InterleavedCountWithinTheSetting) {
  std::vector<PendulumRecording> recordings = Labels();
  recordings.resize(9);
  for (size_t i = 0; i < recordings.size(); ++i) {
    recordings[i].labels.Set(kSettingLabel, i % 2 == 0 ? "row" : "group");
  }
  const auto folds = Unwrapped(MakeFolds(recordings, FoldScheme::kInterleaved, 3, 1, 1));
  ASSERT_EQ(folds.size(), 3u);
  EXPECT_EQ(folds[0].held_out, (std::vector<int>{0, 1, 6, 7}));
  EXPECT_EQ(folds[1].held_out, (std::vector<int>{2, 3, 8}));
  EXPECT_EQ(folds[2].held_out, (std::vector<int>{4, 5}));
  recordings.resize(2);
  EXPECT_TRUE(Contains(ProblemOf(MakeFolds(recordings, FoldScheme::kInterleaved, 2, 1, 1)),
                       "no setting has two"));
}

TEST(Folds, SubjectsAndStrongPushes) {
  const std::vector<PendulumRecording> recordings = Labels();
  const auto subjects = Unwrapped(MakeFolds(recordings, FoldScheme::kSubject, 0, 0, 0));
  ASSERT_EQ(subjects.size(), 3u);
  EXPECT_EQ(subjects[0].name, "without S0");
  EXPECT_EQ(subjects[0].held_out.size(), 12u);
  const auto strong = Unwrapped(MakeFolds(recordings, FoldScheme::kStrong, 0, 0, 0));
  ASSERT_EQ(strong.size(), 1u);
  EXPECT_EQ(strong[0].held_out.size(), 7u);
  for (int i : strong[0].held_out) EXPECT_EQ(recordings[i].labels.magnitude(), "strong");
}

TEST(Folds, ErrorsSayWhatIsMissing) {
  std::vector<PendulumRecording> recordings = Labels();
  const auto message = [&recordings](FoldScheme scheme, int folds, int repeats) {
    const auto made = MakeFolds(recordings, scheme, folds, repeats, 1);
    EXPECT_FALSE(made.ok());
    return made.ok() ? std::string() : made.error().ToString();
  };
  EXPECT_TRUE(Contains(message(FoldScheme::kStratified, 1, 1), "--folds is 1"));
  EXPECT_TRUE(Contains(message(FoldScheme::kStratified, 33, 1), "the 32 recordings"));
  EXPECT_TRUE(Contains(message(FoldScheme::kStratified, 4, 0), "--repeats"));
  for (PendulumRecording& r : recordings) {
    r.subject_ids = {"only"};
    r.labels.Set(kMagnitudeLabel, "weak");
  }
  EXPECT_TRUE(Contains(message(FoldScheme::kSubject, 0, 0), "at least two pushed subjects"));
  EXPECT_TRUE(Contains(message(FoldScheme::kStrong, 0, 0), "'strong'"));
  for (PendulumRecording& r : recordings) r.labels.Set(kMagnitudeLabel, "strong");
  EXPECT_FALSE(MakeFolds(recordings, FoldScheme::kStrong, 0, 0, 0).ok());
}

std::vector<Fold> SomeFolds(const std::vector<PendulumRecording>& recordings) {
  return MakeFolds(recordings, FoldScheme::kStratified, 3, 2, 1).value();
}

TEST(CrossValidation, HeldOutPredictionsOfTheRightModelAreGood) {
  const SyntheticOptions study = SmallStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const auto folds = SomeFolds(recordings);
  const CrossValidation model =
      CrossValidate(recordings, folds, ModelPredictor("tail", ExactFit(study)), 1);
  EXPECT_EQ(model.predictor, "tail");
  EXPECT_EQ(model.folds.size(), 6u);
  EXPECT_EQ(model.summary.mean.recordings, 24);
  EXPECT_LT(model.summary.mean.value[kHipAde], 1e-7);
  EXPECT_EQ(model.failures, 0);
  EXPECT_EQ(model.falls, 0);
  const CrossValidation still =
      CrossValidate(recordings, folds, BaselinePredictor(Baselines(0)[0]), 1);
  EXPECT_GT(still.summary.mean.value[kHipAde], 0.05);
  const CrossValidation ridge = CrossValidate(recordings, folds, RidgePredictor(), 1);
  EXPECT_LT(ridge.summary.mean.value[kHipAde], still.summary.mean.value[kHipAde]);
  EXPECT_GT(ridge.summary.mean.value[kHipAde], model.summary.mean.value[kHipAde]);
}

TEST(CrossValidation, ThreadsDoNotMatter) {
  const SyntheticOptions study = TinyStudy();
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  const auto folds = SomeFolds(recordings);
  const Predictor predictor = ModelPredictor("tail", DefaultFit(study));
  int reported = 0;
  const CrossValidation one = CrossValidate(recordings, folds, predictor, 1);
  const CrossValidation two =
      CrossValidate(recordings, folds, predictor, 2, [&reported](int, int total) {
        ++reported;
        EXPECT_EQ(total, 6);
      });
  EXPECT_EQ(reported, 6);
  ASSERT_EQ(one.summary.recordings.size(), two.summary.recordings.size());
  for (size_t i = 0; i < one.summary.recordings.size(); ++i) {
    EXPECT_EQ(one.summary.recordings[i].value[kHipAde], two.summary.recordings[i].value[kHipAde]);
  }
  EXPECT_EQ(one.summary.mean.error[kHipFde], two.summary.mean.error[kHipFde]);
}

// Scores 1, 2, 3, ... by recording; 10 more when it is asked the second time. Fails on one.
Predictor Scripted(int fails = -1) {
  const auto asked = std::make_shared<std::map<int, int>>();
  const auto score_all = [=](const std::vector<PendulumRecording>& recordings,
                             const std::vector<int>& train, const std::vector<int>& test) {
    EXPECT_EQ(train.size() + test.size(), recordings.size());
    FoldPrediction prediction;
    for (int i : test) {
      for (int t : train) EXPECT_NE(i, t);
      RecordingScore score;
      score.id = recordings[i].id;
      score.frames = 5;
      score.value[kHipAde] = i + 1.0 + 10.0 * (*asked)[i]++;
      score.value[kHipFde] = 2.0 * score.value[kHipAde];
      if (i == fails) score.failure = "fell over";
      prediction.scores.push_back(score);
    }
    return prediction;
  };
  return {"scripted", score_all};
}

TEST(CrossValidation, RepeatsAreAveragedBeforeTheMean) {
  std::vector<PendulumRecording> recordings = Labels();
  recordings.resize(4);
  const std::vector<Fold> folds = {{"a", {0, 1}}, {"b", {2}}, {"c", {0, 2}}};
  const CrossValidation result = CrossValidate(recordings, folds, Scripted(), 1);
  ASSERT_EQ(result.summary.recordings.size(), 3u);  // recording 3 was never held out
  EXPECT_EQ(result.summary.recordings[0].value[kHipAde], (1.0 + 11.0) / 2.0);
  EXPECT_EQ(result.summary.recordings[1].value[kHipAde], 2.0);
  EXPECT_EQ(result.summary.recordings[2].value[kHipAde], (3.0 + 13.0) / 2.0);
  EXPECT_NEAR(result.summary.mean.value[kHipAde], (6.0 + 2.0 + 8.0) / 3.0, 1e-12);
  EXPECT_EQ(result.folds[2].value[kHipAde], (11.0 + 13.0) / 2.0);
  EXPECT_EQ(result.folds[2].value[kHipFde], 11.0 + 13.0);
}

// In the second mean a failure counts as standing still does, 0.4 m: (1 + 0.4 + 3) m / 3.
TEST(CrossValidation, FailuresAreSaidFirstAndInNoMeanButTheSecond) {
  std::vector<PendulumRecording> recordings = Labels();
  recordings.resize(3);
  for (PendulumRecording& recording : recordings) {
    recording.hip = {std::vector<Vector3<double>>(5, Vector3<double>(0.4, 0.0, 0.0))};
    recording.hip[0][0].setZero();
    recording.states.assign(1, std::vector<PendulumState<double>>(5));
  }
  const CrossValidation result =
      CrossValidate(recordings, {{"a", {0, 1}}, {"b", {2}}}, Scripted(1), 1);
  EXPECT_EQ(result.failures, 1);
  EXPECT_EQ(result.folds[0].failures, 1);
  EXPECT_EQ(result.folds[0].value[kHipAde], 1.0);
  EXPECT_EQ(result.summary.mean.recordings, 2);
  EXPECT_EQ(result.summary.recordings[1].failure, "fell over");
  const std::string text = CrossValidationText({result});
  EXPECT_EQ(text.find("scripted fails in 1 of 3 recordings, which are in no mean: 1 (fell over)"),
            0u)
      << text;
  EXPECT_NEAR(ToJson(result)["mean_with_failures_as_static"]["hipADE_m"].get<double>(), 4.4 / 3.0,
              1e-12);
}

TEST(CrossValidation, PairedDifferenceByHand) {
  const auto validation = [](const char* name, std::vector<double> scores) {
    CrossValidation v;
    v.predictor = name;
    for (size_t i = 0; i < scores.size(); ++i) {
      RecordingScore& score = v.summary.recordings.emplace_back();
      score.id = std::to_string(i);
      score.value[kHipAde] = scores[i];
      score.value[kHipFde] = 2.0 * scores[i];
    }
    return v;
  };
  CrossValidation a = validation("a", {0.10, 0.20, 0.30, 5.0});
  const CrossValidation b = validation("b", {0.11, 0.24, 0.31, 0.1});
  a.summary.recordings[3].failure = "fell";
  const PairedDifference d = Compare(a, b);
  EXPECT_EQ(d.recordings, 3);
  EXPECT_NEAR(d.value[kHipAde], 0.02, 1e-15);
  // Deviations -0.01, 0.02, -0.01: variance 3e-4, over 3.
  EXPECT_NEAR(d.error[kHipAde], std::sqrt(3e-4 / 3.0), 1e-15);
  EXPECT_NEAR(d.value[kHipFde], 0.04, 1e-15);
  EXPECT_NEAR(d.error[kHipFde], 2.0 * std::sqrt(3e-4 / 3.0), 1e-15);
  EXPECT_EQ(d.a, "a");
  EXPECT_EQ(d.b, "b");
  EXPECT_EQ(d.clustered_by, ClusterBy::kRecording);
  EXPECT_EQ(d.clusters, 3);
}

// Two people, of whom the second was pushed three times. By hand: scores 1 | 2 3 6, mean 3;
// deviations over 4: -0.5 | -0.25 0 0.75, so that the clusters' sums are -0.5 and 0.5, and the
// error is sqrt(2 / 1 * (0.25 + 0.25)) = 1. By recording it would be sqrt(4 / 3 * 0.875) = 1.08.
TEST(CrossValidation, ErrorsAreClusteredByPushedPerson) {
  std::vector<PendulumRecording> recordings(4);
  std::vector<RecordingScore> scores(4), none(4);
  const double values[] = {1.0, 2.0, 3.0, 6.0};
  for (int i = 0; i < 4; ++i) {
    recordings[i].id = scores[i].id = none[i].id = std::to_string(i);
    recordings[i].subject_ids = {i == 0 ? "S0" : "S1"};
    recordings[i].scene.people.resize(1);
    scores[i].value[kHipAde] = values[i];
    scores[i].frames = none[i].frames = 5;
  }
  CrossValidation model, zero;
  model.predictor = "model";
  zero.predictor = "zero";
  model.summary = Summarize(recordings, scores);
  zero.summary = Summarize(recordings, none);
  const MeanScore& mean = model.summary.mean;
  EXPECT_EQ(mean.clustered_by, ClusterBy::kSubject);
  EXPECT_EQ(mean.clusters, 2);
  EXPECT_NEAR(mean.error[kHipAde], 1.0, 1e-14);
  const PairedDifference d = Compare(zero, model);
  EXPECT_EQ(d.clustered_by, ClusterBy::kSubject);
  EXPECT_EQ(d.clusters, 2);
  EXPECT_NEAR(d.value[kHipAde], 3.0, 1e-14);
  EXPECT_NEAR(d.error[kHipAde], 1.0, 1e-14);
  // Three standard errors, and yet nothing: Student's t of one degree of freedom is 12.7.
  const std::string text = CrossValidationText({zero, model});
  EXPECT_TRUE(Contains(text, "model is not distinguishable from zero"));
  EXPECT_TRUE(Contains(text, "95 % interval +- 13 m: 2 people,"));
  EXPECT_TRUE(Contains(text, "+-: standard errors over 2 people"));
  // A single person's errors are clustered by recording: 2 3 6 by hand.
  const MeanScore& one = model.summary.by.at("subject").at("S1");
  EXPECT_EQ(one.clustered_by, ClusterBy::kRecording);
  EXPECT_NEAR(one.error[kHipAde], std::sqrt(13.0 / 9.0), 1e-14);
  // A person who was weighed anew is the same person.
  recordings[3].scene.people[0].body.mass += 10.0;
  EXPECT_EQ(Summarize(recordings, scores).mean.clusters, 2);
}

}  // namespace
}  // namespace pushid
