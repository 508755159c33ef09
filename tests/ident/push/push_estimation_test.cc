// Pushes by inverse dynamics: the exact inverse of a rollout, and finding where a push is.
#include "ident/push/push_estimation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "datasets/inspection/findings.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "models/rollout.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

std::vector<SyntheticRecording> Make(const SyntheticOptions& options) {
  return Unwrapped(MakeSyntheticRecordings(options));
}

PendulumRecording Pendulum(const SyntheticRecording& made) {
  return MakePendulumRecording(made.recording);
}

EstimatedPush Estimated(const PendulumRecording& recording, const PushWindow& window,
                        const PushEstimationOptions& options) {
  return Unwrapped(EstimatePush(recording, window, options));
}

// Rolls the push out from the estimate's own start; expects its motion. Short windows only: nothing
// balances the pendulum while the push is the whole force, so rounding errors grow by e every 0.2
// s.
void ExpectReproduced(const PendulumRecording& recording, const EstimatedPush& estimated) {
  Scene scene = recording.scene;
  scene.people = {recording.scene.people[estimated.push.person]};
  scene.people[0].start = estimated.motion[0];
  scene.pushes = {MakeScenePush(0, 0, estimated.kind, estimated.push.force)};
  ModelOptions model;
  model.push = PushUse::kAsRecorded;
  std::vector<ParameterSet<double>> p(1, PublishedTailParameters());
  p[0][kMu] = p[0][kMuY] = 100.0 * kReferenceMass / scene.people[0].body.mass;
  RolloutPath<double> path;
  const int frames = static_cast<int>(estimated.motion.size());
  ASSERT_TRUE(Rollout(scene, model, p, InitialVelocities(scene), frames, &path).ok);
  for (int t = 0; t < frames; ++t) {
    EXPECT_LT((path.At(t, 0).q - estimated.motion[t].q).norm(), 1e-11) << t;
    EXPECT_LT((path.At(t, 0).qd - estimated.motion[t].qd).norm(), 1e-9) << t;
  }
}

TEST(PushEstimation, GivesBackANetPush) {
  SyntheticOptions options;
  options.model.push = PushUse::kAsRecorded;
  for (const SyntheticRecording& made : Make(options)) {
    const ScenePush& truth = made.scene.pushes[0];
    const EstimatedPush estimated = Estimated(Pendulum(made), {0, truth.EndFrame()}, {});
    EXPECT_EQ(estimated.kind, PushKind::kNet);
    ASSERT_EQ(estimated.push.force.size(), truth.force.size());
    for (size_t i = 0; i < truth.force.size(); ++i) {
      EXPECT_LT((estimated.push.force[i] - truth.force[i]).norm(), 1e-7);
    }
  }
}

TEST(PushEstimation, RolloutReproducesTheMotionExactly) {
  SyntheticOptions options;
  options.joint_noise_m = 0.002;
  options.push_start_frame = 10;
  for (const SyntheticRecording& made : Make(options)) {
    const PendulumRecording recording = Pendulum(made);
    for (int smoothing : {0, 9}) {
      PushEstimationOptions estimation;
      estimation.smoothing_frames = smoothing;
      for (const PushWindow& window : {PushWindow{0, 40}, {10, 25}, {40, 41}}) {
        const EstimatedPush estimated = Estimated(recording, window, estimation);
        EXPECT_EQ(estimated.push.start_frame, window.start);
        EXPECT_EQ(estimated.push.EndFrame(), window.end);
        ExpectReproduced(recording, estimated);
        for (int t = window.start; smoothing == 0 && t <= window.end; ++t) {
          EXPECT_EQ(estimated.motion[t - window.start].q, recording.states[0][t].q);
        }
      }
    }
  }
}

// A window that begins inside a motion.
TEST(PushEstimation, AMovingPersonNeedsNoBlowToMove) {
  SyntheticOptions options;
  options.joint_noise_m = 0.0;
  options.push_start_frame = 10;
  options.strengths = {{"strong", 6.0}};
  for (const SyntheticRecording& made : Make(options)) {
    const PendulumRecording recording = Pendulum(made);
    PushEstimationOptions estimation;
    estimation.smoothing_frames = 9;
    const PushWindow inside{30, 50};
    const EstimatedPush usual = Estimated(recording, inside, estimation);
    EXPECT_FALSE(FirstRowStandsOut(usual.push.force));
    EXPECT_GT(usual.start_speed, 0.1);
    // Before the push people stand still, and are taken to.
    EXPECT_EQ(Estimated(recording, {5, 45}, estimation).start_speed, 0.0);
  }
}

TEST(PushEstimation, SmoothingTakesOutNoiseWithoutShiftingThePush) {
  SyntheticOptions options;
  options.push_start_frame = 15;
  options.push_kind = PushKind::kExternal;
  options.strengths = {{"strong", 6.0}};
  options.joint_noise_m = 0.002;
  options.subjects = 10;
  double plain_error = 0.0, smooth_error = 0.0, centre_shift = 0.0;
  const std::vector<SyntheticRecording> noisy = Make(options);
  options.joint_noise_m = 0.0;
  const std::vector<SyntheticRecording> clean = Make(options);
  for (size_t i = 0; i < noisy.size(); ++i) {
    const PushWindow window{5, 45};
    PushEstimationOptions estimation;
    const EstimatedPush truth = Estimated(Pendulum(clean[i]), window, estimation);
    const EstimatedPush plain = Estimated(Pendulum(noisy[i]), window, estimation);
    estimation.smoothing_frames = 11;
    const EstimatedPush smooth = Estimated(Pendulum(noisy[i]), window, estimation);
    double weight = 0.0, centre = 0.0, smooth_weight = 0.0, smooth_centre = 0.0;
    for (size_t k = 0; k < truth.push.force.size(); ++k) {
      const double fx = truth.push.force[k][0], smooth_fx = smooth.push.force[k][0];
      plain_error += std::pow(plain.push.force[k][0] - fx, 2);
      smooth_error += std::pow(smooth_fx - fx, 2);
      weight += fx, centre += k * fx;
      smooth_weight += smooth_fx, smooth_centre += k * smooth_fx;
    }
    centre_shift += (smooth_centre / smooth_weight - centre / weight) / noisy.size();
  }
  EXPECT_LT(smooth_error, 0.1 * plain_error);
  EXPECT_LT(std::abs(centre_shift), 2.0);  // frames, of a window of 40
}

TEST(PushWindowDetection, FindsPushesThatStartLate) {
  for (double noise : {0.0, 0.001}) {
    for (int start : {8, 30}) {
      SyntheticOptions options;
      options.push_kind = PushKind::kExternal;
      options.push_start_frame = start;
      options.joint_noise_m = noise;
      for (const SyntheticRecording& made : Make(options)) {
        const Result<PushWindow> window = DetectPushWindow(Pendulum(made), {});
        ASSERT_TRUE(window.ok()) << made.recording.id << ": " << window.error().ToString();
        EXPECT_NEAR(window.value().start, start, noise == 0.0 ? 5 : 8) << made.recording.id;
        // The acceleration ends before the push does: friction and balance brake.
        const int end = made.scene.pushes[0].EndFrame();
        EXPECT_GT(window.value().end, start + 4) << made.recording.id;
        EXPECT_LE(window.value().end, end + 5) << made.recording.id;
      }
    }
  }
}

TEST(PushWindowDetection, SomebodyWhoStandsStillHasNone) {
  SyntheticOptions options;
  options.strengths = {{"none", 0.0}};
  options.joint_noise_m = 0.001;
  const PendulumRecording recording = Pendulum(Make(options)[0]);
  EXPECT_TRUE(Contains(ProblemOf(DetectPushWindow(recording, {})), "S01_00_none"));
}

TEST(PushEstimation, UnsoundWindowsAndOptionsAreErrors) {
  const PendulumRecording recording = Pendulum(Make({})[0]);
  for (const PushWindow& window : {PushWindow{-1, 5}, {5, 5}, {80, 90}}) {
    EXPECT_TRUE(Contains(ProblemOf(EstimatePush(recording, window, {})),
                         "is not within its frames 0 to 89"));
  }
  PushEstimationOptions options;
  options.person = 1;
  EXPECT_FALSE(EstimatePush(recording, {0, 5}, options).ok());
  EXPECT_FALSE(DetectPushWindow(recording, options).ok());
  options.person = 0;
  for (int smoothing : {-5, 3, 6}) {
    options.smoothing_frames = smoothing;
    EXPECT_FALSE(EstimatePush(recording, {0, 5}, options).ok()) << smoothing;
  }
}

// The published pushes of single people are inverse dynamics of these recordings.
TEST(PushEstimation, AgreesWithThePublishedPushes) {
  if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
  LoadOptions load;
  load.setting = "single";
  const auto recordings =
      Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", load, nullptr));
  double difference = 0.0, size = 0.0;
  for (const Recording& recording : recordings) {
    const Push& published = recording.pushes[0];
    const EstimatedPush estimated =
        Estimated(MakePendulumRecording(recording), {0, published.EndFrame()}, {});
    for (size_t i = 0; i < published.force.size(); ++i) {
      difference += (estimated.push.force[i] - published.force[i]).squaredNorm();
      size += published.force[i].squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(difference / size), 0.02);
}

}  // namespace
}  // namespace pushid
