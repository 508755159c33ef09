// datasets: BVH (Biovision Hierarchy) motion files, read and written.
//
// Conventions, per joint and frame:
//   - local translation: the OFFSET, expressed in the parent's frame. Where a joint has position
//     channels, each of them REPLACES its component of the OFFSET. That is what Blender,
//     MotionBuilder exports with six channels per joint and the LAFAN1 tools mean; adding the two
//     (three.js) counts such offsets twice. For a root at OFFSET 0 both agree.
//   - local rotation: R = R1 R2 R3 of the rotation channels in the order listed, degrees.
//   - world: p_joint = p_parent + R_parent t_joint, R_joint = R_parent R_local. Translation
//   precedes
//     rotation wherever the position channels stand in the list.
//
//   Result<PointMotion> p = ReadBvhPoints("walk.bvh");  // of all joints
//   MaybeError failed = WriteBvh("copy.bvh", motion);
//
// The readers are strict: a truncated file, a row too many or too few, a number that is not one,
// NaN, infinity, an unknown channel or a duplicate name is an Error with file and line.
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/formats/point_motion.h"
#include "models/enum_names.h"

namespace pushid {

// Channels are in the order of their letters, so that the axis is the value modulo three.
enum class BvhChannel { kXposition, kYposition, kZposition, kXrotation, kYrotation, kZrotation };

inline bool IsRotation(BvhChannel channel) { return channel >= BvhChannel::kXrotation; }
inline int AxisOf(BvhChannel channel) { return static_cast<int>(channel) % 3; }  // 0 x, 1 y, 2 z

constexpr EnumNames<BvhChannel, 6> Names(BvhChannel) {
  return {{{"Xposition", BvhChannel::kXposition},
           {"Yposition", BvhChannel::kYposition},
           {"Zposition", BvhChannel::kZposition},
           {"Xrotation", BvhChannel::kXrotation},
           {"Yrotation", BvhChannel::kYrotation},
           {"Zrotation", BvhChannel::kZrotation}}};
}

// The usual channels: Zrotation Yrotation Xrotation, for a root after Xposition Yposition
// Zposition.
std::vector<BvhChannel> DefaultBvhChannels(bool with_position);

struct BvhJoint {
  std::string name;
  int parent = -1;                                   // index of an earlier joint; -1 for a root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // in the file's lengths
  std::vector<BvhChannel> channels;                  // in the order of the numbers in a row
  std::vector<Eigen::Vector3d> end_sites;            // one for a leaf, as a rule
};

// Joints in file order: depth first, so every parent precedes its children. Names are unique.
struct BvhSkeleton {
  std::vector<BvhJoint> joints;

  int num_channels() const;
  int Find(const std::string& name) const;  // index of the joint, or -1
  std::vector<std::string> Names() const;
};

// A BVH file as it stands: lengths in a unit that it does not say, angles in degrees.
struct BvhMotion {
  BvhSkeleton skeleton;
  double frame_time_s = 0.0;
  std::vector<double> values;  // frame-major: num_channels() per frame, in file order

  int num_frames() const;
};

// Seconds; no row is read.
Result<double> ReadBvhFrameTime(const std::string& path);

// The joints as points, in the file's lengths; the skeleton is kept beside them. Reads row by row
// and keeps nothing but what is chosen: 24 bytes per joint and frame whatever the file's size.
Result<PointMotion> ReadBvhPoints(const std::string& path, const PointReadOptions& options = {});

// Writes `motion` as it stands, atomically. Numbers are the shortest that read back to the same
// double. A wrong number of values, NaN, no frames or a frame time out of range is an Error; the
// hierarchy is taken as right, parents before their children and names unique, as the reader and
// every maker of one have it. A leaf without an end site gets one at its own place, which other
// programs insist on.
MaybeError WriteBvh(const std::string& path, const BvhMotion& motion);

// Forward kinematics of a BVH skeleton: world positions from one row of channel values.
// The conventions are those of bvh.h.

// rotation <- rotation * R1 R2 R3 of the joint's rotation channels, `values` being those of all its
// channels.
void RotateByChannels(const BvhJoint& joint, const double* values, Eigen::Matrix3d* rotation);

// The angles of the joint's rotation channels that turn it by `rotation`, degrees; `values` are
// those of all its channels, of which the positions stay. The joint has all three axes.
void SetRotationChannels(const BvhJoint& joint, const Eigen::Matrix3d& rotation, double* values);

// Computes only what the chosen joints need: their ancestors, and the rotations of those.
class BvhKinematics {
 public:
  // `joints` are valid indices into the skeleton, in the order of the output.
  BvhKinematics(const BvhSkeleton& skeleton, double metres_per_unit, std::vector<int> joints);

  // `row` holds num_channels() values (file lengths, degrees); writes one position per chosen
  // joint, metres. Not const: the work space belongs to the object.
  void Positions(const double* row, Eigen::Vector3d* positions);

  // The values of a row that they depend on.
  std::vector<bool> UsedValues() const;

 private:
  struct Step {
    int joint = 0;
    int parent = -1;
    bool rotates_something = false;  // a joint further down needs its rotation
    int first_channel = 0;           // index of the joint's first value in a row
  };

  const BvhSkeleton skeleton_;
  const double metres_per_unit_;
  const std::vector<int> joints_;
  std::vector<Step> steps_;  // needed joints, parents first
  std::vector<Eigen::Vector3d> world_position_;
  std::vector<Eigen::Matrix3d> world_rotation_;
};

}  // namespace pushid
