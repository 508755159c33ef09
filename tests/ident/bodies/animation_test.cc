// The page and the strip: what they hold, and that no name can break them. An independent program
// reads the BVH of a body.
#include "ident/bodies/animation.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "ident/figures/svg.h"
#include "ident/formations/formation_run.h"
#include "models/formation.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Animation AnimatedPair() {
  Animation animation;
  animation.title = "a </script> & \"b\"";
  PendulumRecording recording;
  recording.subject_ids = {"x"};
  recording.scene.people.resize(1);
  recording.states = {std::vector<PendulumState<double>>(5)};
  recording.hip = {std::vector<Vector3<double>>(5, {0.0, 0.0, 1.0})};
  AddRecorded(recording, {BodyMotion(5, StandingPose())}, &animation);
  AnimatedPerson predicted;
  predicted.name = "x";
  predicted.SetBody(BodyMotion(5, StandingPose()));
  predicted.cart.assign(5, {0.0, 0.0, 0.09});
  predicted.tip.assign(5, {0.0, 0.0, 1.0});
  predicted.force.assign(5, {120.0, 0.0, 3.0, 0.0});
  animation.people.push_back(predicted);
  return animation;
}

TEST(AnimationTest, ThePageStandsAloneAndItsDataParse) {
  const std::string html = AnimationHtml({AnimatedPair()});
  EXPECT_FALSE(Contains(html, "http"));
  const size_t begin = html.find("const all=") + 10, end = html.find(";\nlet data=");
  ASSERT_NE(end, std::string::npos);
  EXPECT_FALSE(Contains(html.substr(begin, end - begin), "</"));
  const auto data = nlohmann::json::parse(html.substr(begin, end - begin))[0];
  EXPECT_EQ(data["frames"], 5);
  EXPECT_EQ(data["people"][0]["recorded"], true);
  EXPECT_EQ(data["people"][0]["body"][4].size(), 66u);
  EXPECT_EQ(data["people"][1]["force"][0][0], 120);
  EXPECT_EQ(data["people"][1]["tip"][0][2], 1000);
  EXPECT_EQ(data["people"][1]["tip"][2][2], 0) << "less the sample before";
  EXPECT_EQ(data["title"], "a </script> & \"b\"");
}

// Frames 0 and 3 of 5, which the others lie between; the second animation is the reader's choice.
TEST(AnimationTest, FewerSamplesAndSeveralRecordings) {
  Animation first = AnimatedPair(), second = AnimatedPair();
  first.dt = second.dt = 0.1;
  second.title = "second";
  for (int t = 0; t < 5; ++t) first.people[1].tip[t].x() = 0.1 * t;
  const std::string html = AnimationHtml({first, second}, 0.3);
  const size_t begin = html.find("const all=") + 10;
  const auto all = nlohmann::json::parse(html.substr(begin, html.find(";\nlet data=") - begin));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1]["title"], "second");
  EXPECT_EQ(all[0]["every"], 3);
  EXPECT_EQ(all[0]["frames"], 4);
  EXPECT_EQ(all[0]["people"][1]["tip"], nlohmann::json({{0, 0, 1000}, {300, 0, 0}}));
}

// A file's own skeleton where it is no whole body: its bones, and no head to draw.
TEST(AnimationTest, AnotherSkeletonKeepsItsBones) {
  Animation animation = AnimatedPair();
  animation.people[0].head = -1;
  animation.people[0].parents = {-1, 0};
  animation.people[0].joints.assign(5, Eigen::Matrix3Xd::Ones(3, 2));
  EXPECT_TRUE(Contains(AnimationHtml({animation}), "\"parents\":[-1,0]"));
  EXPECT_TRUE(Contains(AnimationHtml({animation}), "\"head\":-1"));
  EXPECT_TRUE(Contains(AnimationHtml({animation}), "\"body\":[[1000,1000,1000,1000,1000,1000]"));
}

Animation Moving(const std::vector<double>& x) {
  Animation animation;
  animation.title = "t";
  AnimatedPerson person;
  person.name = "p";
  for (const double at : x) {
    person.cart.emplace_back(at, 0.0, 0.1);
    person.tip.emplace_back(at, 0.0, 1.0);
  }
  animation.people.push_back(person);
  return animation;
}

TEST(AnimationTest, ALongRowHasAColourForEverybody) {
  Animation animation;
  animation.title = "row";
  for (int n = 0; n < 9; ++n) {
    AnimatedPerson person = Moving({0.5 * n, 0.5 * n}).people[0];
    person.name = "p" + std::to_string(n);
    animation.people.push_back(person);
  }
  const std::string html = AnimationHtml({animation});
  EXPECT_TRUE(Contains(html, ColourOf(0.0)));
  EXPECT_FALSE(Contains(html, std::string("\"") + kAnimationColours[2] + "\""));
}

TEST(AnimationTest, NothingRecordedNothingCalledSo) {
  const Animation animation = Moving({0, 1});
  EXPECT_FALSE(Contains(AnimationHtml({animation}), "> recorded<"));
  EXPECT_TRUE(Contains(AnimationHtml({AnimatedPair()}), "> recorded<"));
}

TEST(AnimationTest, APushIsWritten) {
  Animation animation = Moving({0, 0.1, 0.2, 0.3});
  animation.pushes.push_back({"p", 0, {{120.0, 0.0, 0.0, 0.0}}});
  EXPECT_TRUE(Contains(AnimationHtml({animation}), "\"force\":[[120,0]]"));
}

TEST(AnimationTest, FootprintsAreWrittenWithTheirFrames) {
  Animation animation = Moving({0, 0, 0, 0, 0});
  EXPECT_FALSE(Contains(AnimationHtml({animation}), "id=\"footprints\""));
  animation.people[0].footprints = {{Foot::kLeft, 0, 1, {0, 0.1}}, {Foot::kLeft, 3, 5, {0.4, 0.1}}};
  const std::string html = AnimationHtml({animation});
  EXPECT_TRUE(Contains(html, "id=\"footprints\""));
  EXPECT_TRUE(Contains(html, "[400,100,3,5]"));
}

TEST(AnimationTest, WhatIfsHaveEntriesOfTheirOwn) {
  Animation animation = Moving({0, 1});
  animation.people.push_back(animation.people[0]);
  animation.people[1].what = "mu=10";
  EXPECT_EQ(WhatsOf(animation), std::vector<std::string>({"", "mu=10"}));
  const std::string html = AnimationHtml({animation});
  EXPECT_TRUE(Contains(html, kAsFitted));
  EXPECT_TRUE(Contains(html, "mu=10"));
  EXPECT_TRUE(Contains(html, kAnimationColours[1]));
}

TEST(FormationBodiesTest, PosesStandWhereThePeopleDoAndMapBackToTheirPendulums) {
  Scene scene =
      FormationScene(FormationPositions(FormationShape::kLine, 3, 0.5), {80, 0.9, 0.0}, 1.0 / 60.0);
  const std::vector<Pose> given = {Placed(StandingPose(), 1.0, {4, 5, 0}), SyntheticPose(0.9)};
  const std::vector<Pose> poses = TakePoses(given, &scene);
  ASSERT_EQ(poses.size(), 3u);
  for (int n = 0; n < 3; ++n) {
    EXPECT_NEAR(Heading(poses[n]), 0.0, 1e-9);
    EXPECT_NEAR(scene.people[n].start.q[0], 0.5 * n, 1e-9);
    EXPECT_LT((HipPosition(scene.people[n].body, scene.people[n].start.q) - poses[n].col(0)).norm(),
              1e-9);
    EXPECT_EQ(scene.people[n].body.mass, 80.0);
  }
  EXPECT_NEAR(scene.people[1].body.rod_length, 0.9, 1e-9);
  EXPECT_NEAR(scene.people[1].start.q[2], 0.0, 1e-9);
}

}  // namespace
}  // namespace pushid
