// ident: files of a formation, the picture of its wave, and feet from above.
#include "ident/formations/formation_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/bvh.h"
#include "datasets/formats/force_csv.h"
#include "datasets/formats/trajectories.h"
#include "datasets/manifest/manifest.h"
#include "ident/bodies/animation.h"
#include "ident/figures/svg.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {
namespace {

constexpr LengthUnit kUnit = LengthUnit::kMillimetre;

double InUnit(double metres) { return ConvertLength(metres, LengthUnit::kMetre, kUnit); }

double Degrees(double radians) { return radians * 180.0 / M_PI; }

BvhSkeleton PendulumSkeleton(const ScenePerson& person) {
  const double rod = InUnit(person.body.rod_length);
  const Eigen::Vector2d half = 0.5 * person.start.feet.apart;
  const double x = InUnit(half.x()), y = InUnit(half.y());
  const std::vector<BvhChannel> rotations = {BvhChannel::kXrotation, BvhChannel::kYrotation,
                                             BvhChannel::kZrotation};
  BvhSkeleton skeleton;
  skeleton.joints = {
      {"Cart", -1, {0, 0, 0}, DefaultBvhChannels(true), {}},
      {"Rod", 0, {0, 0, 0}, rotations, {}},
      // A mark above the hip, so that viewers draw more than a point.
      {"Hips", 1, {0, 0, rod}, DefaultBvhChannels(false), {{0, 0, 0.1 * rod}}},
      {"LeftAnkle", 0, {x, y, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
      {"RightAnkle", 0, {-x, -y, 0}, DefaultBvhChannels(false), {{0, 0, 0}}},
  };
  return skeleton;
}

BvhMotion PendulumMotion(const FormationRun& run, int person) {
  const Body& body = run.recording.scene.people[person].body;
  BvhMotion motion;
  motion.skeleton = PendulumSkeleton(run.recording.scene.people[person]);
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
  if (!run.recording.scene.pushes.empty()) {
    entry.push_kind = run.recording.scene.pushes.front().kind;
  }
  entry.joints.hip = JointReference{"Hips"};
  entry.joints.left_ankle = JointReference{"LeftAnkle"};
  entry.joints.right_ankle = JointReference{"RightAnkle"};
  return entry;
}

constexpr double kWaveLeft = 112, kWaveTop = 40, kMapWidth = 610, kWaveWidth = 960, kSide = 770;
constexpr double kFastWalk = 2.5;  // m/s; faster than that somebody falls, and colours saturate
constexpr int kColours = 48;       // levels of speed that are told apart, either way
constexpr char kPushFrame[] = "fill:none;stroke:#ff5a36;stroke-width:2";
constexpr char kBandBorder[] = "stroke:#000;stroke-width:4";
constexpr char kBandLine[] = "stroke:#fff;stroke-width:2";
constexpr char kOnsetDot[] = "fill:#fff;stroke:#000;stroke-width:1";

class WavePicture {
 public:
  WavePicture(const FormationRun& run, const std::string& title,
              const std::vector<OnsetBand>& onsets)
      : run_(run),
        onsets_(onsets),
        row_(std::clamp(380.0 / run.num_people(), 3.0, 30.0)),
        bottom_(kWaveTop + row_ * run.num_people()),
        time_(0.0, run.Seconds(run.num_frames()), kWaveLeft, kWaveLeft + kMapWidth),
        svg_(kWaveWidth, std::max(bottom_ + 62.0, 400.0), title) {
    for (const PersonSummary& person : run.summaries)
      fastest_ = std::max(fastest_, person.peak_speed);
    full_ = std::min(fastest_, kFastWalk);
    svg_.Text(kWaveLeft, 22, title, "ink bold");
  }

  std::string Draw() {
    for (int n = 0; n < run_.num_people(); ++n) Row(n);
    for (int n = 0; n < run_.num_people(); ++n) Label(n);
    Marks();
    TimeAxis();
    ColourBar();
    return svg_.ToString();
  }

 private:
  double RowTop(int person) const { return kWaveTop + row_ * person; }
  // The colour goes with the root of the speed: a wave that fades stays visible.
  double Fraction(double speed) const {
    return full_ > 0.0 ? std::sqrt(std::min(1.0, speed / full_)) : 0.0;
  }
  // Negative for a person who goes back more than aside.
  int Level(int person, int frame) const {
    const double speed = SignedHipSpeed(run_, person, frame);
    const int level = static_cast<int>(std::lround(Fraction(std::abs(speed)) * (kColours - 1)));
    return speed < 0.0 ? -level : level;
  }

  // Frames of the same level are one rectangle.
  void Row(int person) {
    for (int begin = 0, end = 0; begin < run_.num_frames(); begin = end) {
      const int level = Level(person, begin);
      while (end < run_.num_frames() && Level(person, end) == level) ++end;
      const double x = time_(run_.Seconds(begin));
      // Overlaps the next one, for rounded numbers would leave gaps.
      const double overlap = end < run_.num_frames() ? 0.5 : 0.0;
      svg_.Rect({x, RowTop(person), time_(run_.Seconds(end)) - x + overlap, row_},
                "fill:" + SignedColourOf(level / (kColours - 1.0)));
    }
  }

  void Label(int person) {
    const int every = row_ >= 11.0 ? 1 : row_ >= 5.0 ? 5 : 10;
    const double y = RowTop(person) + 0.5 * row_ + 4.0;
    if (person % every == 0) {
      const Vector4<double>& q = run_.recording.scene.people[person].start.q;
      svg_.Text(kWaveLeft - 8, y,
                std::to_string(person) + "  (" + SvgNumber(q[0]) + ", " + SvgNumber(q[1]) + ")",
                "ink small end");
    }
    const Outcome outcome = run_.summaries[person].outcome;
    if (outcome == Outcome::kFell || (outcome == Outcome::kSlow && every == 1)) {
      // There is no room for "slow to settle".
      svg_.Text(kWaveLeft + kMapWidth + 4, y, outcome == Outcome::kSlow ? "slow" : NameOf(outcome),
                "ink small");
    }
  }

  void Marks() {
    for (const ScenePush& push : run_.recording.scene.pushes) {
      const double x = time_(run_.Seconds(push.start_frame));
      svg_.Rect({x, RowTop(push.person) + 1, time_(run_.Seconds(push.EndFrame())) - x, row_ - 2},
                kPushFrame);
    }
    for (int n = 0; n < run_.num_people(); ++n) {
      const int onset = run_.summaries[n].onset_frame;
      if (onset < 0) continue;
      Band(n);
      svg_.Circle(time_(run_.Seconds(onset)), RowTop(n) + 0.5 * row_, std::min(4.0, 0.4 * row_),
                  kOnsetDot);
    }
  }

  // Under the dot: a light bar with dark ends, seen on every colour.
  void Band(int person) {
    if (onsets_.empty() || onsets_[person].moved == 0.0) return;
    const double y = RowTop(person) + 0.5 * row_, half = std::min(4.0, 0.3 * row_);
    const double from = time_(onsets_[person].from), to = time_(onsets_[person].to);
    svg_.Line(from, y, to, y, kBandBorder);
    svg_.Line(from, y, to, y, kBandLine);
    for (const double x : {from, to}) svg_.Line(x, y - half, x, y + half, kBandBorder);
  }

  void TimeAxis() {
    svg_.Line(kWaveLeft, bottom_, kWaveLeft + kMapWidth, bottom_, "axis");
    for (double t : time_.Ticks(8)) {
      svg_.Line(time_(t), bottom_, time_(t), bottom_ + 4, "axis");
      svg_.Text(time_(t), bottom_ + 17, SvgNumber(t), "ink small middle");
    }
    svg_.Text(kWaveLeft + 0.5 * kMapWidth, bottom_ + 33, "time (s)", "ink middle");
    svg_.Text(kWaveLeft - 8, kWaveTop - 8, "person (x, y in m)", "faint small end");
    const double y = bottom_ + 50;
    svg_.Rect({kWaveLeft, y - 9, 16, 10}, kPushFrame);
    svg_.Text(kWaveLeft + 22, y, "push", "faint small");
    svg_.Circle(kWaveLeft + 68, y - 4, 4, kOnsetDot);
    const std::string onset = "onset: the hip has moved 2 cm";
    svg_.Text(
        kWaveLeft + 78, y,
        onset +
            (onsets_.empty() ? "" : "; bar: 90 % interval from the uncertainty of the parameters"),
        "faint small");
  }

  void ColourBar() {
    constexpr double kHalf = 80.0, kStep = kHalf / kColours;
    const double middle = kSide + kHalf;
    svg_.Text(kSide, kWaveTop + 2, "speed of the hip (m/s)", "ink");
    for (int k = -kColours; k < kColours; ++k) {
      svg_.Rect({middle + kStep * k, kWaveTop + 10, kStep, 12},
                "fill:" + SignedColourOf((k + 0.5) / kColours));
    }
    for (double v : SvgScale(0.0, full_, 0.0, 1.0).Ticks(2)) {
      for (double side : {-1.0, 1.0}) {
        const double x = middle + side * kHalf * Fraction(v);
        svg_.Line(x, kWaveTop + 22, x, kWaveTop + 26, "axis");
        if (v > 0.0 || side > 0.0) svg_.Text(x, kWaveTop + 37, SvgNumber(v), "ink small middle");
      }
    }
    svg_.Text(kSide, kWaveTop + 51, "back", "ink small");
    svg_.Text(middle + kHalf, kWaveTop + 51, "forward or aside", "ink small end");
    svg_.Text(kSide, kWaveTop + 66,
              full_ < fastest_
                  ? "saturated from " + Rounded(full_, 3) + " on; fastest " + Rounded(fastest_, 3)
                  : "full colour: " + Rounded(full_, 3) + ", the fastest",
              "faint small");
  }

  const FormationRun& run_;
  const std::vector<OnsetBand>& onsets_;  // empty: none are drawn
  const double row_, bottom_;
  const SvgScale time_;
  double fastest_ = 0.0, full_ = 0.0;  // m/s; the speed of full colour
  SvgPicture svg_;
};

constexpr double kSoleWidth = 0.09;                 // m
constexpr double kAir = 0.15, kShortestFeet = 1.2;  // m
constexpr double kPixelsPerMetre = 300, kWidestFeet = 1000, kSmallestFigure = 640;
constexpr int kCornersOfSole = 24;

constexpr char kSeenSoleLook[] = "ink";
constexpr char kPredictedSoleLook[] = "stroke:none;fill:#3b82f6;fill-opacity:.28";

// Feet of one person by one source.
struct FeetTrack {
  int person;
  bool predicted;
  std::vector<Footprint> prints;
  std::vector<Eigen::Vector2d> capture;
};

std::vector<FeetTrack> TracksOf(const FormationRun& run) {
  std::vector<FeetTrack> tracks;
  const auto add = [&](const FootprintsOfPeople& prints, const HipPaths& hips, bool predicted) {
    for (size_t n = 0; n < prints.size(); ++n) {
      const double rod = run.recording.scene.people[n].body.rod_length;
      tracks.push_back({static_cast<int>(n), predicted, prints[n],
                        CapturePath(hips[n], rod, run.recording.scene.dt)});
    }
  };
  const FootprintsOfPeople predicted = PredictedFootprints(run.recording, run.prediction);
  if (!run.prediction.status.ok || predicted.empty()) return tracks;
  add(RecordedFootprints(run.recording), run.recording.hip, false);
  add(predicted, run.prediction.hip, true);
  return tracks;
}

// An ellipse, closed.
ChartPoints SoleOutline(const Eigen::Vector2d& ankle, double facing) {
  const Eigen::Rotation2Dd turn(facing);
  ChartPoints outline;
  for (int i = 0; i <= kCornersOfSole; ++i) {
    const double angle = 2.0 * M_PI * i / kCornersOfSole;
    const Eigen::Vector2d corner =
        ankle + turn * Eigen::Vector2d(0.5 * ((kSoleBefore - kSoleBehind) +
                                              (kSoleBefore + kSoleBehind) * std::cos(angle)),
                                       0.5 * kSoleWidth * std::sin(angle));
    outline.emplace_back(corner[0], corner[1]);
  }
  return outline;
}

// The landing's time in a predicted sole, and beside a recorded one, where feet do not meet.
void AddSole(const FormationRun& run, const Footprint& print, bool predicted, Chart* chart) {
  const double facing = run.recording.facing;
  const ChartPoints outline = SoleOutline(print.place, facing);
  if (predicted) {
    chart->bands.push_back({outline, {}, kPredictedSoleLook});
  } else {
    chart->lines.push_back({outline, kSeenSoleLook});
  }
  if (print.landing == 0) return;
  const double side = print.foot == Foot::kLeft ? 1.0 : -1.0;
  const Eigen::Vector2d at =
      print.place +
      Eigen::Rotation2Dd(facing) * Eigen::Vector2d(0.5 * (kSoleBefore - kSoleBehind),
                                                   predicted ? 0.0 : 0.9 * side * kSoleWidth);
  chart->labels.push_back({at[0], at[1], Rounded(run.Seconds(print.landing), 3) + " s", "ink"});
}

// Everything in it, with some air and a least size, and as wide as metres need.
void FitMap(Chart* chart) {
  Eigen::Array2d low(INFINITY, INFINITY), high = -low;
  const auto see = [&](const ChartPoints& points) {
    for (const auto& [x, y] : points) {
      low = low.min(Eigen::Array2d(x, y));
      high = high.max(Eigen::Array2d(x, y));
    }
  };
  for (const ChartLine& line : chart->lines) see(line.points);
  for (const ChartBand& band : chart->bands) see(band.lower);
  low -= kAir, high += kAir;
  const double more = std::max(0.0, 0.5 * (kShortestFeet - (high - low)[0]));
  chart->is_map = true;
  chart->x_from = low[0] - more, chart->x_to = high[0] + more;
  chart->y_from = low[1], chart->y_to = high[1];
  chart->width = std::min(kWidestFeet, kPixelsPerMetre * (*chart->x_to - *chart->x_from));
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

std::string WaveSvg(const FormationRun& run, const std::string& title,
                    const std::vector<OnsetBand>& onsets) {
  return WavePicture(run, title, onsets).Draw();
}

std::optional<Figure> FeetFigure(const FormationRun& run) {
  Chart chart{"feet from above", "forward, m", "to the left, m"};
  bool recorded = false;
  for (const FeetTrack& track : TracksOf(run)) {
    recorded = recorded || !track.predicted;
    for (const Footprint& print : track.prints) AddSole(run, print, track.predicted, &chart);
    ChartPoints capture;
    for (const Eigen::Vector2d& point : track.capture) capture.emplace_back(point[0], point[1]);
    chart.lines.push_back({capture, track.predicted ? kPredictedLook : kMeasuredLook});
    if (run.num_people() < 2) continue;
    const Vector4<double>& q = run.recording.scene.people[track.person].start.q;
    chart.labels.push_back({q[0], q[1], run.recording.subject_ids[track.person], "faint"});
  }
  if (chart.lines.empty()) return std::nullopt;
  FitMap(&chart);
  Figure figure;
  if (recorded) figure.legend = {{"recorded feet and capture point", kMeasuredLook}};
  figure.legend.push_back({"predicted capture point", kPredictedLook});
  figure.legend.push_back({"predicted feet", kPredictedSoleLook});
  figure.panels = {chart};
  return figure;
}

std::vector<std::string> FeetSvg(const FormationRun& run) {
  const std::optional<Figure> feet = FeetFigure(run);
  if (!feet) return {};
  const Chart& chart = feet->panels.front();
  const double width = std::max(chart.width, kSmallestFigure);
  return {DrawFigure(*feet, width, chart.title).ToInline()};
}

TextTable FeetNumbers(const FormationRun& run) {
  TextTable table({"person", "source", "what", "from_s", "to_s", "x_m", "y_m"});
  for (const FeetTrack& track : TracksOf(run)) {
    const auto add = [&](const std::string& what, int from, int to, const Eigen::Vector2d& place) {
      table.Add({run.recording.subject_ids[track.person],
                 track.predicted ? "predicted" : "recorded", what, DoubleText(run.Seconds(from)),
                 DoubleText(run.Seconds(to)), DoubleText(place[0]), DoubleText(place[1])});
    };
    for (const Footprint& print : track.prints) {
      add(NameOf(print.foot) + " foot", print.landing, print.lift_off, print.place);
    }
    for (size_t t = 0; t < track.capture.size(); ++t) {
      add("capture point", static_cast<int>(t), static_cast<int>(t), track.capture[t]);
    }
  }
  return table;
}

}  // namespace pushid
