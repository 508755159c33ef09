// ident: bodies written.
#include "ident/bodies/body_files.h"

#include <cmath>
#include <cstdio>

#include "datasets/files/atomic_file.h"
#include "models/restoration/skeleton_fit.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;
constexpr double kMillimetres = 1000.0;  // per m

// Angles of R = Rz(a) Ry(b) Rx(c), degrees, in the order of the channels.
Eigen::Vector3d EulerZyx(const Eigen::Matrix3d& r) {
  const double b = std::asin(std::min(1.0, std::max(-1.0, -r(2, 0))));
  Eigen::Vector3d angles(0.0, b, 0.0);
  if (std::abs(r(2, 0)) < 1.0 - 1e-12) {
    angles[0] = std::atan2(r(1, 0), r(0, 0));
    angles[2] = std::atan2(r(2, 1), r(2, 2));
  } else {  // straight up or down: only a - c (or a + c) matters
    angles[0] = std::atan2(-r(0, 1), r(1, 1));
  }
  return angles * (180.0 / M_PI);
}

// "out/motion.bvh" and 2, "X-16": "out/motion_2_X-16.bvh".
std::string PersonsFile(const std::string& path, int person, const std::string& subject) {
  const size_t slash = path.find_last_of('/');
  size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) dot = path.size();
  std::string name = subject;
  for (char& c : name) c = c == '/' ? '_' : c;
  return path.substr(0, dot) + "_" + std::to_string(person) + "_" + name + path.substr(dot);
}

}  // namespace

std::vector<std::string> DefaultJointNames() {
  return {"Hips",         "Spine",         "Spine1",        "Spine2",     "Neck",
          "Head",         "RightClavicle", "RightShoulder", "RightElbow", "RightWrist",
          "LeftClavicle", "LeftShoulder",  "LeftElbow",     "LeftWrist",  "RightHip",
          "RightKnee",    "RightAnkle",    "RightToe",      "LeftHip",    "LeftKnee",
          "LeftAnkle",    "LeftToe"};
}

BvhMotion ToBvh(const BodyMotion& motion, const std::vector<std::string>& joint_names, double dt) {
  const Pose& rest = motion.front();
  BvhMotion bvh;
  bvh.length_unit = kUnit;
  bvh.frame_time_s = dt;
  for (int j = 0; j < kBodyJoints; ++j) {
    BvhJoint joint;
    joint.name = joint_names[j];
    joint.parent = kBodyParents[j];
    if (j > 0) joint.offset = kMillimetres * (rest.col(j) - rest.col(joint.parent));
    joint.channels = DefaultBvhChannels(j == 0);
    bvh.skeleton.joints.push_back(std::move(joint));
  }
  for (const Pose& pose : motion) {
    const PosedSkeleton posed = FitSkeleton(rest, pose);
    for (int i = 0; i < 3; ++i) bvh.values.push_back(kMillimetres * pose(i, 0));
    for (int j = 0; j < kBodyJoints; ++j) {
      const Eigen::Matrix3d local =
          j == 0
              ? posed.rotations[0]
              : Eigen::Matrix3d(posed.rotations[kBodyParents[j]].transpose() * posed.rotations[j]);
      const Eigen::Vector3d angles = EulerZyx(local);
      bvh.values.insert(bvh.values.end(), angles.data(), angles.data() + 3);
    }
  }
  return bvh;
}

Result<std::vector<std::string>> WriteBodyBvh(const std::string& path, const BodyScene& scene) {
  std::vector<std::string> files;
  for (int n = 0; n < scene.num_people(); ++n) {
    files.push_back(scene.num_people() == 1 ? path : PersonsFile(path, n, scene.subject_ids[n]));
    const BvhMotion bvh = ToBvh(scene.bodies[n], scene.joint_names, scene.dt);
    if (MaybeError error = WriteBvh(files.back(), bvh, kUnit)) return *error;
  }
  return files;
}

MaybeError WriteJointsCsv(const std::string& path, const BodyScene& scene) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append("frame,time_s,person,subject,joint,x_m,y_m,z_m\n");
  char row[256];
  for (int t = 0; t < scene.num_frames(); ++t) {
    for (int n = 0; n < scene.num_people(); ++n) {
      for (int j = 0; j < kBodyJoints; ++j) {
        const Eigen::Vector3d p = scene.bodies[n][t].col(j);
        std::snprintf(row, sizeof row, "%d,%.9g,%d,%s,%s,%.6f,%.6f,%.6f\n", t, t * scene.dt, n,
                      scene.subject_ids[n].c_str(), scene.joint_names[j].c_str(), p.x(), p.y(),
                      p.z());
        file.Append(row);
      }
    }
  }
  return file.Commit();
}

nlohmann::ordered_json ToJson(const BodyScene& scene) {
  nlohmann::ordered_json json = {{"id", scene.id},
                                 {"dt_s", scene.dt},
                                 {"joint_names", scene.joint_names},
                                 {"joint_parents", kBodyParents}};
  json["people"] = nlohmann::ordered_json::array();
  for (int n = 0; n < scene.num_people(); ++n) {
    nlohmann::ordered_json frames = nlohmann::ordered_json::array();
    for (const Pose& pose : scene.bodies[n]) {
      nlohmann::ordered_json joints = nlohmann::ordered_json::array();
      for (int j = 0; j < kBodyJoints; ++j) {
        nlohmann::ordered_json place = nlohmann::ordered_json::array();
        for (int i = 0; i < 3; ++i) place.push_back(std::round(pose(i, j) * 1e5) / 1e5);
        joints.push_back(place);
      }
      frames.push_back(joints);
    }
    json["people"].push_back({{"subject", scene.subject_ids[n]}, {"joints_m", frames}});
  }
  return json;
}

}  // namespace pushid
