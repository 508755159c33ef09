// ident: rollout of a formation and what it says about each person.
#include "ident/formations/formation_run.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/prediction/propagation.h"
#include "ident/uncertainty/clusters.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

// p00, p01, ...: names that sort in the order of the people.
std::string PersonName(int person, int people) {
  const std::string number = std::to_string(person);
  const size_t width = std::to_string(std::max(10, people - 1)).size();
  return "p" + std::string(width - number.size(), '0') + number;
}

PendulumRecording AsRecording(const Scene& scene) {
  PendulumRecording recording;
  recording.id = "formation";
  recording.labels.Set(kSettingLabel, recording.id);
  recording.scene = scene;
  if (!scene.pushes.empty()) recording.pushed_person = scene.pushes.front().person;
  for (int n = 0; n < scene.num_people(); ++n) {
    recording.subject_ids.push_back(PersonName(n, scene.num_people()));
  }
  return recording;
}

Outcome Judge(const FormationRun& run, int person, int onset_frame) {
  const RolloutPath<double>& path = run.prediction.path;
  for (int t = 0; t < run.num_frames(); ++t) {
    if (path.At(t, person).q.tail<2>().cwiseAbs().maxCoeff() > kFallAngle) return Outcome::kFell;
  }
  if (onset_frame < 0) return Outcome::kUnmoved;
  const Scene& scene = run.recording.scene;
  // Time counts from a person's own onset, so that it does not hold what a wave takes to reach them
  // (kWaitSecondsInRows).
  const int judged = std::max(scene.LastPushEnd(), onset_frame) +
                     static_cast<int>(std::lround(kWaitSeconds / scene.dt));
  if (judged >= run.num_frames()) return Outcome::kNotJudged;
  const PendulumState<double>& end = path.At(judged, person);
  const Vector4<double>& rest = scene.people[person].start.q;
  const bool settled = end.qd.head<2>().norm() < kSettledSpeed &&
                       (end.q - rest).tail<2>().cwiseAbs().maxCoeff() < kSettledLean;
  return settled ? Outcome::kSettled : Outcome::kSlow;
}

PersonSummary Summarize(const FormationRun& run, int person) {
  const std::vector<Vector3<double>>& hip = run.prediction.hip[person];
  PersonSummary summary;
  for (int t = 0; t < run.num_frames(); ++t) {
    summary.peak_speed = std::max(summary.peak_speed, HipSpeed(run, person, t));
  }
  summary.onset_frame = OnsetFrame(hip);
  summary.displacement = PushDirection(run.recording).dot((hip.back() - hip.front()).head<2>());
  summary.outcome = Judge(run, person, summary.onset_frame);
  return summary;
}

}  // namespace

std::string OutcomeLegend() {
  return "outcome: judged " + Rounded(kWaitSeconds, 4) +
         " s after the last push, or after the onset where that is later; " + kSettledText +
         ": slower than " + Rounded(kSettledSpeed, 4) + " m/s\nand within " +
         Rounded(kSettledLean, 4) + " rad of the rest posture then; " + kSlowToSettleText +
         ": not yet. " + kFellText +
         ": at any time. displaced: at the end of the run, along the push\n";
}

std::vector<ForcePart> ActingParts(const FormationRun& run) {
  std::vector<ForcePart> acting;
  for (ForcePart part : kForceParts) {
    bool acts = false;
    for (int t = 0; t < run.num_frames() && !acts; ++t) {
      for (int n = 0; n < run.num_people(); ++n) {
        acts = acts || !run.Force(n, t)[part].isZero(0.0);
      }
    }
    if (acts) acting.push_back(part);
  }
  std::stable_partition(acting.begin(), acting.end(), [](ForcePart part) {
    return part == ForcePart::kPush || part == ForcePart::kTail;
  });
  return acting;
}

FormationRun RunFormation(const IdentifiedModel& model, const Scene& scene, int num_frames,
                          const std::vector<std::string>& names) {
  FormationRun run;
  run.recording = AsRecording(scene);
  if (!names.empty()) run.recording.subject_ids = names;
  // People of a formation are no subjects of the fit.
  IdentifiedModel shared = model;
  shared.by_unit.clear();
  run.prediction = Predict(shared, run.recording, num_frames);
  if (!run.prediction.status.ok) return run;
  for (int n = 0; n < run.num_people(); ++n) run.summaries.push_back(Summarize(run, n));
  return run;
}

double HipSpeed(const FormationRun& run, int person, int frame) {
  if (frame == 0) return 0.0;
  const std::vector<Vector3<double>>& hip = run.prediction.hip[person];
  return (hip[frame] - hip[frame - 1]).norm() / run.recording.scene.dt;
}

double SignedHipSpeed(const FormationRun& run, int person, int frame) {
  const double speed = HipSpeed(run, person, frame);
  if (frame == 0) return speed;
  const std::vector<Vector3<double>>& hip = run.prediction.hip[person];
  const Vector3<double> step = hip[frame] - hip[frame - 1];
  return -step.x() > std::abs(step.y()) ? -speed : speed;
}

Pose SyntheticPose(double rod_length) {
  const SyntheticSkeleton skeleton(rod_length);
  const Eigen::Vector3d cart(0.0, 0.0, skeleton.cart_height());
  SkeletonPose upright;
  upright.hip = cart + Eigen::Vector3d(0.0, 0.0, rod_length);
  upright.left_ankle = cart + skeleton.HalfStance();
  upright.right_ankle = cart - skeleton.HalfStance();
  std::vector<double> row;
  skeleton.AppendFrame(upright, LengthUnit::kMetre, &row);
  std::vector<int> joints(kBodyJoints);
  for (int j = 0; j < kBodyJoints; ++j) joints[j] = j;
  BvhKinematics kinematics(skeleton.Bvh(LengthUnit::kMetre), 1.0, joints);
  std::vector<Eigen::Vector3d> positions(kBodyJoints);
  kinematics.Positions(row.data(), positions.data());
  Pose pose;
  for (int j = 0; j < kBodyJoints; ++j) pose.col(j) = positions[j];
  return pose;
}

void PlaceFittedPeople(const std::vector<FittedPerson>& people, Scene* scene) {
  for (int n = 0; n < scene->num_people(); ++n) {
    const FittedPerson& fitted = people[n % people.size()];
    ScenePerson& person = scene->people[n];
    person.body.mass = fitted.mass;
    person.body.rod_length = fitted.rod;
    person.body.cart_height = fitted.cart_height;
    person.start.q.tail<2>() << fitted.theta, fitted.phi;
    person.start.feet.apart = fitted.apart;
  }
}

std::vector<Pose> SyntheticPoses(Scene* scene) {
  std::vector<Pose> poses;
  for (ScenePerson& person : scene->people) {
    const Vector4<double>& q = person.start.q;
    const Eigen::Quaterniond lean = Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(q[2], Eigen::Vector3d::UnitY());
    Pose pose = SyntheticPose(person.body.rod_length);
    const Eigen::Vector3d origin(0.0, 0.0, pose(2, kLeftAnkle));
    if (person.body.cart_height == 0.0) person.body.cart_height = origin.z();
    const Eigen::Vector3d cart(q[0], q[1], person.body.cart_height);
    for (int j = 0; j < kBodyJoints; ++j) {
      const Eigen::Vector3d at = pose.col(j) - origin;
      pose.col(j) = cart + (at.z() > 0.0 ? lean * at : at);  // feet stay flat
    }
    const Eigen::Vector2d half = 0.5 * person.start.feet.apart;
    pose.col(kLeftAnkle) << cart.head<2>() + half, cart.z();
    pose.col(kRightAnkle) << cart.head<2>() - half, cart.z();
    poses.push_back(pose);
  }
  return poses;
}

std::vector<Pose> TakePoses(const std::vector<Pose>& poses, Scene* scene) {
  std::vector<Pose> placed;
  for (int n = 0; n < scene->num_people(); ++n) {
    ScenePerson& person = scene->people[n];
    Pose pose = poses[n % poses.size()];
    pose = (TurnAboutZ(-Heading(pose)) * pose).eval();
    const Eigen::Vector3d cart = 0.5 * (pose.col(kLeftAnkle) + pose.col(kRightAnkle));
    pose.colwise() +=
        Eigen::Vector3d(person.start.q[0] - cart.x(), person.start.q[1] - cart.y(), 0.0);
    const MappedPose mapped = MapSkeleton(pose.col(0), pose.col(kLeftAnkle), pose.col(kRightAnkle));
    person.body.rod_length = mapped.rod_length;
    person.body.cart_height = mapped.cart_height;
    person.start.q.tail<2>() = mapped.q.tail<2>();
    person.start.feet.apart = (pose.col(kLeftAnkle) - pose.col(kRightAnkle)).head<2>();
    placed.push_back(pose);
  }
  return placed;
}

std::vector<BodyMotion> FormationBodies(const FormationRun& run,
                                        const std::vector<Pose>& first_poses,
                                        const Restoration& restoration,
                                        const PostprocessOptions& options) {
  const Scene& scene = run.recording.scene;
  std::vector<RestorationInput> people = PeopleOf(scene, first_poses);
  FollowPrediction(run.prediction, &people);
  return RestoreBodies(restoration, options, people);
}

FormationPeople DistinctPeople(const std::vector<BodyRecording>& recordings) {
  FormationPeople people;
  std::set<std::string> seen;
  for (const BodyRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      if (!seen.insert(recording.pendulum.subject_ids[n]).second) continue;
      people.poses.push_back(recording.bodies[n].front());
      people.masses.push_back(recording.pendulum.scene.people[n].body.mass);
    }
  }
  return people;
}

std::vector<Pose> PlacePeople(const FormationPeople& people, Scene* scene) {
  for (int n = 0; n < scene->num_people(); ++n) {
    scene->people[n].body.mass = people.masses[n % people.count()];
  }
  return TakePoses(people.poses, scene);
}

}  // namespace pushid
