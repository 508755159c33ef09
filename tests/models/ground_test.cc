// Ground that moves: gravity in its axes, and what the laboratory sees from it.
#include "models/ground.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "datasets/files/random.h"
#include "models/turn.h"

namespace pushid {
namespace {

constexpr double kGroundStep = 0.01;

Eigen::Matrix3d Turned(const GroundPose& pose) {
  return (Eigen::AngleAxisd(pose[3], Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(pose[2], Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

GroundPose RandomPose(Random* random) {
  return {random->Normal(), random->Normal(), 0.5 * random->Normal(), 0.5 * random->Normal()};
}

// From large tilts on: gravity is that of the rotation by which points go to the laboratory.
TEST(Ground, GravityIsThatOfTheTurnedFrame) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const GroundPose pose = RandomPose(&random);
    const GroundMotion ground = GroundThrough({pose, pose, pose}, kGroundStep);
    const Eigen::Vector3d gravity = Turned(pose).transpose() * Eigen::Vector3d(0, 0, -kGravity);
    for (int frame : {0, 1, 2, 7}) {
      const GroundStep& step = ground.StepAt(frame);
      EXPECT_NEAR(step.acceleration[0], -gravity.x(), 1e-12);
      EXPECT_NEAR(step.acceleration[1], -gravity.y(), 1e-12);
      EXPECT_NEAR(step.gravity, -gravity.z(), 1e-12);
    }
    const Eigen::Vector3d origin(0.3, -0.2, 0.1), point(1.0, 2.0, 3.0);
    EXPECT_LT((PointInLaboratory(pose, origin, point) -
               (origin + Eigen::Vector3d(pose[0], pose[1], 0.0) + Turned(pose) * (point - origin)))
                  .norm(),
              1e-12);
    EXPECT_LT((OnGround(pose, origin, PointInLaboratory(pose, origin, point)) - point).norm(),
              1e-12);
  }
}

// Whatever comes after the record, the ground stays where it was last.
TEST(Ground, AfterItsRecordItRests) {
  std::vector<GroundPose> poses;
  for (int t = 0; t < 5; ++t) poses.emplace_back(0.01 * t * t, 0.0, 0.0, 0.0);
  const GroundMotion ground = GroundThrough(poses, kGroundStep);
  EXPECT_NEAR(ground.StepAt(4).acceleration[0], 0.02 / (kGroundStep * kGroundStep), 1e-9);
  EXPECT_TRUE(ground.StepAt(5).acceleration.isZero(0.0));
  EXPECT_EQ(ground.PoseAt(9), poses.back());
  EXPECT_TRUE(GroundMotion{}.StepAt(3).acceleration.isZero(0.0));
  EXPECT_EQ(GroundMotion{}.StepAt(3).gravity, kGravity);
}

// What was measured trembles before it goes.
TEST(Ground, LeavesItsPlaceByATwentieth) {
  std::vector<GroundPose> poses;
  for (int t = 0; t < 40; ++t) {
    poses.emplace_back(t < 20 ? 0.0005 * (t % 2) : 0.04, 0.0, 0.0, 0.0);
  }
  EXPECT_EQ(FirstMotion(poses), 19);
  EXPECT_EQ(FirstMotion(std::vector<GroundPose>(7, poses[0])), 7);
  EXPECT_EQ(FirstMotion({}), 0);
}

// The hip of a state in the laboratory is where the ground's hip is seen, and its rates are those
// of what is seen, tilted as far as one likes.
TEST(Ground, StatesInTheLaboratoryAreExact) {
  Random random(4);
  const Body body{80.0, 0.9, 0.1};
  for (int trial = 0; trial < 20; ++trial) {
    GroundPose pose = RandomPose(&random), before = pose + 0.01 * RandomPose(&random);
    const GroundMotion ground = GroundThrough({before, pose}, kGroundStep);
    PendulumState<double> first, second;
    first.q = 0.4 * Vector4<double>(random.Normal(), random.Normal(), random.Normal(), 0.3);
    second.qd = Vector4<double>(random.Normal(), random.Normal(), random.Normal(), 0.2);
    second.q = first.q + kGroundStep * second.qd;
    const Vector3<double> origin(0.2, 0.1, body.cart_height);
    const PendulumState<double> a = InLaboratory(ground, 0, origin, first);
    const PendulumState<double> b = InLaboratory(ground, 1, origin, second);
    EXPECT_LT((b.q - a.q - kGroundStep * b.qd).norm(), 1e-12);
    const Vector3<double> cart(second.q[0], second.q[1], body.cart_height);
    const Vector3<double> rod = PointInLaboratory(pose, origin, HipPosition(body, second.q)) -
                                PointInLaboratory(pose, origin, cart);
    const Vector3<double> seen =
        HipPosition(body, b.q) - Vector3<double>(b.q[0], b.q[1], body.cart_height);
    EXPECT_LT((rod - seen).norm(), 1e-12);
    const Vector3<double> place = PointInLaboratory(pose, origin, cart);
    EXPECT_LT((place.head<2>() - b.q.head<2>()).norm(), 1e-12);
  }
}

// Turned about the vertical, ground is turned as rods are: gravity turns with it.
TEST(Ground, TurnsAsRodsDo) {
  Random random(5);
  const TurnedAxes axes(0.7);
  for (int trial = 0; trial < 10; ++trial) {
    const GroundPose pose = RandomPose(&random);
    const GroundStep step = GroundThrough({pose, pose}, kGroundStep).StepAt(0);
    const GroundStep turned =
        GroundThrough({axes.Pose(pose), axes.Pose(pose)}, kGroundStep).StepAt(0);
    EXPECT_NEAR(turned.gravity, step.gravity, 1e-12);
    EXPECT_NEAR(turned.acceleration.head<2>().norm(), step.acceleration.head<2>().norm(), 1e-12);
  }
}

}  // namespace
}  // namespace pushid
