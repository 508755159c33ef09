// Symbols of people who are made to do one thing at a time.
#include <gtest/gtest.h>

#include "models/restoration/group_motion.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

constexpr double kDt = 1.0 / 60.0;

BodyMotion Standing(double x, double y = 0.0) {
  return BodyMotion(4, Placed(StandingPose(), 0.0, {x, y, 0}));
}

TEST(SocialStatesTest, StandLeanStep) {
  BodyMotion body = Standing(0);
  EXPECT_EQ(SocialStates({body}, kDt)[0], (Symbols{kStand, kStand, kStand, kStand}));
  // The hip is 0.91 m above the ankles: 5 degrees are 8 cm.
  body[2].col(kBodyHip).x() += 0.07;
  body[3].col(kBodyHip).x() += 0.10;
  EXPECT_EQ(SocialStates({body}, kDt)[0], (Symbols{kStand, kStand, kStand, kLean}));
  // 0.35 m/s are 5.8 mm a frame; a step wins over the lean. Frame 0 has the symbol of frame 1.
  body[3].col(kLeftAnkle).y() += 0.007;
  body[1].col(kRightAnkle).x() += 0.006;
  EXPECT_EQ(SocialStates({body}, kDt)[0], (Symbols{kStep, kStep, kStep, kStep}));
  body[1].col(kRightAnkle).x() -= 0.001;
  EXPECT_EQ(SocialStates({body}, kDt)[0], (Symbols{kStand, kStand, kStand, kStep}));
}

TEST(SocialStatesTest, APushNeedsAHandAtTheBackInFrontAndAHipThatGoesForwards) {
  std::vector<BodyMotion> people = {Standing(0), Standing(0.6), Standing(0.3, 0.4)};
  people[0][2].col(kRightWrist) = people[1][2].col(kUpperSpine) - Eigen::Vector3d(0.3, 0, 0);
  EXPECT_EQ(SocialStates(people, kDt)[0][2], kStand) << "the hip rests";
  people[0][2].col(kBodyHip).x() += 0.0014;  // 0.084 m/s
  EXPECT_EQ(SocialStates(people, kDt)[0][2], kPushStanding);
  EXPECT_EQ(SocialStates(people, kDt)[1][2], kStand) << "nobody stands in front";
  // Somebody nearer in front takes the place; the hand is too far from that back.
  people[2] = Standing(0.2, 0.1);
  people[2][2].col(kUpperSpine).y() += 1.0;
  EXPECT_EQ(SocialStates(people, kDt)[0][2], kStand);
}

}  // namespace
}  // namespace pushid
