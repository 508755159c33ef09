// datasets: proportions and posing of the synthetic skeleton.
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {
namespace {

// Everything is quoted as a fraction of the rod: pelvis centre to ankles, about 0.52 of a person's
// height (Winter, Biomechanics and Motor Control of Human Movement, segment lengths).
constexpr double kHalfStance = 0.10;   // hip joint to the side of the pelvis centre
constexpr double kAnkleHeight = 0.08;  // above the ground
constexpr double kBone = 0.502;        // thigh, shank: a standing knee is never quite straight

struct JointShape {
  const char* name;
  int parent;
  double x, y, z;  // offset from the parent, rods
};

constexpr std::array<JointShape, kSkeletonJoints> kShapes = {{
    {"Hips", -1, 0, 0, 0},
    {"Spine", 0, 0, 0, 0.11},
    {"Spine1", 1, 0, 0, 0.11},
    {"Spine2", 2, 0, 0, 0.11},
    {"Neck", 3, 0, 0, 0.17},
    {"Head", 4, 0.02, 0, 0.09},
    {"RightClavicle", 3, 0, -0.03, 0.10},
    {"RightShoulder", 6, 0, -0.16, -0.02},
    {"RightElbow", 7, 0, 0, -0.34},
    {"RightWrist", 8, 0, 0, -0.28},
    {"LeftClavicle", 3, 0, 0.03, 0.10},
    {"LeftShoulder", 10, 0, 0.16, -0.02},
    {"LeftElbow", 11, 0, 0, -0.34},
    {"LeftWrist", 12, 0, 0, -0.28},
    {"RightHip", 0, 0, -kHalfStance, 0},
    {"RightKnee", 14, 0, 0, -kBone},
    {"RightAnkle", 15, 0, 0, -kBone},
    {"RightToe", 16, 0.16, 0, -0.9 * kAnkleHeight},
    {"LeftHip", 0, 0, kHalfStance, 0},
    {"LeftKnee", 18, 0, 0, -kBone},
    {"LeftAnkle", 19, 0, 0, -kBone},
    {"LeftToe", 20, 0.16, 0, -0.9 * kAnkleHeight},
}};

// The order of rotations that each leg joint's pose is a product of, so that the channels are the
// angles themselves: hip Rx(phi) Ry(theta - bend), knee Ry(2 bend), ankle Ry(..) Rx(-phi).
std::vector<BvhChannel> LegChannels(bool is_thigh, bool with_position) {
  std::vector<BvhChannel> channels;
  if (with_position) {
    channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  }
  const BvhChannel x = BvhChannel::kXrotation, y = BvhChannel::kYrotation;
  channels.push_back(is_thigh ? x : y);
  channels.push_back(is_thigh ? y : x);
  channels.push_back(BvhChannel::kZrotation);
  return channels;
}

double Degrees(double radians) { return radians * 180.0 / M_PI; }

Eigen::Matrix3d RotationXY(double about_x, double about_y) {
  return (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

}  // namespace

// A leg of two equal bones, each tilted by `bend` against the rod: 2 bone cos(bend) = rod.
SyntheticSkeleton::SyntheticSkeleton(double rod_length)
    : rod_(rod_length), bone_(kBone * rod_length), bend_(std::acos(0.5 / kBone)) {}

double SyntheticSkeleton::cart_height() const { return kAnkleHeight * rod_; }

Eigen::Vector3d SyntheticSkeleton::HalfStance() const { return {0.0, kHalfStance * rod_, 0.0}; }

BvhSkeleton SyntheticSkeleton::Bvh(LengthUnit unit) const {
  BvhSkeleton skeleton;
  for (int j = 0; j < kSkeletonJoints; ++j) {
    const JointShape& shape = kShapes[j];
    BvhJoint joint;
    joint.name = shape.name;
    joint.parent = shape.parent;
    const double scale = ConvertLength(rod_, LengthUnit::kMetre, unit);
    joint.offset = scale * Eigen::Vector3d(shape.x, shape.y, shape.z);
    const bool is_leg = j >= 14 && j != 17 && j != 21;
    const bool is_ankle = j == kRightAnkleJoint || j == kLeftAnkleJoint;
    joint.channels =
        is_leg ? LegChannels(j == 14 || j == 18, is_ankle) : DefaultBvhChannels(j == kHipJoint);
    const bool is_leaf = j + 1 == kSkeletonJoints || kShapes[j + 1].parent != j;
    if (is_leaf) joint.end_sites = {scale * Eigen::Vector3d(0.03, 0.0, 0.0)};
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

void SyntheticSkeleton::AppendFrame(const SkeletonPose& pose, LengthUnit unit,
                                    std::vector<double>* values) const {
  const auto append = [&](const Eigen::Vector3d& v) {
    values->insert(values->end(), v.data(), v.data() + 3);
  };
  const auto position = [&](const Eigen::Vector3d& metres) {
    for (double value : {metres.x(), metres.y(), metres.z()}) {
      values->push_back(ConvertLength(value, LengthUnit::kMetre, unit));
    }
  };
  const Eigen::Matrix3d thigh = RotationXY(pose.phi, pose.theta - bend_);
  const Eigen::Matrix3d shank = RotationXY(pose.phi, pose.theta + bend_);
  const Eigen::Vector3d bone(0.0, 0.0, -bone_);

  position(pose.hip);
  for (int j = kHipJoint; j < 14; ++j) append(Eigen::Vector3d::Zero());
  for (const bool left : {false, true}) {
    const Eigen::Vector3d hip_joint = pose.hip + (left ? 1.0 : -1.0) * HalfStance();
    const Eigen::Vector3d knee = hip_joint + thigh * bone;
    const Eigen::Vector3d& ankle = left ? pose.left_ankle : pose.right_ankle;
    append({Degrees(pose.phi), Degrees(pose.theta - bend_), 0.0});
    append({Degrees(2.0 * bend_), 0.0, 0.0});
    position(shank.transpose() * (ankle - knee));
    append({Degrees(-pose.theta - bend_), Degrees(-pose.phi), 0.0});
    append(Eigen::Vector3d::Zero());  // toe
  }
}

}  // namespace pushid
