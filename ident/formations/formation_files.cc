#include "ident/formations/formation_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/trajectories.h"
#include "datasets/manifest/manifest.h"
#include "ident/figures/chart.h"
#include "ident/figures/svg.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

double InUnit(double metres) { return RowOf(kUnit).per_metre * metres; }

double Degrees(double radians) { return radians * 180.0 / M_PI; }

BvhMotion PendulumMotion(const FormationRun& run, int person) {
  const Body& body = run.recording.scene.people[person].body;
  const Eigen::Vector2d half = 0.5 * run.recording.scene.people[person].start.feet.apart;
  const double rod = InUnit(body.rod_length), x = InUnit(half.x()), y = InUnit(half.y());
  const std::vector<BvhChannel> rotations = {BvhChannel::kXrotation, BvhChannel::kYrotation,
                                             BvhChannel::kZrotation};
  BvhMotion motion;
  motion.skeleton.joints = {
      {"Cart", -1, {0, 0, 0}, DefaultBvhChannels(true), {}},
      {"Rod", 0, {0, 0, 0}, rotations, {}},
      // A mark above the hip, so that viewers draw more than a point.
      {"Hips", 1, {0, 0, rod}, DefaultBvhChannels(false), {{0, 0, 0.1 * rod}}},
      {"LeftAnkle", 0, {x, y, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
      {"RightAnkle", 0, {-x, -y, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
  };
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

constexpr double kWaveWidth = 960, kWaveHeight = 380;  // pixels, of all people
constexpr double kFastWalk = 2.5;  // m/s; faster than that somebody falls, and colours saturate
constexpr int kColours = 48;       // levels of speed that are told apart, either way
constexpr char kPushFrame[] = "fill:none;stroke:#ff5a36;stroke-width:2";
constexpr char kBandBorder[] = "stroke:#000;stroke-width:4";
constexpr char kBandLine[] = "stroke:#fff;stroke-width:2";
constexpr char kOnsetDot[] = "fill:#fff;stroke:#000;stroke-width:1";

// The colour goes with the root of the speed: a wave that fades stays visible.
int LevelOf(double speed, double full) {
  const double share = full > 0.0 ? std::sqrt(std::min(1.0, std::abs(speed) / full)) : 0.0;
  const int level = static_cast<int>(std::lround(share * (kColours - 1)));
  return speed < 0.0 ? -level : level;
}

std::string LevelLook(int level) {
  return "stroke:none;fill:" + SignedColourOf(level / (kColours - 1.0));
}

// Frames of the same level are one bar. Speeds are negative of who goes back more than aside.
void AddSpeeds(const FormationRun& run, int person, double full, Chart* chart) {
  const auto level = [&](int t) { return LevelOf(HipSpeed(run, person, t), full); };
  for (int begin = 0, end = 0; begin < run.num_frames(); begin = end) {
    while (end < run.num_frames() && level(end) == level(begin)) ++end;
    chart->bars.push_back({static_cast<double>(person), run.Seconds(begin), run.Seconds(end),
                           LevelLook(level(begin))});
  }
}

// A dot, over a light bar with dark ends, seen on every colour.
void AddOnset(const FormationRun& run, int person, const std::vector<OnsetBand>& onsets,
              Chart* chart) {
  const int onset = run.summaries[person].onset_frame;
  const double y = person;
  if (onset < 0) return;
  if (!onsets.empty() && onsets[person].moved > 0.0) {
    const double from = onsets[person].from, to = onsets[person].to;
    chart->lines.push_back({{{from, y}, {to, y}}, kBandBorder});
    chart->lines.push_back({{{from, y}, {to, y}}, kBandLine});
    for (double x : {from, to}) {
      chart->lines.push_back({{{x, y - 0.3}, {x, y + 0.3}}, kBandBorder});
    }
  }
  chart->lines.push_back({{{run.Seconds(onset), y}}, kOnsetDot, true});
}

}  // namespace

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
  ManifestRecording entry;
  entry.id = run.recording.id;
  entry.labels = run.recording.labels;
  entry.labels.Set(kMagnitudeLabel, "simulated");
  entry.fps = 1.0 / scene.dt;
  entry.frames = run.num_frames();
  entry.pushed_person = run.recording.pushed_person;
  if (!scene.pushes.empty()) {
    entry.push_kind = scene.pushes.front().kind;
  }
  entry.joints.Set(kBodyHip, JointReference{"Hips"});
  entry.joints.Set(kLeftAnkle, JointReference{"LeftAnkle"});
  entry.joints.Set(kRightAnkle, JointReference{"RightAnkle"});
  for (int n = 0; n < run.num_people(); ++n) {
    const std::string& name = run.recording.subject_ids[n];
    entry.subjects.push_back({name, scene.people[n].body.mass});
    entry.motion.push_back("bvh/" + name + ".bvh");
    const MaybeError failed = WriteBvh(folder + "/" + entry.motion.back(), PendulumMotion(run, n));
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
  manifest.length.length_unit = kUnit;
  (*manifest.json)["synthetic"]["formation"] = true;  // made by a model: may be overwritten
  manifest.recordings = {entry};
  return WriteManifest(folder + "/manifest.json", manifest);
}

std::string WaveSvg(const FormationRun& run, const std::string& title,
                    const std::vector<OnsetBand>& onsets) {
  double fastest = 0.0;
  for (const PersonSummary& person : run.summaries) fastest = std::max(fastest, person.peak_speed);
  const double full = std::min(fastest, kFastWalk);
  Chart chart{"person (x, y in m); colour: speed of the hip", "time, s"};
  chart.y_label = full < fastest
                      ? "saturated from " + Rounded(full, 3) + " on; fastest " + Rounded(fastest, 3)
                      : "full colour: " + Rounded(full, 3) + ", the fastest";
  chart.width = kWaveWidth;
  chart.row = std::clamp(kWaveHeight / run.num_people(), 3.0, 30.0);
  chart.bar = 1.0;
  chart.x_from = 0.0, chart.x_to = run.Seconds(run.num_frames());
  const int every = chart.row >= 11.0 ? 1 : chart.row >= 5.0 ? 5 : 10;
  for (int n = 0; n < run.num_people(); ++n) {
    const Vector4<double>& q = run.recording.scene.people[n].start.q;
    const Outcome outcome = run.summaries[n].outcome;
    const bool told = outcome == Outcome::kFell || (outcome == Outcome::kSlow && every == 1);
    chart.y_categories.push_back(n % every > 0 ? ""
                                               : std::to_string(n) + "  (" + SvgNumber(q[0]) +
                                                     ", " + SvgNumber(q[1]) + ")");
    // There is no room for "slow to settle".
    chart.y_notes.push_back(!told ? "" : outcome == Outcome::kSlow ? "slow" : NameOf(outcome));
    AddSpeeds(run, n, full, &chart);
    AddOnset(run, n, onsets, &chart);
  }
  for (const ScenePush& push : run.recording.scene.pushes) {
    chart.bars.push_back({static_cast<double>(push.person), run.Seconds(push.start_frame),
                          run.Seconds(push.EndFrame()), kPushFrame});
  }
  Figure figure{{}, {chart}, title};
  for (double share : {-1.0, -0.25, 0.0, 0.25, 1.0}) {
    figure.legend.push_back({Rounded(std::abs(share) * full, 2) + " m/s" +
                                 (share < 0.0   ? " back"
                                  : share > 0.0 ? " forward or aside"
                                                : ""),
                             LevelLook(LevelOf(share * full, full))});
  }
  figure.legend.push_back({"push", kPushFrame});
  figure.legend.push_back({"onset: the hip has moved 2 cm", kOnsetDot});
  if (!onsets.empty()) {
    figure.legend.push_back({"90 % interval from the uncertainty of the parameters", kBandBorder});
  }
  return DrawFigure(figure, kWaveWidth, title).ToString();
}

}  // namespace pushid
