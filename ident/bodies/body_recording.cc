// ident: recordings as bodies.
#include "ident/bodies/body_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>

#include "datasets/files/atomic_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {
namespace {

MaybeError CheckSkeleton(const Recording& recording, const RecordedPerson& person) {
  const std::vector<int> unfilled = UnfilledRoles(person.roles);
  if (unfilled.empty()) return std::nullopt;
  return Error{"recording " + recording.id +
                   ": a body needs joints that were not recognised: " + RoleList(unfilled) +
                   "; name them in the manifest: \"joints\": {\"" + RoleName(unfilled.front()) +
                   "\": ...}; the file has " + ListOfNames(person.joint_names),
               person.file};
}

// The file's own names, where a role is one of its joints.
std::vector<std::string> RoleJointNames(const RecordedPerson& person) {
  std::vector<std::string> names = DefaultJointNames();
  for (int role = 0; role < kBodyJoints; ++role) {
    const int joint = person.roles.Single(role);
    if (joint >= 0 && person.skeleton) names[role] = person.joint_names[joint];
  }
  return names;
}

// People in their first poses, and those that were seen; one pose is the first, which everybody
// has.
std::vector<RestorationInput> People(const BodyRecording& recording, int observed) {
  std::vector<Pose> first_poses;
  for (const BodyMotion& body : recording.bodies) first_poses.push_back(body.front());
  auto people = PeopleOf(recording.pendulum.scene, first_poses);
  for (size_t n = 0; observed > 1 && n < people.size(); ++n) {
    const BodyMotion& body = recording.bodies[n];
    people[n].seen.assign(body.begin(), body.begin() + std::min<size_t>(observed, body.size()));
  }
  return people;
}

std::vector<FootPath> FeetOf(const RolloutPath<double>& path, int person) {
  std::vector<FootPath> feet(path.num_frames());
  for (int t = 0; t < path.num_frames(); ++t) {
    const PendulumState<double>& state = path.At(t, person);
    for (const bool left : {false, true}) {
      const Foot foot = left ? Foot::kLeft : Foot::kRight;
      feet[t].moved[left] = PlaceOf(foot, state) - PlaceOf(foot, path.At(0, person));
      feet[t].flies[left] = state.feet.swings == (left ? 1 : -1);
    }
  }
  return feet;
}

// Toes and head that were filled, as further joints behind those that play the role before them.
void AddFilledEnds(const BodyRoles& roles, const Pose& first, BodySkeleton* skeleton) {
  for (int role :
       {static_cast<int>(kBodyHead), static_cast<int>(kRightToe), static_cast<int>(kLeftToe)}) {
    const int parent = roles.Single(kBodyParents[role]);
    if (roles.Has(role) || parent < 0) continue;
    skeleton->tree.parents.push_back(parent);
    skeleton->wanted_roles.push_back(role);
    skeleton->rest.conservativeResize(3, skeleton->rest.cols() + 1);
    skeleton->rest.rightCols<1>() = first.col(role);
  }
}

// Names, parents, roles and rest are set: every joint that a place is wanted of is an aim of the
// next one towards the root that turns.
void SetTree(BodySkeleton* skeleton) {
  const std::vector<int>& wanted = skeleton->wanted_roles;
  const std::vector<int>& parents = skeleton->tree.parents;
  const int columns = static_cast<int>(wanted.size());
  const bool hip_is_one = std::count(skeleton->roles.begin(), skeleton->roles.end(), kBodyHip) > 0;
  std::vector<int> turning(columns, -1);  // the joint itself, or the next one above that turns
  skeleton->tree.aims.assign(columns, {});
  for (int j = 0; j < columns; ++j) {
    const int above = parents[j] < 0 ? -1 : turning[parents[j]];
    // The root turns for a hip that is the mean of several joints.
    const bool turns = wanted[j] >= 0 || (parents[j] < 0 && !hip_is_one);
    turning[j] = turns ? j : above;
    if (wanted[j] >= 0 && above >= 0) skeleton->tree.aims[above].push_back(j);
  }
}

}  // namespace

Result<BodyRecording> MakeBodyRecording(const Recording& recording) {
  BodyRecording result;
  result.pendulum = MakePendulumRecording(recording);
  for (const RecordedPerson& person : recording.people) {
    if (MaybeError error = CheckSkeleton(recording, person)) return *error;
    BodyMotion motion(person.joints.size());
    for (size_t t = 0; t < motion.size(); ++t) {
      motion[t] = PoseOf(person.roles, person.joints[t]);
    }
    result.bodies.push_back(std::move(motion));
    result.skeletons.push_back(SkeletonOf(person));
  }
  ToGround(result.pendulum.scene, &result.bodies);
  result.joint_names = RoleJointNames(recording.people.front());
  return result;
}

Result<std::vector<BodyRecording>> MakeBodyRecordings(const std::vector<Recording>& recordings) {
  std::vector<BodyRecording> bodies;
  for (const Recording& recording : recordings) {
    Result<BodyRecording> body = MakeBodyRecording(recording);
    if (!body.ok()) return body.error();
    bodies.push_back(std::move(body.value()));
  }
  return bodies;
}

std::vector<PendulumRecording> PendulumsOf(const std::vector<BodyRecording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const BodyRecording& recording : recordings) pendulums.push_back(recording.pendulum);
  return pendulums;
}

void FollowPrediction(const Prediction& prediction, std::vector<RestorationInput>* people) {
  for (int n = 0; n < static_cast<int>(people->size()); ++n) {
    RestorationInput& person = (*people)[n];
    for (int t = 0; t < prediction.path.num_frames(); ++t) {
      person.Follow(prediction.path.At(t, n), prediction.rod_moves);
    }
    if (prediction.feet_step) person.feet = FeetOf(prediction.path, n);
  }
}

std::vector<RestorationInput> PredictedPeople(const BodyRecording& recording,
                                              const Prediction& prediction) {
  std::vector<RestorationInput> people = People(recording, prediction.observed);
  FollowPrediction(prediction, &people);
  return people;
}

std::vector<RestorationInput> RecordedPeople(const BodyRecording& recording, bool rod_moves,
                                             int observed) {
  std::vector<RestorationInput> people = People(recording, observed);
  const PendulumRecording& pendulum = recording.pendulum;
  for (int n = 0; n < recording.num_people(); ++n) {
    for (int t = 0; t < recording.num_frames(); ++t) {
      const Vector4<double>& q = pendulum.states[n][t].q;
      people[n].q.push_back(q);
      if (!rod_moves) continue;
      const double length = pendulum.rod_length[n][t];
      people[n].lengths.emplace_back(
          length, pendulum.hip[n][t].z() - length * std::cos(q[2]) * std::cos(q[3]));
    }
  }
  return people;
}

std::vector<std::string> DefaultJointNames() {
  return {"Hips",         "Spine",         "Spine1",        "Spine2",     "Neck",
          "Head",         "RightClavicle", "RightShoulder", "RightElbow", "RightWrist",
          "LeftClavicle", "LeftShoulder",  "LeftElbow",     "LeftWrist",  "RightHip",
          "RightKnee",    "RightAnkle",    "RightToe",      "LeftHip",    "LeftKnee",
          "LeftAnkle",    "LeftToe"};
}

BodySkeleton RoleSkeleton(const Pose& first) {
  BodySkeleton skeleton;
  skeleton.names = DefaultJointNames();
  skeleton.parents.assign(kBodyParents.begin(), kBodyParents.end());
  for (int role = 0; role < kBodyJoints; ++role) skeleton.roles.push_back(role);
  skeleton.rest = first;
  skeleton.hip = first.col(kBodyHip);
  skeleton.tree.parents = skeleton.parents;
  skeleton.wanted_roles = skeleton.roles;
  SetTree(&skeleton);
  return skeleton;
}

BodySkeleton SkeletonOf(const RecordedPerson& person) {
  if (!person.skeleton) {
    return RoleSkeleton(PoseOf(person.roles, person.joints.front()));
  }
  const FileSkeleton& file = *person.skeleton;
  BodySkeleton skeleton;
  skeleton.file = file;
  skeleton.names = person.joint_names;
  skeleton.parents = person.joint_parents;
  const int joints = skeleton.num_joints();
  skeleton.roles.assign(joints, -1);
  for (int role = kBodyJoints - 1; role >= 0; --role) {
    if (person.roles.Single(role) >= 0) skeleton.roles[person.roles.Single(role)] = role;
  }
  // Positions are the file's, not the filtered ones: their bones are what is kept.
  std::vector<int> all(joints);
  std::iota(all.begin(), all.end(), 0);
  std::vector<Eigen::Vector3d> rest(joints);
  BvhKinematics(file.bvh, file.metres_per_unit, all).Positions(file.values.data(), rest.data());
  skeleton.rest.resize(3, joints);
  for (int j = 0; j < joints; ++j) {
    rest[j] = file.world_from_file * rest[j];
    skeleton.rest.col(j) = rest[j];
  }
  skeleton.tree.parents = skeleton.parents;
  skeleton.wanted_roles = skeleton.roles;
  const Pose first = PoseOf(person.roles, rest);
  skeleton.hip = first.col(kBodyHip);
  AddFilledEnds(person.roles, first, &skeleton);
  SetTree(&skeleton);
  return skeleton;
}

FittedTree Retarget(const BodySkeleton& skeleton, const Pose& pose) {
  // A root that is not the hip is carried along with it.
  const Eigen::Vector3d move = pose.col(kBodyHip) - skeleton.hip;
  Eigen::Matrix3Xd wanted = skeleton.rest.colwise() + move;
  for (size_t j = 0; j < skeleton.wanted_roles.size(); ++j) {
    if (skeleton.wanted_roles[j] >= 0) wanted.col(j) = pose.col(skeleton.wanted_roles[j]);
  }
  const FittedTree fitted = FitTree(skeleton.tree, skeleton.rest, wanted);
  const int joints = skeleton.num_joints();
  FittedTree posed{Eigen::Matrix3Xd(3, joints),
                   {fitted.rotations.begin(), fitted.rotations.begin() + joints}};
  for (int j = 0; j < joints; ++j) {
    const int parent = skeleton.parents[j];
    posed.positions.col(j) = wanted.col(j);
    if (skeleton.roles[j] >= 0 || parent < 0) continue;
    posed.positions.col(j) =
        posed.positions.col(parent) +
        posed.rotations[parent] * (skeleton.rest.col(j) - skeleton.rest.col(parent));
  }
  return posed;
}

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
      const FittedTree posed = Retarget(skeleton_, pose);
      for (int j = 0; j < skeleton_.num_joints(); ++j) Append(posed, j, &bvh.values);
    }
    bvh.skeleton = std::move(file_.bvh);
    return bvh;
  }

 private:
  void Append(const FittedTree& posed, int j, std::vector<double>* row) {
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
std::string PersonsFile(const std::string& file, int person, std::string subject) {
  std::replace(subject.begin(), subject.end(), '/', '_');
  const std::filesystem::path path(file);
  const std::string name = path.stem().string() + "_" + std::to_string(person) + "_" + subject;
  return (path.parent_path() / (name + path.extension().string())).string();
}

}  // namespace

BodySkeleton BodyScene::skeleton(int person) const {
  return skeletons.empty() ? RoleSkeleton(bodies[person].front()) : skeletons[person];
}

BodyScene SceneOf(const BodyRecording& recording, std::vector<BodyMotion> bodies) {
  const PendulumRecording& pendulum = recording.pendulum;
  return {pendulum.id, pendulum.scene.dt, pendulum.subject_ids, recording.skeletons,
          std::move(bodies)};
}

BvhMotion ToBvh(const BodySkeleton& skeleton, const BodyMotion& motion, double dt) {
  return HierarchyMotion(skeleton).Write(motion, dt);
}

bool IsBodyFile(const std::string& path) {
  return EqualsIgnoringCase(std::filesystem::path(path).extension().string(), ".bvh");
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
      const FittedTree posed = Retarget(skeletons[n], scene.bodies[n][t]);
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
