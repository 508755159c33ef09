// Mirror, measures and heading of the body; rotations and the skeleton that carries a pose out.
#include "models/restoration/body.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/models/body_samples.h"

namespace pushid {
namespace {

TEST(BodyTest, ParentsPrecedeTheirChildrenAndTheMirrorKeepsTheTree) {
  for (int j = 1; j < kBodyJoints; ++j) {
    EXPECT_LT(kBodyParents[j], j);
    EXPECT_EQ(MirroredJoint(MirroredJoint(j)), j);
    EXPECT_EQ(MirroredJoint(kBodyParents[j]), kBodyParents[MirroredJoint(j)]) << j;
  }
  EXPECT_EQ(MirroredJoint(kRightToe), kLeftToe);
  EXPECT_EQ(MirroredJoint(kRightWrist), kLeftWrist);
  EXPECT_EQ(MirroredJoint(kBodyHead), kBodyHead);
}

TEST(BodyTest, TheMirrorSwapsSidesAndTwiceIsNothing) {
  const Pose pose = StandingPose(), mirrored = Mirrored(pose);
  EXPECT_EQ(mirrored(1, kLeftAnkle), -pose(1, kRightAnkle));
  EXPECT_EQ(mirrored(0, kLeftAnkle), pose(0, kRightAnkle));
  EXPECT_EQ(Mirrored(mirrored), pose);
}

TEST(BodyTest, HeadingFollowsATurnedBody) {
  const Pose pose = StandingPose();
  EXPECT_NEAR(Heading(pose), 0.0, 1e-12);
  for (double turn : {-3.0, -1.0, 0.5, 1.6, 3.1}) {
    EXPECT_NEAR(Heading(Placed(pose, turn, {1, 2, 0})), turn, 1e-12);
  }
  EXPECT_EQ(Heading(Pose::Zero()), 0.0);
}

TEST(BodyTest, BoneAndLegLengthsByHand) {
  Pose pose = Pose::Zero();
  pose.col(kRightKnee) << 0, 0, -0.4;
  pose.col(kRightAnkle) << 0, 0.3, -0.8;
  EXPECT_DOUBLE_EQ(BoneLengths(pose)[kRightKnee], 0.4);
  EXPECT_DOUBLE_EQ(BoneLengths(pose)[kRightAnkle], 0.5);
  EXPECT_EQ(BoneLengths(pose)[0], 0.0);
  EXPECT_DOUBLE_EQ(LegLength(pose), 0.45);  // the left leg has none
}

TEST(RotationsTest, SixNumbersAndBack) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d axis(random.Normal(), random.Normal(), random.Normal());
    const Eigen::Matrix3d r =
        Eigen::AngleAxisd(random.Uniform(-3.1, 3.1), axis.normalized()).toRotationMatrix();
    const Rotation6d numbers = ToRotation6d(r);
    Eigen::Matrix3d back;
    back << numbers.head<3>(), numbers.tail<3>(), numbers.head<3>().cross(numbers.tail<3>());
    EXPECT_LT((back - r).norm(), 1e-12);
  }
}

TEST(RotationsTest, SwingTurnsOneDirectionIntoAnother) {
  const Eigen::Vector3d x(2, 0, 0), y(0, 0.5, 0);
  const Eigen::Matrix3d swing = SwingBetween(x, y);
  EXPECT_LT((swing * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((swing * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((SwingBetween(x, -x) * x + x).norm(), 1e-9);
  EXPECT_EQ(SwingBetween(x, Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
}

TEST(RotationsTest, FitFindsTheRotationAndNeverAMirror) {
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<Eigen::Vector3d> from = {{0.1, 0, 0}, {0, 0.2, 0}, {0, 0.1, 0.3}};
  std::vector<Eigen::Vector3d> to;
  for (const Eigen::Vector3d& v : from) to.push_back(r * v);
  EXPECT_LT((FitRotation(from, to) - r).norm(), 1e-12);
  for (Eigen::Vector3d& v : to) v.y() = -v.y();
  EXPECT_NEAR(FitRotation(from, to).determinant(), 1.0, 1e-12);
}

TEST(SkeletonFitTest, APoseOfTheSkeletonItselfComesBackExactly) {
  const Pose rest = StandingPose();
  const Eigen::Matrix3d lean =
      Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
  const Pose wanted = (lean * rest).colwise() + Eigen::Vector3d(0.5, 0.1, 0.02);
  const FittedTree posed = FitSkeleton(rest, wanted);
  EXPECT_LT((posed.positions - wanted).norm(), 1e-12);
  EXPECT_LT((posed.rotations[0] - lean).norm(), 1e-12);
}

TEST(SkeletonFitTest, BonesKeepTheirLengthWhateverIsWanted) {
  const Pose rest = StandingPose();
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    Pose wanted = rest;
    for (int k = 0; k < wanted.size(); ++k) wanted.data()[k] += 0.1 * random.Normal();
    const FittedTree posed = FitSkeleton(rest, wanted);
    EXPECT_LT((BoneLengths(posed.positions) - BoneLengths(rest)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(posed.positions.col(0), wanted.col(0));
    // What is carried out already stays as it is.
    EXPECT_LT((FitSkeleton(rest, posed.positions).positions - posed.positions).norm(), 1e-9);
  }
}

TEST(SkeletonFitTest, ALegReachesItsTargetWithBonesOfTheSameLength) {
  const Pose rest = StandingPose();
  Pose pose = rest;
  const Eigen::Vector3d target = rest.col(kLeftAnkle) + Eigen::Vector3d(0.1, -0.02, 0.15);
  EXPECT_LT(ReachWithLeg(true, target, &pose), 1e-12);
  EXPECT_LT((pose.col(kLeftAnkle) - target).norm(), 1e-12);
  EXPECT_LT((BoneLengths(pose) - BoneLengths(rest)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(pose(0, kLeftKnee), rest(0, kLeftKnee)) << "the knee bends forwards";
  EXPECT_LT(
      (pose.col(kLeftToe) - pose.col(kLeftAnkle) - (rest.col(kLeftToe) - rest.col(kLeftAnkle)))
          .norm(),
      1e-12);
  EXPECT_EQ(pose.col(kRightKnee), rest.col(kRightKnee));
}

TEST(SkeletonFitTest, ALegComesAsNearAsItIsLong) {
  Pose pose = StandingPose();
  const Eigen::Vector3d far = pose.col(kRightHip) + Eigen::Vector3d(0, 0, -2.0);
  const double length = BoneLengths(pose)[kRightKnee] + BoneLengths(pose)[kRightAnkle];
  EXPECT_NEAR(ReachWithLeg(false, far, &pose), 2.0 - length, 2e-3);
  EXPECT_TRUE(pose.allFinite());
}

}  // namespace
}  // namespace pushid
