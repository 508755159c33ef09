// What pushes might as well have been: windows, smoothing, noise and clocks; and what that adds to
// the errors of a fit.
#include <gtest/gtest.h>

#include <cmath>

#include "ident/fit/fit.h"
#include "ident/push/push_check.h"
#include "ident/push/push_estimation.h"
#include "models/stance.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

const PushVariant& Named(const std::vector<PushVariant>& variants, const std::string& name) {
  for (const PushVariant& variant : variants) {
    if (variant.name == name) return variant;
  }
  ADD_FAILURE() << "there is no " << name;
  return variants.front();
}

// By hand: one source moves 3 and -4, the other 6; a failed refit counts nowhere.
TEST(PushErrors, AddUpOverSourcesAndAverageWithin) {
  RefitTable check;
  check.parameters = {"mu"};
  check.value = {10.0};
  check.standard_error = {5.0};
  check.rows = {{"window", "a", {13.0}, {}, "", 0},
                {"window", "b", {6.0}, {}, "", 0},
                {"window", "c", {}, {}, "failed", 0},
                {"clock", "d", {16.0}, {}, "", 0}};
  const PushError error = PushErrors(check)[0];
  EXPECT_DOUBLE_EQ(error.push, std::sqrt((9.0 + 16.0) / 2.0 + 36.0));
  EXPECT_DOUBLE_EQ(error.total, std::hypot(5.0, error.push));
}

// Pushes made by inverse dynamics without smoothing come back over their own window; start, kind
// and friction that is taken out stay.
TEST(PushVariants, TheRecordedWindowGivesTheRecordedPush) {
  for (const PushKind kind : {PushKind::kNet, PushKind::kNetWithoutFriction}) {
    SyntheticOptions study = TinyStudy();
    study.model.push = PushUse::kAsRecorded;
    study.model.push_tail = PushTail::kNone;
    study.push_kind = kind;
    study.joint_noise_m = 0.0;
    study.parameters[kMu] = study.parameters[kMuY] = kPublishedFriction;
    study.model.gain_scaling = GainScaling::kNone;
    const std::vector<PendulumRecording> recordings = MakePendulums(study);
    const auto variants = Unwrapped(PushVariants(recordings, {}));
    EXPECT_EQ(variants.size(), 8u);
    const PushVariant& same = Named(variants, "0 frames");
    const PushVariant& longer = Named(variants, "+4 frames");
    for (size_t i = 0; i < recordings.size(); ++i) {
      const ScenePush& before = recordings[i].scene.pushes[0];
      const ScenePush& after = same.recordings[i].scene.pushes[0];
      EXPECT_EQ(after.kind, kind);
      EXPECT_EQ(after.start_frame, before.start_frame);
      ASSERT_EQ(after.force.size(), before.force.size());
      for (size_t k = 0; k < before.force.size(); ++k) {
        EXPECT_NEAR((after.force[k] - before.force[k]).norm(), 0.0, 1e-5 * before.mean.norm());
      }
      EXPECT_EQ(longer.recordings[i].scene.pushes[0].force.size(), before.force.size() + 4);
    }
  }
}

TEST(PushVariants, AMeasuredPushHasItsSensorsNoiseAndClock) {
  SyntheticOptions study = TinyStudy();
  study.push_kind = PushKind::kExternal;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  PushVariantOptions options;
  options.sensor_noise = 0.02;
  options.draws = 40;
  const auto variants = PushVariants(recordings, options).value();
  ASSERT_EQ(variants.size(), 44u);
  const ScenePush& push = recordings[0].scene.pushes[0];
  double peak = 0.0, squares = 0.0;
  for (const Vector4<double>& row : push.force) peak = std::max(peak, std::abs(row[0]));
  for (int k = 0; k < options.draws; ++k) {
    for (size_t t = 0; t < push.force.size(); ++t) {
      const double off = variants[k].recordings[0].scene.pushes[0].force[t][0] - push.force[t][0];
      squares += off * off / static_cast<double>(options.draws * push.force.size());
    }
  }
  EXPECT_NEAR(std::sqrt(squares), 0.02 * peak, 0.2 * 0.02 * peak);
  const ScenePush& later = Named(variants, "a frame later").recordings[0].scene.pushes[0];
  EXPECT_EQ(later.start_frame, push.start_frame + 1);
  EXPECT_EQ(later.force, push.force);
  // Nothing pushes before the recording.
  const ScenePush& earlier = Named(variants, "a frame earlier").recordings[0].scene.pushes[0];
  EXPECT_EQ(earlier.start_frame, 0);
  EXPECT_EQ(earlier.force.size(), push.force.size() - 1);
  EXPECT_EQ(earlier.force.front(), push.force[1]);
  // Upright, 0.1 m of a lever; the force itself stays.
  const ScenePush& higher = Named(variants, "0.1 m higher").recordings[0].scene.pushes[0];
  ASSERT_EQ(higher.force.size(), push.force.size());
  for (size_t t = 0; t < push.force.size(); ++t) {
    const double lean = recordings[0].states[0][push.start_frame + t].q[2];
    EXPECT_EQ(higher.force[t][0], push.force[t][0]);
    EXPECT_NEAR(higher.force[t][2] - push.force[t][2], 0.1 * push.force[t][0] * std::cos(lean),
                0.01 * std::abs(push.force[t][0]) + 1e-9);
  }
}

TEST(PushVariants, RecordingsWithoutAPushAreNamed) {
  std::vector<PendulumRecording> recordings = MakePendulums(TinyStudy());
  for (PendulumRecording& r : recordings) r.scene.pushes.clear();
  EXPECT_TRUE(Contains(ProblemOf(PushVariants(recordings, {})), "push"));
}

// More noise of the sensor moves the estimates more, and the total error holds it.
TEST(PushCheck, TheErrorGrowsWithTheSensorsNoise) {
  SyntheticOptions study = TinyStudy();
  study.push_kind = PushKind::kExternal;
  const std::vector<PendulumRecording> recordings = MakePendulums(study);
  FitOptions fit = UnbiasedFit(study);
  ASSERT_FALSE(PrepareFit(recordings, &fit));
  FittedModel model;
  model.fit = Fit(recordings, fit);
  std::vector<double> noise_alone;
  for (const double noise : {0.0, 0.02, 0.08}) {
    PushVariantOptions options;
    options.sensor_noise = noise;
    ASSERT_FALSE(AddPushCheck(recordings, options, 2, nullptr, &model));
    RefitTable check = *model.push_check;
    EXPECT_EQ(check.parameters[0], "mu");
    const PushError all = PushErrors(check)[0];
    EXPECT_GE(all.total, check.standard_error[0]);
    EXPECT_GT(all.push, 0.0) << "a frame's shift moves mu";
    std::vector<RefitRow> kept;
    for (const RefitRow& row : check.rows) {
      EXPECT_TRUE(row.failure.empty()) << row.name << ": " << row.failure;
      if (row.source == "sensor noise") kept.push_back(row);
    }
    check.rows = kept;
    noise_alone.push_back(PushErrors(check)[0].push);
  }
  EXPECT_LT(noise_alone[0], 1e-3 * noise_alone[1]);
  EXPECT_NEAR(noise_alone[2] / noise_alone[1], 4.0, 1.0);
}

}  // namespace
}  // namespace pushid
