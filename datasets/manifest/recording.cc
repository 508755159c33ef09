// datasets: roles to poses.
#include "datasets/manifest/recording.h"

#include <Eigen/Geometry>

#include "datasets/files/names.h"

namespace pushid {
namespace {

// Means over 67 people of the published recordings.
constexpr double kHeadPerNeck = 0.66;                        // neck to head, of upper spine to neck
constexpr double kToeAhead = 0.42, kToeBelow = 0.18;         // of the shank
constexpr double kAside = 0.36, kBack = 0.19, kDown = 0.30;  // Bell et al., of the pelvis' width

// Roles that are lacking and that neighbours fill, or that they do not.
std::vector<int> Lacking(const BodyRoles& roles, bool filled) {
  const bool pelvis = !roles.left_asis.empty() && !roles.right_asis.empty() && !roles.back.empty();
  std::vector<int> lacking;
  for (int role = 0; role < kBodyJoints; ++role) {
    const bool hip = role == kRightHip || role == kLeftHip;
    const bool trunk = role > kBodyHip && role <= kBodyHead;
    const bool end =
        role == kRightClavicle || role == kLeftClavicle || role == kRightToe || role == kLeftToe;
    const bool fills = trunk || end || (hip && pelvis);
    if (!roles.Has(role) && fills == filled) lacking.push_back(role);
  }
  return lacking;
}

Eigen::Vector3d Mean(const std::vector<int>& list, const std::vector<Eigen::Vector3d>& joints) {
  Eigen::Vector3d mean = joints[list[0]];
  for (std::size_t i = 1; i < list.size(); ++i) mean += joints[list[i]];
  return mean / static_cast<double>(list.size());
}

// Fills what is lacking of hip, spine, neck and head.
void FillTrunk(const BodyRoles& roles, Pose* pose) {
  const bool head = roles.Has(kBodyHead);
  bool known[kBodyHead + 1];
  for (int role = 0; role <= kBodyHead; ++role) known[role] = roles.Has(role);
  if (!head && !known[kNeck]) {
    pose->col(kNeck) = 0.5 * (pose->col(kRightShoulder) + pose->col(kLeftShoulder));
    known[kNeck] = true;
  }
  const int top = head ? kBodyHead : kNeck;
  for (int below = 0; below < top;) {
    int above = below + 1;
    while (!known[above]) ++above;
    for (int role = below + 1; role < above; ++role) {
      const double part = static_cast<double>(role - below) / (above - below);
      pose->col(role) = (1.0 - part) * pose->col(below) + part * pose->col(above);
    }
    below = above;
  }
  if (!head) {
    pose->col(kBodyHead) =
        pose->col(kNeck) + kHeadPerNeck * (pose->col(kNeck) - pose->col(kUpperSpine));
  }
}

void FillHipJoints(const BodyRoles& roles, const std::vector<Eigen::Vector3d>& joints, Pose* pose) {
  const Eigen::Vector3d left = Mean(roles.left_asis, joints),
                        right = Mean(roles.right_asis, joints);
  const Eigen::Vector3d middle = 0.5 * (left + right);
  const double width = (left - right).norm();
  const Eigen::Vector3d aside = (left - right).normalized();
  Eigen::Vector3d back = Mean(roles.back, joints) - middle;
  back = (back - aside.dot(back) * aside).normalized();
  const Eigen::Vector3d down = back.cross(aside).normalized();
  for (const bool is_left : {true, false}) {
    const int role = is_left ? kLeftHip : kRightHip;
    if (roles.Has(role)) continue;
    pose->col(role) =
        middle + width * ((is_left ? kAside : -kAside) * aside + kBack * back + kDown * down);
  }
}

void FillToe(int toe, Pose* pose) {
  const double shank = (pose->col(toe - 2) - pose->col(toe - 1)).norm();
  Eigen::Vector3d left = pose->col(kLeftHip) - pose->col(kRightHip);
  left.z() = 0.0;
  const Eigen::Vector3d forward = left.normalized().cross(Eigen::Vector3d::UnitZ());
  pose->col(toe) =
      pose->col(toe - 1) + shank * (kToeAhead * forward - kToeBelow * Eigen::Vector3d::UnitZ());
}

}  // namespace

const std::vector<std::string>& RoleNames() {
  static const std::vector<std::string> names = {
      "hip",           "lower_spine",    "middle_spine",   "upper_spine", "neck",
      "head",          "right_clavicle", "right_shoulder", "right_elbow", "right_wrist",
      "left_clavicle", "left_shoulder",  "left_elbow",     "left_wrist",  "right_hip",
      "right_knee",    "right_ankle",    "right_toe",      "left_hip",    "left_knee",
      "left_ankle",    "left_toe"};
  return names;
}

std::vector<int> UnfilledRoles(const BodyRoles& roles) { return Lacking(roles, false); }
std::vector<int> FilledRoles(const BodyRoles& roles) { return Lacking(roles, true); }

std::string RoleList(const std::vector<int>& roles) {
  std::vector<std::string> names;
  for (int role : roles) names.push_back(RoleName(role));
  return ListOfNames(names);
}

Pose PoseOf(const BodyRoles& roles, const std::vector<Eigen::Vector3d>& joints) {
  Pose pose = Pose::Zero();
  for (int role = 0; role < kBodyJoints; ++role) {
    if (roles.Has(role)) pose.col(role) = Mean(roles.joints[role], joints);
  }
  if (FilledRoles(roles).empty()) return pose;
  FillTrunk(roles, &pose);
  if (!roles.Has(kLeftHip) || !roles.Has(kRightHip)) FillHipJoints(roles, joints, &pose);
  for (int shoulder : {static_cast<int>(kRightShoulder), static_cast<int>(kLeftShoulder)}) {
    const int clavicle = shoulder - 1;
    if (roles.Has(clavicle)) continue;
    pose.col(clavicle) = 0.5 * (pose.col(kUpperSpine) + pose.col(shoulder));
  }
  for (int toe : {static_cast<int>(kRightToe), static_cast<int>(kLeftToe)}) {
    if (!roles.Has(toe)) FillToe(toe, &pose);
  }
  return pose;
}

}  // namespace pushid
