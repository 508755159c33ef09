// Groups judged: a case by hand, and the check values of the published recordings.
#include "ident/validation/group_metrics.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "datasets/loading/load_recordings.h"
#include "ident/bodies/body_recording.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/group_motion.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

// Two people, one 0.6 m before the other; each goes forwards by 1.5 cm a frame from a frame on.
GroupMotion Walkers(int begin, int begin_in_front, int frames = 30) {
  GroupMotion group;
  for (const auto& [x, from] : {std::pair(0.0, begin), std::pair(0.6, begin_in_front)}) {
    BodyMotion motion;
    for (int t = 0; t < frames; ++t) {
      const double way = 0.015 * std::max(0, t - from);
      motion.push_back(Placed(StandingPose(), 0.0, {x + way, 0, 0}));
    }
    group.people.push_back(motion);
  }
  return group;
}

// The motion in so many frames, with straight lines in between.
BodyMotion AtSpeed(const BodyMotion& motion, double speed, int frames) {
  return Resampled(motion, 1.0, speed, frames);
}

TEST(GroupMetricsTest, OnsetsByHand) {
  OnsetMetrics metrics;  // 2 cm are passed two frames after the beginning
  AddOnsets(Walkers(4, 10), Walkers(6, 7), &metrics);
  EXPECT_EQ(metrics.pushed_named, 1);
  EXPECT_EQ(metrics.in_order, 1);
  EXPECT_NEAR(metrics.error_sum, 5.0 / 60.0, 1e-12);
  AddOnsets(Walkers(4, 10), Walkers(10, 4), &metrics);  // the wrong way round
  AddOnsets(Walkers(4, 10), Walkers(4, 100), &metrics);
  AddOnsets(Walkers(4, 100), Walkers(4, 10), &metrics);
  AddOnsets(Walkers(4, 10), Walkers(100, 100), &metrics);
  EXPECT_EQ(metrics.recordings, 5);
  EXPECT_EQ(metrics.pushed_named, 3);
  EXPECT_EQ(metrics.pairs, 4);
  EXPECT_EQ(metrics.in_order, 2);
  EXPECT_EQ(metrics.missed_movers, 3);
  EXPECT_EQ(metrics.false_movers, 1);
}

TEST(GroupMetricsTest, TheRecordingsThemselvesScoreBest) {
  const std::vector<GroupMotion> groups = {Walkers(0, 0), Walkers(0, 0)};
  const GroupMetrics metrics = CompareGroups(groups, groups);
  EXPECT_EQ(*metrics.social.sscp, 0.0);
  EXPECT_NEAR(*metrics.social.ndms, 1.0, 1e-9);
  const std::vector<GroupMotion> later = {Walkers(4, 10), Walkers(6, 20)};
  const GroupMetrics in_turn = CompareGroups(later, later);
  EXPECT_EQ(*in_turn.social.sscp_changes, 0.0);
  const nlohmann::ordered_json json = ToJson(in_turn);
  EXPECT_EQ(json["pushed_named"], 2);
  EXPECT_EQ(json["onset_order"], 1.0);
  EXPECT_EQ(json["onset_error_s"], 0.0);
}

// People stand for 30 frames, which are shown, and then go; the forecast goes on standing.
TEST(GroupMetricsTest, ShownFramesDoNotCount) {
  GroupMotion recorded = Walkers(29, 29, 60), still = Walkers(100, 100, 60);
  const double flattered = *CompareStates({recorded}, {still}).sscp;
  recorded.first_frame = still.first_frame = 30;
  // Recorded: steps alone; forecast: standing alone. Disjoint statistics are sqrt(ln 2) apart.
  EXPECT_NEAR(*CompareStates({recorded}, {still}).sscp, std::sqrt(std::log(2.0)), 1e-9);
  EXPECT_LT(flattered, 0.8);
  // 31 frames from the last shown one on make 12 words. None of them stands, so that
  // standing finds nothing like itself; among all frames it finds the shown ones, 1/2 a joint.
  EXPECT_LT(*CompareWords({recorded}, {still}), 1e-4);
  recorded.first_frame = 1;
  EXPECT_NEAR(*CompareWords({recorded}, {still}), 0.5, 1e-4);
}

// The first was shown to begin; whether the second does, and when, was not.
TEST(GroupMetricsTest, OnsetsThatWereShownDoNotCount) {
  GroupMotion predicted = Walkers(4, 12);
  predicted.first_frame = 10;
  OnsetMetrics metrics;
  AddOnsets(Walkers(4, 10), predicted, &metrics);
  EXPECT_EQ(metrics.recordings, 0);  // who moves first was shown
  EXPECT_EQ(metrics.pairs, 0);
  EXPECT_EQ(metrics.movers, 1);
  EXPECT_NEAR(metrics.error_sum, 2.0 / 60.0, 1e-12);
  AddOnsets(Walkers(11, 20), predicted, &metrics);  // nobody was shown to begin
  EXPECT_EQ(metrics.recordings, 1);
  EXPECT_EQ(metrics.pairs, 1);
}

TEST(GroupMetricsTest, WhatIsNotDefinedHasNoNumber) {
  GroupMotion still = Walkers(100, 100);
  const GroupMetrics metrics = CompareGroups({Walkers(4, 10)}, {still});
  EXPECT_FALSE(metrics.social.sscp_changes.has_value());
  EXPECT_TRUE(ToJson(metrics)["sscp_changes"].is_null());
  EXPECT_TRUE(ToJson(metrics)["onset_error_s"].is_null());
  EXPECT_EQ(GroupMetricsTable({{"still", &metrics}}).rows()[1][2], "none");
  // Too short for a word.
  EXPECT_FALSE(CompareWords({Walkers(4, 10, 19)}, {Walkers(4, 10)}).has_value());
  EXPECT_FALSE(CompareWords({Walkers(4, 10)}, {Walkers(4, 10, 19)}).has_value());
}

// A motion in twice as many frames a second is the same motion.
TEST(GroupMetricsTest, TheRateOfTheRecordingDoesNotCount) {
  GroupMotion fast = Walkers(4, 10);
  for (BodyMotion& person : fast.people) person = AtSpeed(person, 0.5, 59);
  fast.dt *= 0.5;
  const SocialMetrics metrics = CompareStates({Walkers(4, 10)}, {fast});
  EXPECT_NEAR(*metrics.sscp, 0.0, 1e-7);
  // Steps at rest count half: 10 + 55 of 22 words of 19 steps.
  EXPECT_NEAR(*CompareWords({Walkers(4, 10)}, {fast}), 1.0 - 0.5 * 65.0 / 418.0, 1e-9);
}

// Check values of issue 20: folds by a recording's position within its setting, modulo 4.
class RealGroupsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (RecordingsRoot().empty()) GTEST_SKIP() << kNoRecordings;
    LoadOptions load;
    load.setting = "groups";
    load.keep_all_joints = true;
    const auto recordings = Unwrapped(LoadRecordings(RecordingsRoot() + "/manifest.json", load));
    std::map<std::string, int> position;
    for (const Recording& recording : recordings) {
      const auto body = Unwrapped(MakeBodyRecording(recording));
      const bool in_first = position[recording.labels.setting()]++ % 4 == 0;
      (in_first ? first_ : others_).push_back({body.bodies});
    }
    ASSERT_EQ(first_.size(), 14u);
    ASSERT_EQ(others_.size(), 35u);
  }
  // The first fold with each motion changed.
  template <typename Change>
  std::vector<GroupMotion> Changed(Change change) const {
    std::vector<GroupMotion> changed = first_;
    for (GroupMotion& group : changed) {
      for (BodyMotion& person : group.people) person = change(person);
    }
    return changed;
  }
  void Expect(const std::vector<GroupMotion>& motions, double sscp, double changes, double ndms) {
    const SocialMetrics metrics = CompareStates(first_, motions);
    EXPECT_NEAR(*metrics.sscp, sscp, 1e-6);
    EXPECT_NEAR(metrics.sscp_changes.value_or(-1.0), changes, 1e-6);
    EXPECT_NEAR(*CompareWords(first_, motions), ndms, 1e-6);
  }
  std::vector<GroupMotion> first_, others_;
};

TEST_F(RealGroupsTest, StatesAndChanges) {
  std::vector<int> counts(kSocialStates);
  int changes = 0;
  for (const GroupMotion& group : first_) {
    for (const Symbols& symbols : SocialStates(group.people, group.dt)) {
      for (const int symbol : symbols) ++counts[symbol];
      for (size_t t = 1; t < symbols.size(); ++t) changes += symbols[t] != symbols[t - 1];
    }
  }
  EXPECT_EQ(counts, (std::vector<int>{2770, 202, 1426, 165, 106, 969}));
  EXPECT_EQ(changes, 226);
}

TEST_F(RealGroupsTest, OtherRecordings) { Expect(others_, 0.040424, 0.143350, 0.474745); }

TEST_F(RealGroupsTest, HalfSpeed) {
  Expect(Changed([](const BodyMotion& m) { return AtSpeed(m, 0.5, static_cast<int>(m.size())); }),
         0.223645, 0.285464, 0.486361);
}

TEST_F(RealGroupsTest, EveryFrameDoubled) {
  const auto doubled = [](const BodyMotion& motion) {
    BodyMotion twice;
    for (const Pose& pose : motion) twice.insert(twice.end(), 2, pose);
    twice.resize(motion.size());
    return twice;
  };
  Expect(Changed(doubled), 0.485349, 0.546380, 0.333401);
}

TEST_F(RealGroupsTest, Frozen) {
  const auto frozen = [](const BodyMotion& m) { return BodyMotion(m.size(), m.front()); };
  Expect(Changed(frozen), 0.476111, -1.0, 0.000961);
}

TEST_F(RealGroupsTest, Itself) { Expect(first_, 0.0, 0.0, 1.0); }

}  // namespace
}  // namespace pushid
