// What the report says of groups: of whom there are any, by whole bodies where these were read.
#include <gtest/gtest.h>

#include "ident/bodies/body_recording.h"
#include "ident/report/page/build_report.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

constexpr int kGroupFrames = 60;

// People 0.6 m apart who go off one after the other, pushed from behind.
Recording Walkers(int people) {
  Recording recording;
  recording.id = "walkers";
  recording.fps = 60.0;
  for (int n = 0; n < people; ++n) {
    RecordedPerson person;
    person.subject_id = "P" + std::to_string(n);
    person.mass_kg = 80.0;
    person.joint_names = DefaultJointNames();
    person.joint_parents.assign(kBodyParents.begin(), kBodyParents.end());
    for (int role = 0; role < kBodyJoints; ++role) person.roles.joints[role] = {role};
    for (int t = 0; t < kGroupFrames; ++t) {
      const double way = 0.015 * std::max(0, t - 4 - 8 * n);
      const Pose pose = Placed(StandingPose(), 0.0, {0.6 * n + way, 0.0, 0.0});
      person.joints.emplace_back();
      for (int j = 0; j < kBodyJoints; ++j) person.joints.back().push_back(pose.col(j));
      person.hip.push_back(pose.col(kBodyHip));
      person.left_ankle.push_back(pose.col(kLeftAnkle));
      person.right_ankle.push_back(pose.col(kRightAnkle));
    }
    recording.people.push_back(person);
  }
  recording.pushes.push_back({0, 0, {{80.0, 0.0, 0.0, 0.0}, {80.0, 0.0, 0.0, 0.0}}, ""});
  return recording;
}

// Predicted as it was.
RecordingView Seen(const Recording& recording) {
  RecordingView view;
  view.recording = &recording;
  view.run.recording = MakePendulumRecording(recording);
  view.run.prediction.status.ok = true;
  view.run.prediction.hip = view.run.recording.hip;
  return view;
}

ReportSection SectionOf(const std::vector<RecordingView>& views) {
  const FittedModel model;
  return GroupSection({model, model.fit, views});
}

TEST(GroupSectionTest, TellsWhatPredictedGroupsDo) {
  const Recording group = Walkers(3), alone = Walkers(1);
  EXPECT_TRUE(SectionOf({Seen(alone)}).tables.empty());
  const ReportSection section = SectionOf({Seen(alone), Seen(group)});
  ASSERT_EQ(section.tables.size(), 2u) << "what they do, how the push travels";
  const auto& rows = section.tables[0].table.rows();
  ASSERT_EQ(rows.size(), 3u);
  // Steps at rest count half: 10 + 78 + 209 of 123 words of 19 steps; an NDMS of 0.936.
  // SSCP, changes, NDMS, pushed named, order, error, false and missed movers.
  const std::vector<std::string> exact = {"predicted", "0.000", "0.000", "0.936", "1 of 1",
                                          "1.000",     "0.000", "0",     "0"};
  EXPECT_EQ(rows[1], exact);
  EXPECT_EQ(rows[2][0], "constant velocity");
  EXPECT_NE(rows[2][1], "0.000") << "it ends with the push, before anybody goes off";
  EXPECT_TRUE(Contains(section.paragraphs[0], "do not move them"));
}

TEST(GroupSectionTest, WithoutBodiesOnsetsAreLeft) {
  Recording group = Walkers(2);
  for (RecordedPerson& person : group.people) person.roles = {};
  const ReportSection section = SectionOf({Seen(group)});
  ASSERT_EQ(section.tables.size(), 2u) << "what they do, how the push travels";
  EXPECT_EQ(section.tables[0].table.rows()[1][1], "none");
  EXPECT_EQ(section.tables[0].table.rows()[1][4], "1 of 1");
  EXPECT_TRUE(Contains(section.paragraphs[0], "no whole bodies"));
}

TEST(GroupSectionTest, APredictionThatFailedIsLeftOut) {
  const Recording group = Walkers(2);
  RecordingView failed = Seen(group);
  failed.run.prediction.status.ok = false;
  failed.run.prediction.hip.clear();
  EXPECT_TRUE(SectionOf({failed}).tables.empty());
}

}  // namespace
}  // namespace pushid
