// ident: bodies written.
#include "ident/bodies/body_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

// The skeleton's rest as a hierarchy of its own.
FileSkeleton RestHierarchy(const BodySkeleton& skeleton) {
  FileSkeleton file;
  file.metres_per_unit = MetresPer(kUnit);
  for (int j = 0; j < skeleton.num_joints(); ++j) {
    BvhJoint joint;
    joint.name = skeleton.names[j];
    joint.parent = skeleton.parents[j];
    if (joint.parent >= 0) {
      joint.offset =
          (skeleton.rest.col(j) - skeleton.rest.col(joint.parent)) / file.metres_per_unit;
    }
    joint.channels = DefaultBvhChannels(joint.parent < 0);
    file.bvh.joints.push_back(std::move(joint));
  }
  file.values.assign(file.bvh.num_channels(), 0.0);
  return file;
}

// Gives a joint what it needs to turn (and a root to move) in all three axes; a new channel has the
// value that changes nothing.
void AddChannels(bool turns, BvhJoint* joint, std::vector<double>* values) {
  for (const BvhChannel channel : DefaultBvhChannels(joint->parent < 0)) {
    if (IsRotation(channel) && !turns) continue;
    const auto begin = joint->channels.begin(), end = joint->channels.end();
    if (std::find(begin, end, channel) != end) continue;
    // Positions stand before rotations, and what a file has keeps its order.
    const auto first_rotation = std::find_if(begin, end, IsRotation);
    const auto place = (IsRotation(channel) ? end : first_rotation) - begin;
    joint->channels.insert(begin + place, channel);
    values->insert(values->begin() + place,
                   IsRotation(channel) ? 0.0 : joint->offset[AxisOf(channel)]);
  }
}

// Frames of one person in a hierarchy.
class HierarchyMotion {
 public:
  explicit HierarchyMotion(const BodySkeleton& skeleton)
      : skeleton_(skeleton), file_(skeleton.file ? *skeleton.file : RestHierarchy(skeleton)) {
    const double* given = file_.values.data();
    for (int j = 0; j < skeleton.num_joints(); ++j) {
      BvhJoint& joint = file_.bvh.joints[j];
      std::vector<double> values(given, given + joint.channels.size());
      given += joint.channels.size();
      turns_.push_back(!skeleton.tree.aims[j].empty());
      AddChannels(turns_.back(), &joint, &values);
      Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
      if (joint.parent >= 0) rest = rest_[joint.parent];
      RotateByChannels(joint, values.data(), &rest);
      rest_.push_back(rest);
      values_.push_back(std::move(values));
    }
  }

  BvhMotion Write(const BodyMotion& motion, double dt) {
    BvhMotion bvh;
    bvh.frame_time_s = dt;
    for (const Pose& pose : motion) {
      const PosedJoints posed = Retarget(skeleton_, pose);
      for (int j = 0; j < skeleton_.num_joints(); ++j) Append(posed, j, &bvh.values);
    }
    bvh.skeleton = std::move(file_.bvh);
    return bvh;
  }

 private:
  void Append(const PosedJoints& posed, int j, std::vector<double>* row) {
    const BvhJoint& joint = file_.bvh.joints[j];
    std::vector<double> values = values_[j];
    if (joint.parent < 0) {
      const Eigen::Vector3d place =
          file_.world_from_file.transpose() * posed.positions.col(j) / file_.metres_per_unit;
      for (size_t c = 0; c < joint.channels.size(); ++c) {
        if (!IsRotation(joint.channels[c])) values[c] = place[AxisOf(joint.channels[c])];
      }
    }
    if (turns_[j]) {
      Eigen::Matrix3d local = InFile(posed.rotations[j]) * rest_[j];
      if (joint.parent >= 0) {
        local = ((InFile(posed.rotations[joint.parent]) * rest_[joint.parent]).transpose() * local)
                    .eval();
      }
      SetRotationChannels(joint, local, values.data());
    }
    row->insert(row->end(), values.begin(), values.end());
  }

  // A rotation in the world, in the file's axes.
  Eigen::Matrix3d InFile(const Eigen::Matrix3d& rotation) const {
    return file_.world_from_file.transpose() * rotation * file_.world_from_file;
  }

  const BodySkeleton& skeleton_;
  FileSkeleton file_;
  std::vector<bool> turns_;
  std::vector<Eigen::Matrix3d> rest_;        // of the joints at frame 0, file's axes
  std::vector<std::vector<double>> values_;  // of each joint's channels at frame 0
};

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

BodySkeleton BodyScene::skeleton(int person) const {
  return skeletons.empty() ? RoleSkeleton(bodies[person].front(), DefaultJointNames())
                           : skeletons[person];
}

BodyScene SceneOf(const BodyRecording& recording, std::vector<BodyMotion> bodies) {
  BodyScene scene;
  scene.id = recording.pendulum.id;
  scene.dt = recording.pendulum.scene.dt;
  scene.subject_ids = recording.pendulum.subject_ids;
  scene.skeletons = recording.skeletons;
  scene.bodies = std::move(bodies);
  return scene;
}

BvhMotion ToBvh(const BodySkeleton& skeleton, const BodyMotion& motion, double dt) {
  return HierarchyMotion(skeleton).Write(motion, dt);
}

bool IsBodyFile(const std::string& path) {
  constexpr size_t kEnding = 4;
  return path.size() > kEnding &&
         EqualsIgnoringCase(std::string_view(path).substr(path.size() - kEnding), ".bvh");
}

Result<std::vector<std::string>> WriteBodyBvh(const std::string& path, const BodyScene& scene) {
  std::vector<std::string> files;
  for (int n = 0; n < scene.num_people(); ++n) {
    files.push_back(scene.num_people() == 1 ? path : PersonsFile(path, n, scene.subject_ids[n]));
    const BvhMotion bvh = ToBvh(scene.skeleton(n), scene.bodies[n], scene.dt);
    if (MaybeError error = WriteBvh(files.back(), bvh)) return *error;
  }
  return files;
}

MaybeError WriteJointsCsv(const std::string& path, const BodyScene& scene) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append("frame,time_s,person,subject,joint,x_m,y_m,z_m\n");
  std::vector<BodySkeleton> skeletons;
  for (int n = 0; n < scene.num_people(); ++n) skeletons.push_back(scene.skeleton(n));
  char numbers[128];
  for (int t = 0; t < scene.num_frames(); ++t) {
    for (int n = 0; n < scene.num_people(); ++n) {
      const PosedJoints posed = Retarget(skeletons[n], scene.bodies[n][t]);
      for (int j = 0; j < skeletons[n].num_joints(); ++j) {
        const auto p = posed.positions.col(j);
        std::snprintf(numbers, sizeof numbers, "%d,%.9g,%d,", t, t * scene.dt, n);
        file.Append(numbers + scene.subject_ids[n] + "," + skeletons[n].names[j]);
        std::snprintf(numbers, sizeof numbers, ",%.6f,%.6f,%.6f\n", p.x(), p.y(), p.z());
        file.Append(numbers);
      }
    }
  }
  return file.Commit();
}

}  // namespace pushid
