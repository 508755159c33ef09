// ident: CSV of the forces, BVH of the pendulums.
#include "ident/formations/formation_files.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "datasets/files/atomic_file.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/trajectories.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;
constexpr double kHalfStance = 0.1;  // m, from the cart to an ankle

double InUnit(double metres) { return ConvertLength(metres, LengthUnit::kMetre, kUnit); }

double Degrees(double radians) { return radians * 180.0 / M_PI; }

BvhSkeleton PendulumSkeleton(const Body& body) {
  const double rod = InUnit(body.rod_length), side = InUnit(kHalfStance);
  const std::vector<BvhChannel> rotations = {BvhChannel::kXrotation, BvhChannel::kYrotation,
                                             BvhChannel::kZrotation};
  BvhSkeleton skeleton;
  skeleton.joints = {
      {"Cart", -1, {0, 0, 0}, DefaultBvhChannels(true), {}},
      {"Rod", 0, {0, 0, 0}, rotations, {}},
      // A mark above the hip, so that viewers draw more than a point.
      {"Hips", 1, {0, 0, rod}, DefaultBvhChannels(false), {{0, 0, 0.1 * rod}}},
      {"LeftAnkle", 0, {0, side, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
      {"RightAnkle", 0, {0, -side, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
  };
  return skeleton;
}

BvhMotion PendulumMotion(const FormationRun& run, int person) {
  const Body& body = run.recording.scene.people[person].body;
  BvhMotion motion;
  motion.skeleton = PendulumSkeleton(body);
  motion.length_unit = kUnit;
  motion.frame_time_s = run.recording.scene.dt;
  for (int t = 0; t < run.num_frames(); ++t) {
    const Vector4<double>& q = run.prediction.path.At(t, person).q;
    std::vector<double> row(motion.skeleton.num_channels(), 0.0);
    row[0] = InUnit(q[0]);
    row[1] = InUnit(q[1]);
    row[2] = InUnit(body.cart_height);
    row[6] = Degrees(q[3]);  // Rx(phi) Ry(theta) turns the upright rod into that of HipPosition
    row[7] = Degrees(q[2]);
    motion.values.insert(motion.values.end(), row.begin(), row.end());
  }
  return motion;
}

ManifestRecording Entry(const FormationRun& run) {
  ManifestRecording entry;
  entry.id = run.recording.id;
  entry.labels = run.recording.labels;
  entry.labels.Set(kMagnitudeLabel, "simulated");
  entry.fps = 1.0 / run.recording.scene.dt;
  entry.frames = run.num_frames();
  entry.pushed_person = run.recording.pushed_person;
  entry.push_kind = PushKind::kExternal;
  entry.joints.hip = JointReference{"Hips"};
  entry.joints.left_ankle = JointReference{"LeftAnkle"};
  entry.joints.right_ankle = JointReference{"RightAnkle"};
  return entry;
}

}  // namespace

MaybeError WriteForcesCsv(const std::string& path, const FormationRun& run) {
  AtomicFile file;
  if (MaybeError failed = file.Open(path)) return failed;
  file.Append("frame,time_s,person,part,fx_N,fy_N,ftheta_Nm,fphi_Nm\n");
  const std::vector<ForcePart> parts = ActingParts(run);
  const auto row = [&](int t, int n, std::string_view part, const Vector4<double>& f) {
    char text[256];
    std::snprintf(text, sizeof text, "%d,%.9g,%d,%.*s,%.9g,%.9g,%.9g,%.9g\n", t, run.Seconds(t), n,
                  static_cast<int>(part.size()), part.data(), f[0] + 0.0, f[1] + 0.0, f[2] + 0.0,
                  f[3] + 0.0);  // no -0
    file.Append(text);
  };
  for (int t = 0; t < run.num_frames(); ++t) {
    for (int n = 0; n < run.num_people(); ++n) {
      const NetForce<double>& force = run.Force(n, t);
      for (ForcePart part : parts) row(t, n, NameOf(part), force[part]);
      row(t, n, "net", force.Total());
    }
  }
  return file.Commit();
}

MaybeError WriteFormationTrajectories(const std::string& path, const FormationRun& run) {
  PointMotion motion;
  motion.rate_hz = 1.0 / run.recording.scene.dt;
  motion.names = run.recording.subject_ids;
  motion.positions = run.prediction.hip;
  return WriteTrajectoryText(path, motion);
}

MaybeError WriteFormationRecording(const std::string& folder, const FormationRun& run) {
  for (const char* sub : {"/bvh", "/push"}) {
    if (MaybeError failed = MakeFolder(folder + sub)) return failed;
  }
  // An earlier run's manifest must not describe a mixture of both, should this one break off.
  std::error_code ignored;
  std::filesystem::remove(folder + "/manifest.json", ignored);
  const Scene& scene = run.recording.scene;
  ManifestRecording entry = Entry(run);
  for (int n = 0; n < run.num_people(); ++n) {
    const std::string& name = run.recording.subject_ids[n];
    entry.subjects.push_back({name, scene.people[n].body.mass});
    entry.motion.push_back("bvh/" + name + ".bvh");
    const MaybeError failed =
        WriteBvh(folder + "/" + entry.motion.back(), PendulumMotion(run, n), kUnit);
    if (failed) return failed;
  }
  for (size_t i = 0; i < scene.pushes.size(); ++i) {
    const ScenePush& push = scene.pushes[i];
    entry.pushes.push_back({push.person, "push/" + std::to_string(i) + ".csv", push.start_frame});
    if (MaybeError failed = WritePushCsv(folder + "/" + entry.pushes.back().csv, push.force)) {
      return failed;
    }
  }
  Manifest manifest;
  manifest.length_unit = kUnit;
  (*manifest.json)["synthetic"]["formation"] = true;  // made by a model: may be overwritten
  manifest.recordings = {entry};
  return WriteManifest(folder + "/manifest.json", manifest);
}

}  // namespace pushid
