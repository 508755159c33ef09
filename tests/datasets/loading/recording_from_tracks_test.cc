// A recording from tracks in memory: as from files, and refused for the same reasons.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "datasets/loading/motion_tracks.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Recording Standing(int frames) {
  RecordedPerson person;
  person.subject_id = "anna";
  person.mass_kg = 62.0;
  for (int t = 0; t < frames; ++t) {
    person.hip.emplace_back(0.001 * t, 0.0, 1.0);
    person.left_ankle.emplace_back(0.0, 0.1, 0.1);
    person.right_ankle.emplace_back(0.0, -0.1, 0.1);
  }
  Recording tracks;
  tracks.id = "trial";
  tracks.fps = 100.0;
  tracks.people = {person};
  tracks.pushes = {{0, 2, std::vector<Eigen::Vector4d>(3, Eigen::Vector4d(50, 0, 0, 0)), ""}};
  return tracks;
}

TEST(RecordingFromTracks, GapsAreFilledAndLongOnesDoNotCount) {
  Recording tracks = Standing(60);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (int t = 10; t < 13; ++t) tracks.people[0].hip[t].setConstant(kNaN);
  for (int t = 30; t < 50; ++t) tracks.people[0].left_ankle[t].setConstant(kNaN);
  const Recording made = Unwrapped(RecordingFromTracks(tracks));
  const RecordedPerson& person = made.people[0];
  EXPECT_NEAR(person.hip[11].x(), 0.011, 1e-12);
  ASSERT_EQ(person.weight.size(), 60u);
  EXPECT_EQ(person.weight[11], 1.0);
  EXPECT_EQ(person.weight[40], 0.0);
  EXPECT_EQ(made.pushes[0].EndFrame(), 5);
  // Equal tracks have one hash, others another.
  EXPECT_EQ(RecordingFromTracks(tracks).value().content_hash, made.content_hash);
  EXPECT_NE(RecordingFromTracks(Standing(60)).value().content_hash, made.content_hash);
}

TEST(RecordingFromTracks, GroundAndPlatformsShareItsFrames) {
  const auto made = [](const std::function<void(Recording*)>& change) {
    Recording tracks = Standing(60);
    PlateSample sample{{1.0, 2.0, 62.0 * 9.81}, {0.01, 0.0, 0.0}, 1.0};
    tracks.people[0].plates.assign(60, sample);
    for (int t = 0; t < 60; ++t) {
      const double u = std::max(0, t - 20) / 60.0;
      tracks.ground.emplace_back(0.02 + 0.1 * u * u, 0.0, 0.0, 0.0);
    }
    if (change) change(&tracks);
    return RecordingFromTracks(tracks);
  };
  const Recording both = Unwrapped(made(nullptr));
  EXPECT_EQ(both.ground[0], GroundPose(GroundPose::Zero()));
  EXPECT_NEAR(both.ground[50][0], 0.025, 1e-12);
  EXPECT_EQ(both.people[0].plates[7].centre.x(), 0.01);
  EXPECT_NE(both.content_hash, RecordingFromTracks(Standing(60)).value().content_hash);
  const auto told = [&](const std::function<void(Recording*)>& change) {
    return ProblemOf(made(change));
  };
  EXPECT_TRUE(Contains(told([](auto* t) { t->ground.pop_back(); }), "59 rows, the motion 60"));
  EXPECT_TRUE(Contains(told([](auto* t) { t->people[0].plates.pop_back(); }), "59 rows"));
  EXPECT_TRUE(Contains(told([](auto* t) { t->people[0].mass_kg = 80.0; }), "80 kg weigh"));
  EXPECT_TRUE(Contains(told([](auto* t) {
                         for (int i = 0; i < 60; ++i) t->ground[i][0] = 0.01 * i;
                       }),
                       "at frame 0"));
  EXPECT_TRUE(Contains(told([](auto* t) { t->ground[3][2] = NAN; }), "not finite"));
}

// Every third frame without a hip: interpolated frames count by the two thirds that were seen.
TEST(RecordingFromTracks, ManyInterpolatedFramesCountLess) {
  Recording tracks = Standing(60);
  const Eigen::Vector3d hidden =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int t = 1; t < 60; t += 10) tracks.people[0].hip[t] = hidden;
  Warnings warnings;
  Result<Recording> made = RecordingFromTracks(tracks, {}, &warnings);
  ASSERT_TRUE(made.ok()) << made.error().ToString();
  EXPECT_TRUE(made.value().people[0].weight.empty()) << "six of 60 are few";
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Contains(warnings[0].text, "recording 'trial': anna has 6 gaps in hip and ankles"));
  EXPECT_FALSE(Contains(warnings[0].text, "count less"));

  for (int t = 1; t < 59; t += 3) tracks.people[0].hip[t] = hidden;
  tracks.people[0].hip[11] = tracks.people[0].hip[21] = hidden;
  warnings.clear();
  made = RecordingFromTracks(tracks, {}, &warnings);
  ASSERT_TRUE(made.ok()) << made.error().ToString();
  const RecordedPerson& person = made.value().people[0];
  ASSERT_EQ(person.weight.size(), 60u);
  const auto interpolated = std::count_if(person.weight.begin(), person.weight.end(),
                                          [](double weight) { return weight < 1.0; });
  EXPECT_EQ(person.weight[0], 1.0);
  EXPECT_DOUBLE_EQ(person.weight[4], 1.0 - static_cast<double>(interpolated) / 60.0);
  EXPECT_NEAR(person.hip[4].x(), 0.004, 1e-9);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Contains(warnings[0].text, "these count less"));
}

TEST(RecordingFromTracks, WhatIsWrongIsTold) {
  const auto problem = [](auto change) {
    Recording tracks = Standing(20);
    change(&tracks);
    return ProblemOf(RecordingFromTracks(tracks));
  };
  using Tracks = Recording*;
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->fps = 0.0; }), "recording 'trial': fps"));
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->people.clear(); }), "no people"));
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->people[0].mass_kg = 0.0; }), "mass of 'anna'"));
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->people[0].hip.pop_back(); }), "19, 20 and 20"));
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->pushes[0].person = 1; }), "no person 1"));
  EXPECT_TRUE(Contains(problem([](Tracks t) { t->pushes[0].start_frame = 18; }), "not within"));
  EXPECT_TRUE(Contains(problem([](Tracks t) {
                         t->people[0].hip[0].setConstant(std::numeric_limits<double>::quiet_NaN());
                       }),
                       "at frame 0"));
  EXPECT_TRUE(Contains(problem([](Tracks t) {
                         for (auto* track : {&t->people[0].hip, &t->people[0].left_ankle}) {
                           for (Eigen::Vector3d& p : *track) p *= 1000.0;
                         }
                       }),
                       "anna"));
}

}  // namespace
}  // namespace pushid
