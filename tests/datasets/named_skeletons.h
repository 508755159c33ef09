// A standing person in the skeletons that other programs write: the same body under their names,
// for tests of roles.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "datasets/formats/bvh.h"

namespace pushid {

struct NamedJoint {
  const char* name;
  int parent;
  Eigen::Vector3d place;  // m, z up, facing +x, standing
};

// CMU's BVH files: joints without length beside the hip, a thumb, and toes.
inline std::vector<NamedJoint> CmuSkeleton() {
  return {{"Hips", -1, {0, 0, 1.0}},
          {"LHipJoint", 0, {0, 0, 1.0}},
          {"LeftUpLeg", 1, {0, 0.09, 0.93}},
          {"LeftLeg", 2, {0.02, 0.1, 0.5}},
          {"LeftFoot", 3, {0, 0.1, 0.09}},
          {"LeftToeBase", 4, {0.15, 0.11, 0.02}},
          {"RHipJoint", 0, {0, 0, 1.0}},
          {"RightUpLeg", 6, {0, -0.09, 0.93}},
          {"RightLeg", 7, {0.02, -0.1, 0.5}},
          {"RightFoot", 8, {0, -0.1, 0.09}},
          {"RightToeBase", 9, {0.15, -0.11, 0.02}},
          {"LowerBack", 0, {0, 0, 1.0}},
          {"Spine", 11, {0, 0, 1.12}},
          {"Spine1", 12, {0, 0, 1.26}},
          {"Neck", 13, {0, 0, 1.4}},
          {"Neck1", 14, {0.01, 0, 1.45}},
          {"Head", 15, {0.02, 0, 1.53}},
          {"LeftShoulder", 13, {0, 0.02, 1.38}},
          {"LeftArm", 17, {0, 0.17, 1.38}},
          {"LeftForeArm", 18, {0, 0.19, 1.1}},
          {"LeftHand", 19, {0.03, 0.2, 0.85}},
          {"LThumb", 20, {0.06, 0.2, 0.82}},
          {"RightShoulder", 13, {0, -0.02, 1.38}},
          {"RightArm", 22, {0, -0.17, 1.38}},
          {"RightForeArm", 23, {0, -0.19, 1.1}},
          {"RightHand", 24, {0.03, -0.2, 0.85}}};
}

// Xsens' BVH: four joints of the chest, collars.
inline std::vector<NamedJoint> XsensSkeleton() {
  return {{"Hips", -1, {0, 0, 1.0}},
          {"Chest", 0, {0, 0, 1.1}},
          {"Chest2", 1, {0, 0, 1.17}},
          {"Chest3", 2, {0, 0, 1.24}},
          {"Chest4", 3, {0, 0, 1.31}},
          {"Neck", 4, {0, 0, 1.45}},
          {"Head", 5, {0.02, 0, 1.53}},
          {"RightCollar", 4, {0, -0.02, 1.4}},
          {"RightShoulder", 7, {0, -0.17, 1.4}},
          {"RightElbow", 8, {0, -0.2, 1.1}},
          {"RightWrist", 9, {0.03, -0.2, 0.85}},
          {"LeftCollar", 4, {0, 0.02, 1.4}},
          {"LeftShoulder", 11, {0, 0.17, 1.4}},
          {"LeftElbow", 12, {0, 0.2, 1.1}},
          {"LeftWrist", 13, {0.03, 0.2, 0.85}},
          {"RightHip", 0, {0, -0.09, 0.93}},
          {"RightKnee", 15, {0.02, -0.1, 0.5}},
          {"RightAnkle", 16, {0, -0.1, 0.09}},
          {"RightToe", 17, {0.15, -0.11, 0.02}},
          {"LeftHip", 0, {0, 0.09, 0.93}},
          {"LeftKnee", 19, {0.02, 0.1, 0.5}},
          {"LeftAnkle", 20, {0, 0.1, 0.09}},
          {"LeftToe", 21, {0.15, 0.11, 0.02}}};
}

// A game's: one joint of the spine, no clavicles, neither neck nor toes, and a root on the floor.
inline std::vector<NamedJoint> PlainSkeleton() {
  return {{"rig:Root", -1, {0, 0, 0}},          {"rig:Hips", 0, {0, 0, 1.0}},
          {"rig:Spine", 1, {0, 0, 1.2}},        {"rig:Head", 2, {0, 0, 1.6}},
          {"rig:arm.L", 2, {0, 0.2, 1.4}},      {"rig:forearm.L", 4, {0, 0.2, 1.1}},
          {"rig:hand.L", 5, {0, 0.2, 0.85}},    {"rig:arm.R", 2, {0, -0.2, 1.4}},
          {"rig:forearm.R", 7, {0, -0.2, 1.1}}, {"rig:hand.R", 8, {0, -0.2, 0.85}},
          {"rig:thigh.L", 1, {0, 0.1, 0.9}},    {"rig:shin.L", 10, {0, 0.1, 0.5}},
          {"rig:foot.L", 11, {0, 0.1, 0.1}},    {"rig:thigh.R", 1, {0, -0.1, 0.9}},
          {"rig:shin.R", 13, {0, -0.1, 0.5}},   {"rig:foot.R", 14, {0, -0.1, 0.1}}};
}

inline std::vector<std::string> NamesOf(const std::vector<NamedJoint>& joints) {
  std::vector<std::string> names;
  for (const NamedJoint& joint : joints) names.push_back(joint.name);
  return names;
}

// With y up and z forward as those programs have it, lengths in `metres_per_unit`; leaves end a
// little further on. Channels are Zrotation Xrotation Yrotation.
inline BvhSkeleton BvhOf(const std::vector<NamedJoint>& joints, double metres_per_unit = 1.0) {
  BvhSkeleton skeleton;
  for (const NamedJoint& named : joints) {
    BvhJoint joint;
    joint.name = named.name;
    joint.parent = named.parent;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    if (named.parent >= 0) offset = named.place - joints[named.parent].place;
    joint.offset = Eigen::Vector3d(offset.y(), offset.z(), offset.x()) / metres_per_unit;
    if (named.parent < 0) {
      joint.channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
    }
    joint.channels.insert(joint.channels.end(),
                          {BvhChannel::kZrotation, BvhChannel::kXrotation, BvhChannel::kYrotation});
    skeleton.joints.push_back(joint);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const bool leaf = j + 1 == joints.size() || joints[j + 1].parent != static_cast<int>(j);
    if (leaf) skeleton.joints[j].end_sites = {Eigen::Vector3d(0, 0.05, 0) / metres_per_unit};
  }
  return skeleton;
}

// Standing still while the root goes where `roots` says (z up), its joints turned by `turn_degrees`
// about the first channel in every frame.
inline BvhMotion MotionOf(const std::vector<NamedJoint>& joints,
                          const std::vector<Eigen::Vector3d>& roots, double metres_per_unit = 1.0,
                          double turn_degrees = 0.0) {
  BvhMotion motion;
  motion.frame_time_s = 1.0 / 60.0;
  motion.skeleton = BvhOf(joints, metres_per_unit);
  for (const Eigen::Vector3d& root : roots) {
    for (double value : {root.y(), root.z(), root.x()}) {
      motion.values.push_back(value / metres_per_unit);
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
      motion.values.insert(motion.values.end(), {j == 0 ? 0.0 : turn_degrees, 0.0, 0.0});
    }
  }
  return motion;
}

}  // namespace pushid
