// datasets: mapping a recording's skeletons to pendulums.
#include "datasets/loading/pendulum_recording.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "datasets/files/input_file.h"
#include "datasets/manifest/joint_mapping.h"
#include "models/restoration/body.h"
#include "models/standing.h"
#include "models/turn.h"

namespace pushid {
namespace {

// Hash of the files and of what the manifest makes of them: masses, units, rate, pushes.
std::string HashOf(const PendulumRecording& recording, const std::string& files) {
  ContentHash hash;
  hash.Add(files);
  hash.Add(&recording.scene.dt, 1);
  for (int n = 0; n < recording.num_people(); ++n) {
    const ScenePerson& person = recording.scene.people[n];
    const double body[] = {person.body.mass, person.body.rod_length, person.body.cart_height};
    hash.Add(body, 3);
    hash.Add(person.start.qd.data(), 4);
    for (const Vector3<double>& hip : recording.hip[n]) hash.Add(hip.data(), 3);
  }
  for (const GroundPose& pose : recording.scene.ground.poses) hash.Add(pose.data(), 4);
  for (const std::vector<PlateFrame>& of_one : recording.plates) {
    for (const PlateFrame& frame : of_one) {
      hash.Add(frame.shear.data(), 2);
      hash.Add(frame.centre.data(), 2);
      hash.Add(&frame.weight, 1);
    }
  }
  for (const ScenePush& push : recording.scene.pushes) {
    const double kind[] = {static_cast<double>(push.person), static_cast<double>(push.start_frame),
                           static_cast<double>(push.kind)};
    hash.Add(kind, 3);
    for (const Vector4<double>& row : push.force) hash.Add(row.data(), 4);
  }
  return hash.Hex();
}

// The direction in which the lines between the ankles point forwards, on average over people and
// the frames before the push; 0 where the ankles are one.
double FacingBeforePush(const Recording& recording) {
  int frames = recording.num_frames();
  for (const Push& push : recording.pushes) frames = std::min(frames, push.start_frame);
  Eigen::Vector2d to_the_left = Eigen::Vector2d::Zero();
  for (const RecordedPerson& person : recording.people) {
    Eigen::Vector3d own = Eigen::Vector3d::Zero();
    for (int t = 0; t < std::max(1, frames); ++t) {
      own += person.left_ankle[t] - person.right_ankle[t];
    }
    if (own.head<2>().norm() > 0.0) to_the_left += own.head<2>().normalized();
  }
  return to_the_left.norm() > 0.0 ? std::atan2(-to_the_left.x(), to_the_left.y()) : 0.0;
}

// A person as seen from ground that moves, without the joints that only bodies have, and with
// platforms as they are, which move with the ground.
RecordedPerson SeenFromGround(const Recording& recording, RecordedPerson person) {
  const std::vector<GroundPose>& poses = recording.ground;
  if (poses.empty()) return person;
  const Vector3<double> origin = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  for (const PendulumTrack& row : kPendulumTracks) {
    std::vector<Eigen::Vector3d>& track = person.*row.track;
    for (size_t t = 0; t < track.size(); ++t) {
      track[t] = OnGround(poses[std::min(t, poses.size() - 1)], origin, track[t]);
    }
  }
  return person;
}

// The first frame at which anything happens: a push, or ground that may move. Ground is seen to
// have left its place later, and accelerates most before that: as far back from there as from there
// to half of its way.
size_t FirstDisturbance(const Recording& recording) {
  int first = recording.num_frames();
  for (const Push& push : recording.pushes) first = std::min(first, push.start_frame);
  const std::vector<GroundPose>& poses = recording.ground;
  if (poses.empty()) return first;
  const int left = FirstMotion(poses);
  double farthest = 0.0;
  for (const GroundPose& pose : poses) farthest = std::max(farthest, (pose - poses[0]).norm());
  int half = left;
  while (half < static_cast<int>(poses.size()) &&
         (poses[half] - poses[0]).norm() < 0.5 * farthest) {
    ++half;
  }
  return std::min(first, std::max(0, left - (half - left)));
}

// The mean centre of pressure over the frames before `end`; none: nobody pressed.
std::optional<Eigen::Vector2d> MeanCentre(const std::vector<PlateSample>& plates, size_t end) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0.0;
  for (size_t t = 0; t < std::min(end, plates.size()); ++t) {
    if (plates[t].weight <= 0.0) continue;
    sum += plates[t].centre.head<2>();
    weights += 1.0;
  }
  if (weights == 0.0) return std::nullopt;
  return Eigen::Vector2d(sum / weights);
}

// The centre of pressure counts from where it was before anything happened (of quiet stance, or
// where nobody pressed a platform before: on average), since neither ankles nor hip are seen where
// they are: what is compared is how it moves.
std::vector<PlateFrame> PlateFrames(const Recording& recording, const RecordedPerson& person) {
  const std::vector<PlateSample>& plates = person.plates;
  std::optional<Eigen::Vector2d> rest =
      MeanCentre(plates, std::max<size_t>(1, FirstDisturbance(recording)));
  if (!rest) rest = MeanCentre(plates, plates.size());
  std::vector<PlateFrame> frames;
  for (const PlateSample& sample : plates) {
    const Eigen::Vector2d centre = sample.centre.head<2>() - rest.value_or(Eigen::Vector2d::Zero());
    frames.push_back({sample.force.head<2>(), centre, sample.weight});
  }
  return frames;
}

// The mean pose of a person who stands quietly at first, from which they start: the noise of one
// frame would be in all frames, and the centre of pressure counts from an average too.
Vector4<double> MeanOfQuiet(const std::vector<PendulumState<double>>& states, size_t end,
                            const std::vector<double>& weight) {
  Vector4<double> mean = states[0].q;
  double frames = 1.0;
  for (size_t t = 1; t < end && end < states.size(); ++t) {
    if (!weight.empty() && weight[t] <= 0.0) continue;
    frames += 1.0;
    mean += (states[t].q - mean) / frames;
  }
  return mean;
}

// A share of the body's mass, its centre on the way from one joint to another, and its radius of
// gyration over that way.
struct Segment {
  int from, to;
  double mass, centre, gyration;
};
constexpr double kFoot = 0.0133;  // each
constexpr Segment kSegments[] = {{kNeck, kBodyHead, 0.0681, 0.5, 0.29},
                                 {kNeck, kBodyHip, 0.4302, 0.432, 0.365},
                                 {kRightShoulder, kRightElbow, 0.0263, 0.576, 0.28},
                                 {kLeftShoulder, kLeftShoulder + 1, 0.0263, 0.576, 0.28},
                                 {kRightElbow, kRightWrist, 0.0209, 0.6, 0.35},  // with the hand
                                 {kLeftShoulder + 1, kLeftWrist, 0.0209, 0.6, 0.35},
                                 {kRightHip, kRightKnee, 0.1447, 0.385, 0.35},
                                 {kLeftHip, kLeftKnee, 0.1447, 0.385, 0.35},
                                 {kRightKnee, kRightAnkle, 0.0457, 0.444, 0.26},
                                 {kLeftKnee, kLeftAnkle, 0.0457, 0.444, 0.26}};

// An average body, over the rod: thigh and shank together, their first moment, and what is above.
constexpr double kLegs = 0.3808, kLegsMoment = 0.2595, kAbove = 0.5926, kOfShoulders = 0.6;

MassDistribution Average() {
  const double r = kComOverHip * std::sqrt(kInertiaRatio - 1.0);
  return {1.0 - kMassAboveAnkles, kComOverHip, r};
}

// Height of the shoulders above the hip, m; 0: not seen.
double ShouldersAboveHip(const RecordedPerson& person) {
  double height = 0.0;
  int seen = 0;
  for (int role : {static_cast<int>(kRightShoulder), static_cast<int>(kLeftShoulder)}) {
    for (int joint : person.roles.joints[role]) {
      height += person.joints[0][joint].z() - person.hip[0].z();
      ++seen;
    }
  }
  return seen > 0 ? height / seen : 0.0;
}

}  // namespace

PendulumRecording MakePendulumRecording(const Recording& recording) {
  PendulumRecording result;
  result.SetFacts(recording);
  result.scene.dt = 1.0 / recording.fps;
  result.facing = FacingBeforePush(recording);

  for (const RecordedPerson& recorded : recording.people) {
    const RecordedPerson person = SeenFromGround(recording, recorded);
    std::vector<PendulumState<double>> states(person.hip.size());
    std::vector<double> lengths(person.hip.size());
    ScenePerson in_scene;
    for (size_t t = 0; t < person.hip.size(); ++t) {
      const MappedPose pose =
          MapSkeleton(person.hip[t], person.left_ankle[t], person.right_ankle[t]);
      states[t].q = pose.q;
      if (t > 0) states[t].qd = (pose.q - states[t - 1].q) * recording.fps;
      lengths[t] = pose.rod_length;
      if (t == 0) in_scene.body = {person.mass_kg, pose.rod_length, pose.cart_height};
    }
    in_scene.start.q = recording.initial_velocity == InitialVelocity::kZero
                           ? MeanOfQuiet(states, FirstDisturbance(recording), person.weight)
                           : states[0].q;
    in_scene.start.feet.apart = (person.left_ankle[0] - person.right_ankle[0]).head<2>();
    if (recording.initial_velocity != InitialVelocity::kZero && states.size() > 1) {
      in_scene.start.qd = states[1].qd;
    }
    states[0].qd = in_scene.start.qd;
    result.subject_ids.push_back(person.subject_id);
    result.known.push_back(person.known);
    result.scene.people.push_back(in_scene);
    result.states.push_back(std::move(states));
    result.rod_length.push_back(std::move(lengths));
    result.hip.push_back(person.hip);
    result.plates.push_back(PlateFrames(recording, person));
    result.masses.push_back(MassesOf(person));
    result.steps.push_back(FindSteps(person, recording.fps));
    std::vector<double> weight = person.weight;
    for (size_t t = 1; t < weight.size(); ++t) {
      weight[t] = std::min(person.weight[t - 1], person.weight[t]);
    }
    result.weight.push_back(std::move(weight));
  }
  if (!recording.ground.empty()) {
    result.scene.ground = GroundThrough(recording.ground, result.scene.dt);
  }
  if (!result.HasPlates()) result.plates.clear();
  for (const Push& push : recording.pushes) {
    result.scene.pushes.push_back(
        MakeScenePush(push.person, push.start_frame, recording.push_kind, push.force));
  }
  result.content_hash = HashOf(result, recording.content_hash);
  return result;
}

std::vector<PendulumRecording> MakePendulumRecordings(const std::vector<Recording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const Recording& recording : recordings) {
    pendulums.push_back(MakePendulumRecording(recording));
  }
  return pendulums;
}

Eigen::Vector2d PushDirection(const PendulumRecording& recording) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const ScenePush& push : recording.scene.pushes) {
    if (push.person != recording.pushed_person) continue;
    sum += static_cast<double>(push.force.size()) * push.mean.head<2>();
  }
  if (sum.norm() > 0.0) return sum.normalized();
  // Without a push the direction is where the ground goes farthest, shifted or tilted by as many
  // metres as the rod.
  Eigen::Vector2d farthest = Eigen::Vector2d::Zero();
  for (const GroundPose& pose : recording.scene.ground.poses) {
    const Eigen::Vector2d moved = pose.head<2>() + Eigen::Vector2d(pose[2], -pose[3]);
    if (moved.norm() > farthest.norm()) farthest = moved;
  }
  return farthest.norm() > 0.0 ? Eigen::Vector2d(farthest.normalized()) : Eigen::Vector2d(1.0, 0.0);
}

Scene TurnedScene(const PendulumRecording& recording, double angle) {
  const TurnedAxes axes(angle);
  Scene scene = recording.scene;
  for (ScenePush& push : scene.pushes) {
    for (size_t i = 0; i < push.force.size(); ++i) {
      // A scene alone has no poses but those of its start.
      Vector4<double> pose = scene.people[push.person].start.q;
      if (!recording.states.empty()) {
        const std::vector<PendulumState<double>>& states = recording.states[push.person];
        pose = states[std::min(states.size() - 1, push.start_frame + i)].q;
      }
      push.force[i] = axes.Force(pose, push.force[i]);
    }
    push = MakeScenePush(push.person, push.start_frame, push.kind, std::move(push.force));
  }
  if (scene.ground.moves()) {
    for (GroundPose& pose : scene.ground.poses) pose = axes.Pose(pose);  // tilts as rods do
    scene.ground = GroundThrough(std::move(scene.ground.poses), scene.dt);
  }
  for (ScenePerson& person : scene.people) {
    person.start.qd = axes.PoseJacobian(person.start.q) * person.start.qd;
    person.start.q = axes.Pose(person.start.q);
    person.start.feet.apart = axes.Horizontal(person.start.feet.apart);
  }
  return scene;
}

PendulumRecording Turned(PendulumRecording recording, double angle) {
  const TurnedAxes axes(angle);
  recording.scene = TurnedScene(recording, angle);
  recording.facing -= angle;
  for (int n = 0; n < recording.num_people(); ++n) {
    for (Vector3<double>& hip : recording.hip[n]) hip = axes.Point(hip);
    if (recording.HasPlates(n)) {
      for (PlateFrame& frame : recording.plates[n]) {
        frame.shear = axes.Horizontal(frame.shear);
        frame.centre = axes.Horizontal(frame.centre);
      }
    }
    std::vector<PendulumState<double>>& states = recording.states[n];
    for (size_t t = 0; t < states.size(); ++t) {
      states[t].q = axes.Pose(states[t].q);
      states[t].qd = t == 0 ? recording.scene.people[n].start.qd
                            : Vector4<double>((states[t].q - states[t - 1].q) / recording.scene.dt);
    }
  }
  return recording;
}

MaybeError CheckLabel(const std::vector<PendulumRecording>& recordings, const std::string& flag,
                      const std::string& key, const std::string& other) {
  std::set<std::string> known = {other};
  for (const PendulumRecording& recording : recordings) {
    for (const std::string& own : recording.labels.Keys()) known.insert(own);
  }
  if (known.count(key) > 0) return std::nullopt;
  return Error{"--" + flag + " is '" + key + "', a label that no recording has; there are " +
               Listed({known.begin(), known.end()}, ",")};
}

MassDistribution MassesOf(const RecordedPerson& person) {
  const std::map<std::string, double>& known = person.known.numbers;
  if (const auto com = known.find(kComOverRod); com != known.end()) {
    const auto gyration = known.find(kGyrationOverRod);
    return {0.0, com->second, gyration == known.end() ? 0.0 : gyration->second};
  }
  MassDistribution average = Average();
  if (person.joints.empty()) return average;
  const Eigen::Vector3d ankles = 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  const Eigen::Vector3d rod = person.hip[0] - ankles;
  const double length = rod.norm();
  if (!UnfilledRoles(person.roles).empty()) {
    const double shoulders = ShouldersAboveHip(person);
    if (shoulders <= 0.0) return average;
    const double com =
        (kLegsMoment + kAbove * (1.0 + kOfShoulders * shoulders / length)) / (kLegs + kAbove);
    average.gyration *= com / average.com;
    average.com = com;
    return average;
  }
  const Pose pose = PoseOf(person.roles, person.joints[0]);
  double mass = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  const auto centre = [&pose](const Segment& s) -> Eigen::Vector3d {
    return pose.col(s.from) + s.centre * (pose.col(s.to) - pose.col(s.from));
  };
  for (const Segment& s : kSegments) {
    mass += s.mass;
    moment += s.mass * (centre(s) - ankles);
  }
  const Eigen::Vector3d com = moment / mass;
  // About the axis from ankle to ankle, about which people sway.
  const Eigen::Vector3d across = person.left_ankle[0] - person.right_ankle[0];
  const Eigen::Vector3d axis =
      across.norm() > 0.0 ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::UnitY();
  double inertia = 0.0;
  for (const Segment& s : kSegments) {
    const Eigen::Vector3d from_com = centre(s) - ankles - com;
    const double own = s.gyration * (pose.col(s.to) - pose.col(s.from)).norm();
    inertia += s.mass * (axis.cross(from_com).squaredNorm() + own * own);
  }
  return {2.0 * kFoot, com.dot(rod) / (length * length), std::sqrt(inertia / mass) / length};
}

bool IsAverage(const MassDistribution& masses) {
  const MassDistribution average = Average();
  return masses.com == average.com && masses.gyration == average.gyration;
}

}  // namespace pushid
