// datasets: synthetic people with known parameters: options, skeleton, ground and motion.
#include "datasets/synthetic/synthetic_recordings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/files/random.h"
#include "datasets/formats/force_csv.h"
#include "datasets/manifest/manifest.h"
#include "models/ground.h"
#include "models/rollout.h"

namespace pushid {
namespace {

struct Subject {
  std::string id;
  double mass_kg;
  SyntheticSkeleton skeleton;
  ParameterSet<double> parameters;
};

// A parameter for each of so many draws, or none: with another number of them every recording of a
// known seed would change.
constexpr int kSpreadDraws = 35;

// Whether a parameter is spread: not delays, bodies and dry friction, nor feet that step and what
// is behind them.
constexpr bool IsSpread(int id) {
  return id < kSupportFront && id != kCoulombFriction && (id < kReactionDelay || id > kPushGain);
}

ParameterSet<double> Spread(ParameterSet<double> parameters, double sigma, Random* random) {
  constexpr int kNotSpread = 2 + kPushGain - kReactionDelay;
  static_assert(kSupportFront - kNotSpread <= kSpreadDraws);
  int draws = 0;
  for (int i = 0; i < kSupportFront; ++i) {
    if (!IsSpread(i)) continue;
    parameters[i] *= std::exp(sigma * random->Normal());
    ++draws;
  }
  for (; draws < kSpreadDraws; ++draws) random->Normal();
  return parameters;
}

// Neighbours' carts in a row, and everybody's place to the side, m.
constexpr double kLeastSpacing = 0.40, kMostSpacing = 0.50, kSidewaysSigma = 0.03;

std::string TwoDigits(int number) { return StrCat(number < 10 ? "0" : "", number); }

// The rows of a push of peak force mass * acceleration, in the plane of `direction` (0: forwards).
std::vector<Vector4<double>> DrawPush(const SyntheticOptions& options, const ScenePerson& person,
                                      double acceleration, Random* random) {
  const bool external = options.push_kind == PushKind::kExternal;
  const double shortest = options.min_push_s > 0.0 ? options.min_push_s : (external ? 0.15 : 0.05);
  const double longest = options.max_push_s > 0.0 ? options.max_push_s : (external ? 0.35 : 0.15);
  const double duration = random->Uniform(shortest, longest);
  const double direction = random->Normal(0.0, options.direction_sigma_rad);
  const double height = random->Uniform(options.min_height, options.max_height);
  const int rows = std::max(2, static_cast<int>(std::lround(duration * options.fps)));
  std::vector<Vector4<double>> force;
  for (int k = 0; k < rows; ++k) {
    const double phase = (k + 0.5) / rows * (external ? M_PI : 0.5 * M_PI);
    const double size = person.body.mass * acceleration * std::sin(phase);
    const Vector3<double> f(size * std::cos(direction), size * std::sin(direction), 0.0);
    force.push_back(GeneralizedForce(person.body, person.start.q, f, height));
  }
  return force;
}

RolloutStatus Roll(const SyntheticOptions& options, const ModelOptions& model,
                   SyntheticRecording* made, ForceTrace* forces = nullptr,
                   const FrameTable<Vector4<double>>* noise = nullptr) {
  return Rollout<double>(made->scene, model, made->parameters, InitialVelocities(made->scene),
                         options.frames, &made->path, forces, nullptr, noise);
}

// The motion, driven by process noise where the truth has any. Where a push replaces other forces
// while it lasts, its rows contain them: they are taken from a rollout in which the drawn push is
// added to everything else.
RolloutStatus RollDriven(const SyntheticOptions& options, Random* random,
                         SyntheticRecording* made) {
  if (options.model.push != PushUse::kAdded && options.push_kind != PushKind::kExternal &&
      !made->scene.pushes.empty()) {
    ModelOptions added = options.model;
    added.push = PushUse::kAdded;
    ForceTrace forces;
    const RolloutStatus status = Roll(options, added, made, &forces);
    if (!status.ok) return status;
    ScenePush& push = made->scene.pushes[0];
    std::vector<Vector4<double>> rows;
    for (int t = push.start_frame; t < std::min(push.EndFrame(), options.frames); ++t) {
      NetForce<double> force = forces.At(t, 0);
      if (options.push_kind == PushKind::kNetWithoutFriction) force[ForcePart::kFriction].setZero();
      rows.push_back(force.Total());
    }
    push = MakeScenePush(0, push.start_frame, push.kind, rows);
  }
  if (options.model.process_noise == ProcessNoise::kNone) return Roll(options, options.model, made);
  FrameTable<Vector4<double>> noise(options.frames, made->scene.num_people());
  for (int t = 0; t < options.frames; ++t) {
    for (int n = 0; n < made->scene.num_people(); ++n) {
      for (double& w : noise.At(t, n)) w = random->Normal();
    }
  }
  return Roll(options, options.model, made, nullptr, &noise);
}

RecordedPerson ObservePerson(const SyntheticOptions& options, const SyntheticRecording& made,
                             const Subject& subject, int n, Random* noise) {
  RecordedPerson person;
  person.subject_id = subject.id;
  person.mass_kg = subject.mass_kg;
  person.file = "synthetic";
  for (int t = 0; t < options.frames; ++t) {
    const PendulumState<double>& state = made.path.At(t, n);
    const Vector4<double>& q = state.q;
    const Body body = BodyNow(made.scene.people[n].body, state.rod);
    const double sigma = t == 0 && !options.noise_at_first_frame ? 0.0 : options.joint_noise_m;
    const Vector4<double>& start = made.path.At(0, n).q;
    const auto observed = [&](const Vector3<double>& position) {
      const double x = noise->Normal(), y = noise->Normal(), z = noise->Normal();
      const Vector3<double> seen =
          made.scene.ground.moves()
              ? PointInLaboratory(made.scene.ground.PoseAt(t),
                                  {start[0], start[1], body.cart_height}, position)
              : position;
      return Vector3<double>(seen + sigma * Vector3<double>(x, y, z));
    };
    const Vector3<double> cart(q[0], q[1], body.cart_height);
    person.hip.push_back(observed(HipPosition(body, q)));
    const Vector3<double> half(0.5 * state.feet.apart[0], 0.5 * state.feet.apart[1], 0.0);
    person.left_ankle.push_back(observed(cart + half));
    person.right_ankle.push_back(observed(cart - half));
  }
  return person;
}

std::vector<Subject> DrawSubjects(const SyntheticOptions& options, Random* people, Random* spread) {
  std::vector<Subject> subjects;
  for (int s = 0; s < options.subjects; ++s) {
    // Scales show masses to 0.1 kg.
    const double mass =
        std::round(10.0 * people->Uniform(options.min_mass_kg, options.max_mass_kg)) / 10.0;
    const SyntheticSkeleton skeleton(people->Uniform(options.min_rod_m, options.max_rod_m));
    subjects.push_back({"S" + TwoDigits(s + 1), mass, skeleton,
                        Spread(options.parameters, options.subject_spread, spread)});
  }
  return subjects;
}

// The row of people of one recording, the pushed one first, in the posture and place they start in.
void PlaceRow(const SyntheticOptions& options, const std::vector<const Subject*>& row,
              Random* motion, Random* spread, SyntheticRecording* made) {
  double x = 0.0;
  for (const Subject* subject : row) {
    made->skeletons.push_back(subject->skeleton);
    made->parameters.push_back(Spread(subject->parameters, options.recording_spread, spread));
    ScenePerson person;
    person.body = {subject->mass_kg, subject->skeleton.rod_length(),
                   subject->skeleton.cart_height()};
    double y = 0.0;
    if (row.size() > 1) {
      y = motion->Normal(0.0, kSidewaysSigma);
      if (!made->scene.people.empty()) x += motion->Uniform(kLeastSpacing, kMostSpacing);
    }
    const double theta = motion->Normal(0.0, options.lean_sigma_rad);
    const double phi = motion->Normal(0.0, options.lean_sigma_rad);
    person.start.q = {x, y, theta, phi};
    person.start.feet.apart = 2.0 * subject->skeleton.HalfStance().head<2>();
    made->scene.people.push_back(person);
  }
}

// Everything is quoted as a fraction of the rod: pelvis centre to ankles, about 0.52 of a person's
// height (Winter, Biomechanics and Motor Control of Human Movement, segment lengths).
constexpr double kHalfStance = 0.10;   // hip joint to the side of the pelvis centre
constexpr double kAnkleHeight = 0.08;  // above the ground
constexpr double kBone = 0.502;        // thigh, shank: a standing knee is never quite straight

struct JointShape {
  const char* name;
  int parent;
  double x, y, z;  // offset from the parent, rods
};

constexpr std::array<JointShape, kSkeletonJoints> kShapes = {{
    {"Hips", -1, 0, 0, 0},
    {"Spine", 0, 0, 0, 0.11},
    {"Spine1", 1, 0, 0, 0.11},
    {"Spine2", 2, 0, 0, 0.11},
    {"Neck", 3, 0, 0, 0.17},
    {"Head", 4, 0.02, 0, 0.09},
    {"RightClavicle", 3, 0, -0.03, 0.10},
    {"RightShoulder", 6, 0, -0.16, -0.02},
    {"RightElbow", 7, 0, 0, -0.34},
    {"RightWrist", 8, 0, 0, -0.28},
    {"LeftClavicle", 3, 0, 0.03, 0.10},
    {"LeftShoulder", 10, 0, 0.16, -0.02},
    {"LeftElbow", 11, 0, 0, -0.34},
    {"LeftWrist", 12, 0, 0, -0.28},
    {"RightHip", 0, 0, -kHalfStance, 0},
    {"RightKnee", 14, 0, 0, -kBone},
    {"RightAnkle", 15, 0, 0, -kBone},
    {"RightToe", 16, 0.16, 0, -0.9 * kAnkleHeight},
    {"LeftHip", 0, 0, kHalfStance, 0},
    {"LeftKnee", 18, 0, 0, -kBone},
    {"LeftAnkle", 19, 0, 0, -kBone},
    {"LeftToe", 20, 0.16, 0, -0.9 * kAnkleHeight},
}};

// The order of rotations that each leg joint's pose is a product of, so that the channels are the
// angles themselves: hip Rx(phi) Ry(theta - bend), knee Ry(2 bend), ankle Ry(..) Rx(-phi).
std::vector<BvhChannel> LegChannels(bool is_thigh, bool with_position) {
  std::vector<BvhChannel> channels;
  if (with_position) {
    channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  }
  const BvhChannel x = BvhChannel::kXrotation, y = BvhChannel::kYrotation;
  channels.push_back(is_thigh ? x : y);
  channels.push_back(is_thigh ? y : x);
  channels.push_back(BvhChannel::kZrotation);
  return channels;
}

Eigen::Matrix3d RotationXY(double about_x, double about_y) {
  return (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

}  // namespace

Result<std::vector<SyntheticRecording>> MakeSyntheticRecordings(const SyntheticOptions& options) {
  Random root(options.seed);
  Random people(root.Fork()), motion(root.Fork()), spread(root.Fork());
  const uint64_t own_noise = root.Fork();
  Random noise(options.noise_seed != 0 ? options.noise_seed : own_noise);
  Random driving(root.Fork());

  const std::vector<Subject> subjects = DrawSubjects(options, &people, &spread);
  std::vector<SyntheticRecording> result;
  for (int s = 0; s < options.subjects; ++s) {
    std::vector<const Subject*> row;
    for (int n = 0; n < options.people_in_row; ++n) {
      row.push_back(&subjects[(s + n) % subjects.size()]);
    }
    for (int r = 0; r < options.recordings_per_subject; ++r) {
      const PushStrength& strength = options.strengths[r % options.strengths.size()];
      const std::string id = row[0]->id + "_" + TwoDigits(r) + "_" + strength.name;
      SyntheticRecording made;
      made.scene.dt = 1.0 / options.fps;
      PlaceRow(options, row, &motion, &spread, &made);
      if (!options.ground.empty()) {
        made.scene.ground = GroundThrough(options.ground, made.scene.dt);
      }
      std::vector<Vector4<double>> rows =
          DrawPush(options, made.scene.people[0], strength.acceleration, &motion);
      const size_t room = options.frames - 1 - options.push_start_frame;
      if (rows.size() > room) rows.resize(room);
      if (options.pushes) {
        made.scene.pushes.push_back(
            MakeScenePush(0, options.push_start_frame, options.push_kind, rows));
      }

      const RolloutStatus status = RollDriven(options, &driving, &made);
      if (!status.ok) {
        return Error{StrCat("simulated recording ", id, " leaves the model at frame ", status.frame,
                            " (", std::string(status.quantity),
                            "): choose weaker pushes, firmer gains or less spread")};
      }
      Recording& recording = made.recording;
      for (int n = 0; n < options.people_in_row; ++n) {
        recording.people.push_back(ObservePerson(options, made, *row[n], n, &noise));
      }
      recording.ground = made.scene.ground.poses;
      recording.id = id;
      recording.labels.Set(kMagnitudeLabel, strength.name);
      recording.labels.Set(kSettingLabel, row.size() > 1 ? "row" : "single");
      recording.fps = options.fps;
      recording.push_kind = options.push_kind;
      for (const ScenePush& push : made.scene.pushes) {
        recording.pushes.push_back({0, push.start_frame, push.force, "synthetic"});
      }
      result.push_back(std::move(made));
    }
  }
  return result;
}

std::vector<Recording> Recordings(const std::vector<SyntheticRecording>& synthetic) {
  std::vector<Recording> recordings;
  for (const SyntheticRecording& made : synthetic) recordings.push_back(made.recording);
  return recordings;
}

ParameterSet<double> PublishedTailParameters() {
  ParameterSet<double> p{};
  p[kMu] = 30.0;
  p[kKpTheta] = 1800.0;
  p[kKpPhi] = 1500.0;
  p[kKdTheta] = p[kKdPhi] = 70.0;
  p[kAx] = -10.0;
  p[kTailGain] = 1.0;
  p[kTailTorque] = 0.4;
  p[kTailTime] = 0.25;
  return p;
}

ParameterSet<double> PublishedGroupParameters() {
  ParameterSet<double> p = PublishedTailParameters();
  p[kTailExponent] = 1.5;
  p[kContactStiffness] = 2800.0;
  p[kContactDistance] = 0.42;
  p[kContactKappa] = 0.58;
  p[kContactDamping] = 270.0;
  return p;
}

ParameterSet<double> PublishedStanceParameters() {
  ParameterSet<double> p{};
  p[kKpTheta] = 900.0, p[kKpPhi] = 950.0;
  p[kKdTheta] = 200.0, p[kKdPhi] = 320.0;
  p[kTailGain] = 0.3, p[kTailTime] = 0.35, p[kTailBase] = 0.4;
  p[kSupportFront] = 0.12, p[kSupportBack] = 0.08, p[kSupportSide] = 0.03;
  p[kFootFront] = 0.2;
  p[kStepGain] = 0.95, p[kStepOnset] = 0.5, p[kStepSwing] = 0.31;
  return p;
}

// A leg of two equal bones, each tilted by `bend` against the rod: 2 bone cos(bend) = rod.
SyntheticSkeleton::SyntheticSkeleton(double rod_length)
    : rod_(rod_length), bone_(kBone * rod_length), bend_(std::acos(0.5 / kBone)) {}

double SyntheticSkeleton::cart_height() const { return kAnkleHeight * rod_; }

Eigen::Vector3d SyntheticSkeleton::HalfStance() const { return {0.0, kHalfStance * rod_, 0.0}; }

BvhSkeleton SyntheticSkeleton::Bvh(LengthUnit unit) const {
  BvhSkeleton skeleton;
  for (int j = 0; j < kSkeletonJoints; ++j) {
    const JointShape& shape = kShapes[j];
    BvhJoint joint;
    joint.name = shape.name;
    joint.parent = shape.parent;
    const double scale = RowOf(unit).per_metre * rod_;
    joint.offset = scale * Eigen::Vector3d(shape.x, shape.y, shape.z);
    const bool is_leg = j >= 14 && j != 17 && j != 21;
    const bool is_ankle = j == kRightAnkleJoint || j == kLeftAnkleJoint;
    joint.channels =
        is_leg ? LegChannels(j == 14 || j == 18, is_ankle) : DefaultBvhChannels(j == kHipJoint);
    const bool is_leaf = j + 1 == kSkeletonJoints || kShapes[j + 1].parent != j;
    if (is_leaf) joint.end_sites = {scale * Eigen::Vector3d(0.03, 0.0, 0.0)};
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

void SyntheticSkeleton::AppendFrame(const SkeletonPose& pose, LengthUnit unit,
                                    std::vector<double>* values) const {
  const auto append = [values](const Eigen::Vector3d& v) {
    values->insert(values->end(), v.data(), v.data() + 3);
  };
  const auto degrees = [](double radians) { return radians * 180.0 / M_PI; };
  const double scale = RowOf(unit).per_metre;
  const Eigen::Matrix3d thigh = RotationXY(pose.phi, pose.theta - bend_);
  const Eigen::Matrix3d shank = RotationXY(pose.phi, pose.theta + bend_);
  const Eigen::Vector3d bone(0.0, 0.0, -bone_);

  append(scale * pose.hip);
  for (int j = kHipJoint; j < 14; ++j) append(Eigen::Vector3d::Zero());
  for (const bool left : {false, true}) {
    const Eigen::Vector3d hip_joint = pose.hip + (left ? 1.0 : -1.0) * HalfStance();
    const Eigen::Vector3d knee = hip_joint + thigh * bone;
    const Eigen::Vector3d& ankle = left ? pose.left_ankle : pose.right_ankle;
    append({degrees(pose.phi), degrees(pose.theta - bend_), 0.0});
    append({degrees(2.0 * bend_), 0.0, 0.0});
    append(scale * (shank.transpose() * (ankle - knee)));
    append({degrees(-pose.theta - bend_), degrees(-pose.phi), 0.0});
    append(Eigen::Vector3d::Zero());  // toe
  }
}

namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

BvhMotion Motion(const SyntheticRecording& made, int n) {
  BvhMotion motion;
  motion.skeleton = made.skeletons[n].Bvh(kUnit);
  motion.frame_time_s = 1.0 / made.recording.fps;
  const RecordedPerson& person = made.recording.people[n];
  for (int t = 0; t < made.recording.num_frames(); ++t) {
    const PendulumState<double>& state = made.path.At(t, n);
    // Only the angles are used here, which know no origin.
    const Vector4<double> q = InLaboratory(made.scene.ground, t, Vector3<double>::Zero(), state).q;
    made.skeletons[n].AppendFrame(
        {q[2], q[3], person.hip[t], person.left_ankle[t], person.right_ankle[t]}, kUnit,
        &motion.values);
  }
  return motion;
}

// The name of a person's files: in a row one for each.
std::string OfPerson(const Recording& recording, size_t n) {
  return recording.id + (recording.people.size() > 1 ? StrCat("_", n) : "");
}

ManifestRecording Entry(const SyntheticRecording& made, const std::vector<std::string>& bvh,
                        const std::string& csv) {
  const Recording& recording = made.recording;
  const std::vector<BvhJoint> joints = made.skeletons[0].Bvh(kUnit).joints;
  ManifestRecording entry = EntryOf(recording);
  for (const RecordedPerson& person : recording.people) {
    entry.subjects.push_back({person.subject_id, person.mass_kg});
  }
  entry.motion = bvh;
  entry.joints.Set(kBodyHip, JointReference{joints[kHipJoint].name});
  entry.joints.Set(kLeftAnkle, JointReference{joints[kLeftAnkleJoint].name});
  entry.joints.Set(kRightAnkle, JointReference{joints[kRightAnkleJoint].name});
  if (recording.pushes.empty()) return entry;
  const int start = recording.pushes[0].start_frame;
  if (start == 0) entry.push_csv = csv;
  if (start > 0) entry.pushes = {{0, csv, start}};
  return entry;
}

}  // namespace

MaybeError WriteSyntheticRecordings(const std::string& folder, const SyntheticOptions& options,
                                    const std::vector<SyntheticRecording>& recordings) {
  return Caught([&] {
    for (const char* sub : {"/bvh", "/push"}) OrThrow(MakeFolder(folder + sub));
    Manifest manifest;
    manifest.length.length_unit = kUnit;
    auto& about = (*manifest.json)["synthetic"];
    about["seed"] = options.seed;
    about["stance"] = NameOf(options.model.stance);
    about["joint_noise_m"] = options.joint_noise_m;
    const auto add_truth = [&](int i) {
      about["truth"][std::string(kParameterNames[i])] = options.parameters[i];
    };
    for (int i = 0; i < kFirstOwnParameter; ++i) {
      if (!IsNoiseParameter(static_cast<Parameter>(i))) add_truth(i);
    }
    const bool driven = options.model.process_noise != ProcessNoise::kNone;
    for (int i = kFirstNoiseParameter; driven && i < kMeasuredCart; ++i) add_truth(i);
    // The cart is the middle of two ankles.
    about["truth"]["measured_cart"] = options.joint_noise_m / std::sqrt(2.0);
    about["truth"]["measured_hip"] = options.joint_noise_m;
    for (const SyntheticRecording& made : recordings) {
      const std::string csv = "push/" + made.recording.id + ".csv";
      std::vector<std::string> bvh;
      for (int n = 0; n < made.scene.num_people(); ++n) {
        bvh.push_back("bvh/" + OfPerson(made.recording, n) + ".bvh");
        OrThrow(WriteBvh(folder + "/" + bvh.back(), Motion(made, n)));
      }
      if (!made.recording.pushes.empty()) {
        OrThrow(WritePushCsv(folder + "/" + csv, made.recording.pushes[0].force));
      }
      manifest.recordings.push_back(Entry(made, bvh, csv));
    }
    OrThrow(WriteManifest(folder + "/manifest.json", manifest));
  });
}

}  // namespace pushid
