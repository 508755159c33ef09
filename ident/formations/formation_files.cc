// ident: CSV of the forces, BVH of the pendulums.
#include "ident/formations/formation_files.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "datasets/exchange/crowd.h"
#include "datasets/files/atomic_file.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/manifest/manifest.h"
#include "models/contact.h"
#include "models/self_force.h"

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
  ChoosePoints({}, &motion);
  return WriteTrajectories(path, motion);
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

namespace {

using Json = nlohmann::ordered_json;

// What of the model agents lack; empty: nothing.
std::string Untold(const IdentifiedModel& model) {
  const ModelOptions& o = model.options;
  if (o.stance != Stance::kSlide) return "feet that hold (--stance=slide)";
  if (o.delay != Delay::kNone) return "a reaction delay (--delay=none)";
  if (o.friction == FrictionKind::kCoulomb) return "dry friction (--friction=isotropic)";
  if (o.cart_derivative != CartDerivative::kNone) return "a derivative of the cart's velocity";
  if (o.learned != nullptr) return "a network";
  if (!o.own_laws.empty()) return "laws of your own";
  if (o.interaction.Any() && !o.interaction.Mutual()) return "LDP's or a learned interaction";
  return "";
}

Json PairOf(double x, double y) { return Json::array({x + 0.0, y + 0.0}); }  // no -0

Json AgentOf(const IdentifiedModel& model, const ScenePerson& person, const std::string& id,
             double dt) {
  const ParameterSet<double>& p = model.parameters;
  const Body& body = person.body;
  const SelfForce self(model.options, body, person.start.q, dt);
  const GainScale& scale = self.scale;
  const double mass = body.mass,
               inertia = body.point_mass() * body.pendulum_length() * body.pendulum_length();
  const double touches = model.options.interaction.Any() ? 0.5 * p[kContactDistance] : 0.0;
  Json agent = {{"id", id},
                {"radius_m", touches},
                {"mass_kg", mass},
                {"point_mass_kg", body.point_mass()},
                {"rod_m", body.rod_length},
                {"pendulum_m", body.pendulum_length()},
                {"position_m", PairOf(person.start.q[0], person.start.q[1])},
                {"lean_rad", PairOf(person.start.q[2], person.start.q[3])}};
  agent["balance"] = {
      {"stiffness_Nm_per_rad", PairOf(scale.stiffness * p[kKpTheta], scale.stiffness * p[kKpPhi])},
      {"damping_Nms_per_rad", PairOf(scale.damping * p[kKdTheta], scale.damping * p[kKdPhi])},
      {"posture_rad", PairOf(self.posture[0], self.posture[1])},
      {"hold_Nm", PairOf(self.hold[0], self.hold[1])}};
  agent["steps"] = {{"drag_Ns_per_m",
                     PairOf(scale.force * (p[kMu] + p[kKpX]),
                            scale.force * (p[FrictionAlongY(model.options.friction)] + p[kKpY]))},
                    {"speed_drag_Ns2_per_m2", mass * p[kCq]},
                    {"lean_N_per_rad", PairOf(mass * p[kAx], mass * p[kAy])},
                    {"lean_rate_Ns_per_rad", PairOf(mass * p[kBx], mass * p[kBy])},
                    {"speed_torque_Ns", PairOf(mass * p[kTx], mass * p[kTy])},
                    {"rate_drag_Nms2_per_rad2", inertia * p[kDq]}};
  return agent;
}

}  // namespace

Result<Json> AgentsJson(const FormationRun& run, const IdentifiedModel& model) {
  const std::string untold = Untold(model);
  if (!untold.empty()) return Error{"agents cannot have what the model has: " + untold};
  const Scene& scene = run.recording.scene;
  const ParameterSet<double>& p = model.parameters;
  Json json = {{"schema", "pushid-agents/1"}, {"time_step_s", scene.dt}};
  for (int n = 0; n < scene.num_people(); ++n) {
    json["agents"].push_back(
        AgentOf(model, scene.people[n], run.recording.subject_ids[n], scene.dt));
  }
  const InteractionTerms& terms = model.options.interaction;
  if (terms.Any()) {
    json["contact"] = {{"stiffness_N_per_m", terms.spring ? p[kContactStiffness] : 0.0},
                       {"damping_Ns_per_m", terms.damping ? p[kContactDamping] : 0.0},
                       {"distance_m", p[kContactDistance]},
                       {"depth_over_width", p[kContactKappa]},
                       {"height_of_rod", p[kContactHeight]},
                       {"onset_m", kContactOnset},
                       {"softness_m", kContactSoftness}};
  }
  json["pushes"] = Json::array();
  for (const ScenePush& push : scene.pushes) {
    Json rows = Json::array();
    for (const Vector4<double>& row : push.force) rows.push_back({row[0], row[1], row[2], row[3]});
    json["pushes"].push_back({{"agent", run.recording.subject_ids[push.person]},
                              {"start_s", push.start_frame * scene.dt},
                              {"force_N_N_Nm_Nm", rows}});
  }
  return json;
}

}  // namespace pushid
