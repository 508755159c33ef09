// A pendulum in turned axes.
#include "models/turn.h"

#include <gtest/gtest.h>

#include "models/push.h"

namespace pushid {
namespace {

const Vector4<double> kPose(0.3, -0.2, 0.25, -0.4), kRate(0.5, 0.1, -1.2, 0.7);
constexpr double kAngles[] = {0.3, 1.2, 2.7, -3.0};

TEST(Turn, TipTurnsAsAPoint) {
  const Body body{70.0, 0.9, 0.1};
  for (double angle : kAngles) {
    const TurnedAxes axes(angle);
    const Vector3<double> tip = axes.Point(HipPosition(body, kPose));
    EXPECT_LT((HipPosition(body, axes.Pose(kPose)) - tip).norm(), 1e-14) << angle;
  }
}

TEST(Turn, BackIsWhereItWas) {
  for (double angle : kAngles) {
    const Vector4<double> there = TurnedAxes(angle).Pose(kPose);
    EXPECT_LT((TurnedAxes(-angle).Pose(there) - kPose).norm(), 1e-14) << angle;
  }
}

TEST(Turn, RatesAreThoseOfThePose) {
  constexpr double kStep = 1e-6;
  for (double angle : kAngles) {
    const TurnedAxes axes(angle);
    const Vector4<double> by_difference =
        (axes.Pose(kPose + kStep * kRate) - axes.Pose(kPose - kStep * kRate)) / (2.0 * kStep);
    EXPECT_LT((axes.PoseJacobian(kPose) * kRate - by_difference).norm(), 1e-8) << angle;
  }
}

TEST(Turn, ForcesKeepTheirPowerAndTheirPoint) {
  const Body body{70.0, 0.9, 0.1};
  const Vector3<double> push(80.0, 30.0, 0.0);
  const Vector4<double> force = GeneralizedForce<double>(body, kPose, push, 1.0);
  for (double angle : kAngles) {
    const TurnedAxes axes(angle);
    const Vector4<double> turned = axes.Force(kPose, force);
    EXPECT_NEAR(turned.dot(axes.PoseJacobian(kPose) * kRate), force.dot(kRate), 1e-12);
    const Vector4<double> same =
        GeneralizedForce<double>(body, axes.Pose(kPose), axes.Point(push), 1.0);
    EXPECT_LT((turned - same).norm(), 1e-12) << angle;
  }
}

}  // namespace
}  // namespace pushid
