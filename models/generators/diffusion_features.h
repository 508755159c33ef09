// models: a group of people as the diffusion network sees them, and back.
//
//   motion    66 rows: hip(t) - hip(0), then (joint - hip)(t) - (joint - hip)(0), each over the
//             joint's scale; no rotation is taken out: all face the way of the push
//             or, in people's own frames (SDM): hip(t) - hip(0), joint - hip turned to face +x, and
//             cosine and sine of where they face, each to zero mean and unit variance
//   given     a row of each: the observed motion (0 where nothing was seen), 1 where it was, the
//             push on the group over 10 m of the pushed, and where physics have the hip
//   statics   of a person: joints seen from the hip at frame 0, to half of unit variance, place
//             seen from the pushed, height of the hip above 1 m, mass over 80 kg less 1, whether
//             pushed, the push's impulse per mass, its length
//
// Columns of motion and given: the frames of the first person, then those of the next.
#pragma once

#include <vector>

#include "models/generators/motion_generator.h"
#include "models/restoration/body.h"
#include "models/restoration/dense_network.h"

namespace pushid {

inline constexpr int kMotionRows = 3 * kBodyJoints;
inline constexpr int kPushRows = 4;
inline constexpr int kFirstPoseRows = 3 * (kBodyJoints - 1);
inline constexpr int kStaticRows = kFirstPoseRows + 2 + 1 + 1 + 1 + kPushRows + 1;
inline constexpr int kOwnFrameRows = kMotionRows + 2;
inline int GivenRows(int motion_rows = kMotionRows) { return motion_rows + 1 + kPushRows; }

// m, by joint: what a unit of a motion's row is.
using JointScales = Eigen::Matrix<float, kBodyJoints, 1>;
JointScales JointScalesOf(const std::vector<std::vector<ObservedMotion>>& groups);

// What a unit of a motion's row is, and in which frame rows are.
struct MotionScales {
  MotionScales() = default;
  // Of the group's frame.
  template <typename OfJoints>
  MotionScales(const Eigen::MatrixBase<OfJoints>& of_joints) : joints(of_joints) {}

  JointScales joints = JointScales::Ones();
  // Of joints seen from the hip at frame 0.
  Scaling first_pose = {Eigen::VectorXf::Zero(kFirstPoseRows),
                        Eigen::VectorXf::Ones(kFirstPoseRows)};
  Eigen::VectorXf mean, spread;  // of people's own frames, kOwnFrameRows; otherwise empty

  bool own_frames() const { return mean.size() > 0; }
  int rows() const { return own_frames() ? kOwnFrameRows : kMotionRows; }
};
Scaling FirstPoseScalingOf(const std::vector<std::vector<ObservedMotion>>& groups);
// Mean and standard deviation of every row over all frames and people of the groups.
MotionScales OwnFrameScalesOf(const std::vector<std::vector<ObservedMotion>>& groups);

struct GroupFeatures {
  int people = 0, frames = 0;
  Eigen::MatrixXf given;    // GivenRows x (people * frames)
  Eigen::MatrixXf statics;  // kStaticRows x people
  Eigen::Matrix2Xf places;  // m
};

// observed: the frames of each person that are shown, frames: of the whole motion. The push is that
// of all people together.
GroupFeatures FeaturesOf(const std::vector<ObservedMotion>& group, const MotionScales& scales,
                         int observed, int frames, double dt);

Eigen::MatrixXf MotionRows(const ObservedMotion& person, const MotionScales& scales);
// The motion that begins as the person's does.
Trajectories FromMotionRows(const Eigen::MatrixXf& rows, const ObservedMotion& person,
                            const MotionScales& scales);

// A group as it may as well have been: in the mirror, turned about z, of another size.
struct GroupChange {
  bool mirrored = false;
  double turn = 0.0;  // rad
  double size = 1.0;
};
std::vector<ObservedMotion> Changed(const std::vector<ObservedMotion>& group,
                                    const GroupChange& change);

// Pushed harder or less; what they do stays.
std::vector<ObservedMotion> PushedBy(std::vector<ObservedMotion> group, double factor);

}  // namespace pushid
