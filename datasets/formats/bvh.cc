// datasets: BVH motions as data, and their forward kinematics.
#include "datasets/formats/bvh.h"

#include <cmath>
#include <utility>

namespace pushid {

std::vector<BvhChannel> DefaultBvhChannels(bool with_position) {
  std::vector<BvhChannel> channels;
  if (with_position) {
    channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  }
  channels.insert(channels.end(),
                  {BvhChannel::kZrotation, BvhChannel::kYrotation, BvhChannel::kXrotation});
  return channels;
}

int BvhSkeleton::num_channels() const {
  std::size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return static_cast<int>(count);
}

std::vector<std::string> BvhSkeleton::Names() const {
  std::vector<std::string> names;
  for (const BvhJoint& joint : joints) names.push_back(joint.name);
  return names;
}

int BvhSkeleton::Find(const std::string& name) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

int BvhMotion::num_frames() const {
  const int channels = skeleton.num_channels();
  return channels > 0 ? static_cast<int>(values.size() / channels) : 0;
}

namespace {

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;
constexpr double kUpright = 1e-9;  // the cosine below which the second angle is 90 degrees

// R <- R * R_axis(angle): only two columns change, e.g. for x: y' = c y + s z, z' = c z - s y.
void RotateAbout(int axis, double radians, Eigen::Matrix3d* rotation) {
  const double c = std::cos(radians), s = std::sin(radians);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Eigen::Vector3d column_i = rotation->col(i), column_j = rotation->col(j);
  rotation->col(i) = c * column_i + s * column_j;
  rotation->col(j) = c * column_j - s * column_i;
}

}  // namespace

void RotateByChannels(const BvhJoint& joint, const double* values, Eigen::Matrix3d* rotation) {
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    const BvhChannel channel = joint.channels[i];
    if (IsRotation(channel)) {
      RotateAbout(AxisOf(channel), values[i] * kRadiansPerDegree, rotation);
    }
  }
}

// R = R_i(a) R_j(b) R_k(c) with e = 1 where i, j, k are cyclic and -1 otherwise: R_ik = e sin b,
// R_ii = cos b cos c, R_ij = -e cos b sin c, R_jk = -e sin a cos b, R_kk = cos a cos b. At b = +-90
// degrees only one turn is left of a and c, and a takes it.
void SetRotationChannels(const BvhJoint& joint, const Eigen::Matrix3d& rotation, double* values) {
  std::vector<int> places;
  for (std::size_t c = 0; c < joint.channels.size(); ++c) {
    if (IsRotation(joint.channels[c])) places.push_back(static_cast<int>(c));
  }
  const int i = AxisOf(joint.channels[places[0]]), j = AxisOf(joint.channels[places[1]]),
            k = AxisOf(joint.channels[places[2]]);
  const double e = j == (i + 1) % 3 ? 1.0 : -1.0;
  const double cos_b = std::hypot(rotation(i, i), rotation(i, j));
  double a = 0.0, c = 0.0;
  if (cos_b > kUpright) {
    a = std::atan2(-e * rotation(j, k), rotation(k, k));
    c = std::atan2(-e * rotation(i, j), rotation(i, i));
  } else {
    a = std::atan2(e * rotation(k, j), rotation(j, j));
  }
  const double angles[] = {a, std::atan2(e * rotation(i, k), cos_b), c};
  for (int n = 0; n < 3; ++n) values[places[n]] = angles[n] / kRadiansPerDegree;
}

BvhKinematics::BvhKinematics(const BvhSkeleton& skeleton, double metres_per_unit,
                             std::vector<int> joints)
    : skeleton_(skeleton),
      metres_per_unit_(metres_per_unit),
      joints_(std::move(joints)),
      world_position_(skeleton.joints.size()),
      world_rotation_(skeleton.joints.size()) {
  const int count = static_cast<int>(skeleton_.joints.size());
  std::vector<bool> needed(count, false), rotates(count, false);
  for (int joint : joints_) needed[joint] = true;
  for (int joint = count - 1; joint >= 0; --joint) {
    const int parent = skeleton_.joints[joint].parent;
    if (needed[joint] && parent >= 0) needed[parent] = rotates[parent] = true;
  }
  int first_channel = 0;
  for (int joint = 0; joint < count; ++joint) {
    if (needed[joint]) {
      steps_.push_back({joint, skeleton_.joints[joint].parent, rotates[joint], first_channel});
    }
    first_channel += static_cast<int>(skeleton_.joints[joint].channels.size());
  }
}

void BvhKinematics::Positions(const double* row, Eigen::Vector3d* positions) {
  for (const Step& step : steps_) {
    const BvhJoint& joint = skeleton_.joints[step.joint];
    const double* values = row + step.first_channel;
    Eigen::Matrix3d& rotation = world_rotation_[step.joint];
    if (step.parent >= 0) {
      rotation = world_rotation_[step.parent];
    } else {
      rotation.setIdentity();
    }
    Eigen::Vector3d translation = joint.offset;
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const BvhChannel channel = joint.channels[i];
      if (!IsRotation(channel)) translation[AxisOf(channel)] = values[i];
    }
    world_position_[step.joint] = rotation * translation;
    if (step.parent >= 0) world_position_[step.joint] += world_position_[step.parent];
    if (!step.rotates_something) continue;
    RotateByChannels(joint, values, &rotation);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    positions[i] = metres_per_unit_ * world_position_[joints_[i]];
  }
}

}  // namespace pushid
