// Predictions that learn from the frames they are shown.
#include "ident/prediction/online_predictor.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <cmath>

#include "ident/observed/first_frames.h"
#include "ident/prediction/evaluation.h"
#include "tests/ident/effect_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

class OnlinePredictorTest : public ::testing::Test {
 protected:
  OnlinePredictorTest() : study_(SmallStudy()), model_(TrueModel(study_)) {
    recordings_ = PlantEffects(model_, MakePendulums(study_), {0.4, 0.1, 11});
    model_.forecasts = ForecastRule{};
  }
  OnlinePredictor After(size_t i, int observed, ForecastUse use = ForecastUse::kBoth) const {
    auto made = OnlinePredictor::Make(model_, recordings_[i], recordings_[i].num_frames(), use);
    EXPECT_TRUE(made.ok());
    for (int t = 1; t < observed; ++t) made.value().Observe(FrameAt(recordings_[i], t));
    return std::move(made).value();
  }

  SyntheticOptions study_;
  IdentifiedModel model_;
  std::vector<PendulumRecording> recordings_;
};

TEST_F(OnlinePredictorTest, WithoutFramesIsThePredictionToTheBit) {
  for (const PendulumRecording& recording : recordings_) {
    const Prediction plain = Predict(model_, recording);
    const Prediction first = PredictFrom(model_, recording, 1).value();
    EXPECT_EQ(first.hip, plain.hip);
    for (int t = 0; t < recording.num_frames(); ++t) {
      EXPECT_EQ(first.path.At(t, 0).q, plain.path.At(t, 0).q);
      EXPECT_EQ(first.path.At(t, 0).qd, plain.path.At(t, 0).qd);
    }
    const RecordingScore a = ScoreModel(model_, recording), b = ScoreModel(model_, recording, 1);
    EXPECT_EQ(a.value[kHipAde], b.value[kHipAde]);
    EXPECT_EQ(a.value[kHipFde], b.value[kHipFde]);
    EXPECT_EQ(b.value[kAfterHipAde], b.value[kHipAde]);
  }
}

// By hand: on from where the hip was seen last, with what is left of an error of velocity.
TEST_F(OnlinePredictorTest, PhysicsIsTheRolloutMovedOn) {
  constexpr int kObserved = 20;
  const PendulumRecording& r = recordings_[2];
  const Prediction rollout = Predict(model_, r);
  const auto error = [&](int t) -> Vector3<double> { return r.hip[0][t] - rollout.hip[0][t]; };
  const Vector3<double> velocity = (error(19) - error(16)) / 0.05;
  const Prediction prediction = After(2, kObserved, ForecastUse::kPhysics).Predict();
  for (int t = kObserved; t < r.num_frames(); ++t) {
    const double reach = 0.3 * (1.0 - std::exp(-(t - 19) / 60.0 / 0.3));
    const Vector3<double> expected = rollout.hip[0][t] + error(19) + reach * velocity;
    EXPECT_LT((prediction.hip[0][t] - expected).norm(), 1e-9) << t;
  }
}

// A gap longer than the window over which errors of velocity are taken: the last frame before it.
TEST_F(OnlinePredictorTest, ErrorsOfVelocityReachOverAGap) {
  PendulumRecording r = recordings_[2];
  r.weight = {std::vector<double>(r.num_frames(), 1.0)};
  for (int t = 9; t < 18; ++t) r.weight[0][t] = 0.0;  // and 20, the last
  r.weight[0][20] = 0.0;
  const Prediction rollout = Predict(model_, r);
  const auto error = [&](int t) -> Vector3<double> { return r.hip[0][t] - rollout.hip[0][t]; };
  const Vector3<double> velocity = (error(19) - error(8)) / (11.0 / 60.0);
  const Prediction prediction = PredictFrom(model_, r, 21, 0, ForecastUse::kPhysics).value();
  for (int t = 21; t < r.num_frames(); ++t) {
    const double reach = 0.3 * (1.0 - std::exp(-(t - 19) / 60.0 / 0.3));
    const Vector3<double> expected = rollout.hip[0][t] + error(19) + reach * velocity;
    EXPECT_LT((prediction.hip[0][t] - expected).norm(), 1e-9) << t;
  }
}

// A controller runs for days.
TEST_F(OnlinePredictorTest, MemoryDoesNotGrowWithTheFramesSeen) {
  const PendulumRecording& r = recordings_[0];
  auto endless = OnlinePredictor::Make(model_, r, OnlinePredictor::kEndless);
  const SeenFrame last = FrameAt(r, r.num_frames() - 1);
  const auto after = [&](int frames) {
    for (int t = 0; t < frames; ++t) endless.value().Observe(last);
    EXPECT_FALSE(endless.value().Next(1).empty());
    return mallinfo2().uordblks;  // bytes
  };
  const size_t before = after(1000);
  EXPECT_LT(after(10000), before + 10000);
}

// Window after window without an end: each prediction is that of Predict.
TEST_F(OnlinePredictorTest, NextIsThePredictionAsFarAsItGoes) {
  SyntheticOptions study = study_;
  study.frames = 260;
  const auto recordings = PlantEffects(model_, MakePendulums(study), {0.4, 0.1, 11});
  const PendulumRecording& r = recordings[0];
  auto whole = OnlinePredictor::Make(model_, r, r.num_frames());
  auto endless = OnlinePredictor::Make(model_, r, OnlinePredictor::kEndless);
  for (int t = 1; t + 1 < r.num_frames(); ++t) {
    whole.value().Observe(FrameAt(r, t));
    endless.value().Observe(FrameAt(r, t));
    if (t % 20 != 1) continue;
    const Prediction prediction = whole.value().Predict();
    const int rest = r.num_frames() - t - 1;
    for (int ahead : {1, rest}) {
      const HipPaths hips = endless.value().Next(ahead);
      ASSERT_EQ(static_cast<int>(hips[0].size()), ahead);
      EXPECT_LT((hips[0].back() - prediction.hip[0][t + ahead]).norm(), 1e-9) << t;
    }
  }
}

// What is measured of a push as it comes is what the recording would have said.
TEST_F(OnlinePredictorTest, PushesAreToldAsTheyCome) {
  const PendulumRecording& r = recordings_[0];
  PendulumRecording unpushed = r;
  unpushed.scene.pushes.clear();
  model_.options.push_tail = PushTail::kNone;  // which pushes as they come have none of
  OnlinePredictor told = OnlinePredictor::Make(model_, unpushed, OnlinePredictor::kEndless).value();
  const ScenePush& push = r.scene.pushes[0];
  for (int t = 1; t < 30; ++t) {
    if (push.Active(t - 1)) told.Push(0, push.force[t - 1 - push.start_frame]);
    told.Observe(FrameAt(r, t));
  }
  const HipPaths a = told.Next(30), b = After(0, 30).Next(30);
  EXPECT_LT((a[0].back() - b[0].back()).norm(), 1e-9);
}

TEST_F(OnlinePredictorTest, FramesTell) {
  double without = 0.0, with = 0.0;
  for (size_t i = 0; i < recordings_.size(); ++i) {
    const PendulumRecording& r = recordings_[i];
    without += ScoreHip(r, Predict(model_, r).hip, 40).value[kAfterHipAde];
    with += ScoreHip(r, After(i, 40, ForecastUse::kPhysics).Predict().hip, 40).value[kAfterHipAde];
  }
  EXPECT_LT(with, 0.6 * without);
}

TEST_F(OnlinePredictorTest, FramesThatWereSeenAreAsTheyWere) {
  const PendulumRecording& r = recordings_[0];
  const Prediction p = After(0, 15).Predict();
  for (int t = 1; t < 15; ++t) {
    EXPECT_EQ(p.hip[0][t], r.hip[0][t]);
    EXPECT_EQ(p.path.At(t, 0).q, r.states[0][t].q);
  }
  // The pendulum's tip stands over the hip, its velocity is what moves it there.
  for (int t = 15; t < r.num_frames(); ++t) {
    const PendulumState<double>& state = p.path.At(t, 0);
    const Vector3<double> tip = HipPosition(r.scene.people[0].body, state.q);
    EXPECT_LT((tip - p.hip[0][t]).head<2>().norm(), 1e-12) << t;
    const Vector4<double> step = r.scene.dt * state.qd;
    EXPECT_LT((p.path.At(t - 1, 0).q + step - state.q).norm(), 1e-12) << t;
  }
}

// Nothing behind the frames seen is looked at.
TEST_F(OnlinePredictorTest, KnowsNothingOfTheFuture) {
  PendulumRecording cut = recordings_[1];
  for (auto& hip : cut.hip) std::fill(hip.begin() + 12, hip.end(), Vector3<double>(9, 9, 9));
  const Prediction a = PredictFrom(model_, recordings_[1], 12).value();
  const Prediction b = PredictFrom(model_, cut, 12).value();
  EXPECT_EQ(a.hip, b.hip);
}

TEST_F(OnlinePredictorTest, AFrameThatWasNotSeenDoesNotCount) {
  PendulumRecording gap = recordings_[1];
  gap.weight = {std::vector<double>(gap.num_frames(), 1.0)};
  gap.weight[0][5] = 0.0;
  PendulumRecording wild = gap;
  wild.hip[0][5] += Vector3<double>(1.0, 1.0, 0.0);
  const Prediction a = PredictFrom(model_, gap, 12).value();
  const Prediction b = PredictFrom(model_, wild, 12).value();
  EXPECT_EQ(a.hip[0].back(), b.hip[0].back());
}

// Drawn from the model, 90 % bands hold 90 %: of 100 recordings with a standard error of 2 %.
TEST_F(OnlinePredictorTest, BandsHoldWhatTheModelDraws) {
  SyntheticOptions study = study_;
  study.subjects = study.recordings_per_subject = 10;
  const auto recordings = PlantEffects(model_, MakePendulums(study), {0.4, 0.1, 12});
  const auto others = PlantEffects(model_, MakePendulums(study), {0.4, 0.1, 13});
  model_.forecasts = LearnForecasts(model_, others, {}, 2);
  for (int observed : {1, 15, 30}) {
    double inside = 0.0;
    for (const PendulumRecording& r : recordings) {
      const RecordingScore score = ScoreModel(model_, r, observed);
      inside += 0.5 * (score.value[kInside90] + score.value[kInside90 + 1]) / 100.0;
    }
    // Errors have one shape at all times: late, when it is a narrower one, bands are too wide.
    EXPECT_NEAR(inside, 0.9, 0.06) << observed;
  }
}

TEST_F(OnlinePredictorTest, QuantilesInvertTheDistribution) {
  const OnlinePredictor predictor = After(3, 10);
  const HipDistribution hips = predictor.Distribution(predictor.Predict());
  ASSERT_EQ(hips.num_frames(), recordings_[3].num_frames() - 10);
  for (double share : {0.05, 0.3, 0.95}) {
    for (int t : {0, 20}) {
      for (int axis : {0, 1, 2}) {
        EXPECT_NEAR(hips.Cdf(0, t, axis, hips.Quantile(0, t, axis, share)), share, 1e-9);
      }
    }
  }
  for (ErrorScale& scale : model_.forecasts->errors) scale.coefficients[0] += std::log(2.0);
  const HipDistribution wide = predictor.Distribution(predictor.Predict());
  const auto width = [](const HipDistribution& of) {
    return of.Quantile(0, 9, 0, 0.95) - of.Quantile(0, 9, 0, 0.05);
  };
  EXPECT_NEAR(width(wide), 2.0 * width(hips), 1e-9);
}

TEST_F(OnlinePredictorTest, ModelsThatCannotLearnAreRefused) {
  model_.source = "old.json";
  model_.forecasts.reset();
  const MaybeError error = CheckLearnsFromFrames(model_);
  ASSERT_TRUE(error);
  EXPECT_TRUE(Contains(error->ToString(), "old.json: the model has learned no forecasts"));
  EXPECT_FALSE(PredictFrom(model_, recordings_[0], 5).ok());
}

struct Camera {
  const PendulumRecording& recording;
  int frame = 0;
  bool Next() { return ++frame < 30; }
  SeenFrame People() const { return FrameAt(recording, frame); }
};

// The loop of ident/prediction/README.md, line by line.
TEST_F(OnlinePredictorTest, LoopOfTheReadme) {
  const IdentifiedModel& model = model_;
  const PendulumRecording& start = recordings_[0];
  Camera camera{start};
  std::vector<Vector3<double>> targets;
  // README: begins
  OnlinePredictor predictor = OnlinePredictor::Make(model, start, 60).value();  // or its error()
  while (camera.Next()) {
    predictor.Observe(camera.People());
    const Prediction prediction = predictor.Predict();
    targets.push_back(prediction.hip[0].back());  // where the hip will be after a second
  }
  // README: ends
  EXPECT_EQ(targets.size(), 29u);
  const std::string source =
      ReadText(PUSHID_SOURCE_DIR "/tests/ident/prediction/online_predictor_test.cc");
  const std::string readme = ReadText(PUSHID_SOURCE_DIR "/ident/prediction/README.md");
  const size_t from = source.find("// README: begins\n") + 18;
  std::istringstream lines(source.substr(from, source.find("  // README: ends") - from));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(Contains(readme, line.substr(2) + "\n")) << line;
  }
}

}  // namespace
}  // namespace pushid
