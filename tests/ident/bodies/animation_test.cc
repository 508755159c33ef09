// The page and the strip: what they hold, and that no name can break them. An independent program
// reads the BVH of a body.
#include "ident/bodies/animation.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "ident/formations/formation_bodies.h"
#include "models/formation.h"
#include "tests/models/body_samples.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

Animation TwoPeople() {
  Animation animation;
  animation.title = "a </script> & \"b\"";
  AddRecorded({"x"}, {BodyMotion(5, StandingPose())}, &animation);
  AnimatedPerson predicted;
  predicted.name = "x";
  predicted.body = BodyMotion(5, StandingPose());
  predicted.cart.assign(5, {0.0, 0.0, 0.09});
  predicted.tip.assign(5, {0.0, 0.0, 1.0});
  predicted.force.assign(5, {120.0, 0.0, 3.0, 0.0});
  animation.people.push_back(predicted);
  return animation;
}

TEST(AnimationTest, ThePageStandsAloneAndItsDataParse) {
  const std::string html = AnimationHtml(TwoPeople());
  EXPECT_EQ(html.find("http"), std::string::npos);
  const size_t begin = html.find("const data=") + 11, end = html.find(";\nconst $=");
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(html.substr(begin, end - begin).find("</"), std::string::npos);
  const auto data = nlohmann::json::parse(html.substr(begin, end - begin));
  EXPECT_EQ(data["frames"], 5);
  EXPECT_EQ(data["people"][0]["recorded"], true);
  EXPECT_EQ(data["people"][0]["body"][4].size(), 66u);
  EXPECT_EQ(data["people"][1]["force"][0][0], 120);
  EXPECT_EQ(data["people"][1]["tip"][2][2], 1000);
  EXPECT_EQ(data["title"], "a </script> & \"b\"");
}

TEST(AnimationTest, TheStripHasItsPosesAndTimes) {
  const std::string svg = PoseStripSvg(TwoPeople(), 3);
  EXPECT_TRUE(Contains(svg, "0.0667 s"));
  EXPECT_TRUE(Contains(svg, "a &lt;/script&gt;"));
  size_t heads = 0;
  for (size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++heads;
  EXPECT_EQ(heads, 9u);  // two heads and a tip in each of three
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

using AssimpTest = TempDirTest;

TEST_F(AssimpTest, AnIndependentReaderTakesTheBvh) {
  if (std::system("command -v assimp >/dev/null 2>&1") != 0) GTEST_SKIP() << "assimp is not here";
  BodyScene scene;
  scene.id = "x";
  scene.subject_ids = {"s"};
  scene.bodies = {RigidRestoration().Restore({MovingPerson(StandingPose(), 80, 20)})[0]};
  ASSERT_TRUE(WriteBodyBvh(Path("m.bvh"), scene).ok());
  const std::string command =
      "assimp info " + Path("m.bvh") + " > " + Path("info.txt") + " 2>/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string info = ReadText(Path("info.txt"));
  EXPECT_TRUE(Contains(info, "Animations:         1"));
  EXPECT_TRUE(Contains(info, "LeftAnkle"));
}

}  // namespace
}  // namespace pushid
