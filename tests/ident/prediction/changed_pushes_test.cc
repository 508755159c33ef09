// Pushes that are scaled and repeated, on a push worked by hand.

#include <gtest/gtest.h>

#include "ident/prediction/prediction.h"
#include "tests/ident/fit_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Person 1 of two is pushed in frames 3 and 4, with 10 N and 30 N.
PendulumRecording Pushed() {
  PendulumRecording recording;
  recording.id = "two";
  recording.scene.people.resize(2);
  recording.scene.pushes = {
      MakeScenePush(1, 3, PushKind::kNet, {{10.0, 1.0, 8.0, 2.0}, {30.0, 3.0, 24.0, 4.0}})};
  return recording;
}

TEST(ChangedPushes, NothingChangesByDefault) {
  EXPECT_FALSE(ChangedPushes().Any());
  const PendulumRecording same = WithPushes(Pushed(), {});
  ASSERT_EQ(same.scene.pushes.size(), 1u);
  EXPECT_EQ(same.scene.pushes[0].force, Pushed().scene.pushes[0].force);
  EXPECT_FALSE(CheckChangedPushes({}, PendulumRecording(), 10)) << "no push is asked for";
}

TEST(ChangedPushes, EveryRowIsScaledAndTheMeanOfTheTail) {
  const Scene scene = WithPushes(Pushed(), {1.5, {}}).scene;
  EXPECT_EQ(scene.pushes[0].force[0], Vector4<double>(15.0, 1.5, 12.0, 3.0));
  EXPECT_EQ(scene.pushes[0].force[1], Vector4<double>(45.0, 4.5, 36.0, 6.0));
  EXPECT_EQ(scene.pushes[0].mean, Vector4<double>(30.0, 3.0, 24.0, 4.5));
}

TEST(ChangedPushes, APushComesAgainOnTheSamePerson) {
  const Scene scene = WithPushes(Pushed(), {2.0, {5, 20}}).scene;
  ASSERT_EQ(scene.pushes.size(), 3u);
  const int starts[] = {3, 5, 20};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.pushes[i].start_frame, starts[i]);
    EXPECT_EQ(scene.pushes[i].person, 1);
    EXPECT_EQ(scene.pushes[i].kind, PushKind::kNet);
    EXPECT_EQ(scene.pushes[i].force, scene.pushes[0].force);
    EXPECT_EQ(scene.pushes[i].mean, scene.pushes[0].mean);
  }
  EXPECT_EQ(scene.LastPushEnd(), 22);
}

// Three phases: 10 and 30 N, times 1.5, then times 2.
TEST(ChangedPushes, EachComesWithItsStrength) {
  const Scene scene = WithPushes(Pushed(), {1.0, {{15, 1.5}, {50, 2.0}}}).scene;
  ASSERT_EQ(scene.pushes.size(), 3u);
  EXPECT_EQ(scene.pushes[0].force[1][0], 30.0);
  EXPECT_EQ(scene.pushes[1].force[1][0], 45.0);
  EXPECT_EQ(scene.pushes[2].force[1][0], 60.0);
  EXPECT_EQ(scene.pushes[2].mean[0], 40.0);
}

TEST(ChangedPushes, SeveralPushesKeepTheirDistances) {
  PendulumRecording recording = Pushed();
  recording.scene.pushes.push_back(recording.scene.pushes[0]);
  recording.scene.pushes[1].start_frame = 9;
  recording.scene.pushes[1].person = 0;
  const Scene scene = WithPushes(recording, {1.0, {20}}).scene;
  ASSERT_EQ(scene.pushes.size(), 4u);
  EXPECT_EQ(scene.pushes[2].start_frame, 20);
  EXPECT_EQ(scene.pushes[3].start_frame, 26);
  EXPECT_EQ(scene.pushes[3].person, 0);
}

std::string Message(double scale, std::vector<PushAgain> again, int frames = 40) {
  const MaybeError error = CheckChangedPushes({scale, std::move(again)}, Pushed(), frames);
  return error ? error->ToString() : "";
}

TEST(ChangedPushes, ErrorsNameTheFlagAndTheReason) {
  EXPECT_EQ(Message(1.37, {5, 7, 38}), "");
  EXPECT_TRUE(Contains(Message(0.0, {}), "--push_scale is 0; it must be a positive number"));
  EXPECT_TRUE(Contains(Message(-1.0, {}), "--push_scale is -1"));
  EXPECT_TRUE(Contains(Message(NAN, {}), "--push_scale"));
  EXPECT_TRUE(Contains(Message(INFINITY, {}), "--push_scale"));
  EXPECT_TRUE(Contains(Message(1.0, {4}), "--push_again: frame 4 comes before"));
  EXPECT_TRUE(Contains(Message(1.0, {4}), "give frame 5 or a later one"));
  EXPECT_TRUE(Contains(Message(1.0, {20, 21}), "frame 21 comes before"));
  EXPECT_TRUE(Contains(Message(1.0, {39}), "--push_again: frame 39 is too late for the 40 frames"));
  EXPECT_TRUE(Contains(Message(1.0, {-1}), "frame -1 is negative"));
  EXPECT_TRUE(Contains(Message(1.0, {{20, 0.0}}), "frame 20 has the strength 0; it must be"));
  PendulumRecording calm = Pushed();
  calm.scene.pushes.clear();
  EXPECT_TRUE(
      Contains(ProblemOf(CheckChangedPushes({1.37, {}}, calm, 40)), "recording two has no push"));
}

TEST(ChangedPushes, WhatIsSaidOfThem) {
  EXPECT_EQ(ChangedPushesText({1.37, {}}, Pushed()), "1.37 times the recorded push");
  EXPECT_EQ(ChangedPushesText({1.0, {40, 80}}, Pushed()),
            "the recorded push, at frames 3, 40 and 80");
  EXPECT_EQ(ChangedPushesText({1.0, {{15, 1.5}, {50, 2.0}}}, Pushed()),
            "the recorded push, at frames 3, 15 (1.5 times) and 50 (2 times)");
}

// Until the second push, a prediction with it is the one without it; its first row drives the step
// from frame 60 to 61.
TEST(ChangedPushes, APredictionFollowsThem) {
  const SyntheticOptions study = TinyStudy();
  const PendulumRecording recording = MakePendulums(study)[0];
  const IdentifiedModel model = TruthOf(study);
  const auto hip = [&](const ChangedPushes& changed) {
    return Predict(model, WithPushes(recording, changed), 100).hip[0];
  };
  const auto once = hip({}), twice = hip({1.0, {60}}), harder = hip({1.37, {}});
  for (int t = 0; t <= 60; ++t) EXPECT_EQ(once[t], twice[t]) << t;
  EXPECT_NE(once[61], twice[61]);
  EXPECT_GT((twice[99] - once[99]).norm(), 0.01);
  EXPECT_GT((harder[99] - harder[0]).norm(), 1.1 * (once[99] - once[0]).norm());
}

}  // namespace
}  // namespace pushid
