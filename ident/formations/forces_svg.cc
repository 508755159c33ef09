// ident: the picture of the forces on each person.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/number_text.h"
#include "ident/bodies/animation.h"
#include "ident/figures/chart.h"
#include "ident/formations/formation_files.h"
#include "ident/prediction/predicted_steps.h"

namespace pushid {
namespace {

constexpr double kForcesWidth = 1000, kForcesHeight = 120, kForcesPanel = 500;
constexpr int kRows[] = {0, 2};  // of the generalized force: along x, about y
constexpr const char* kForceHeads[] = {"force along the push, N", "torque about y, N m"};

// After Okabe and Ito: told apart by the colour-blind, on light and on dark paper.
// A part without a colour of its own is grey and dotted.
std::string PartColour(ForcePart part) {
  static const std::map<ForcePart, const char*> colours = {
      {ForcePart::kPush, "#d55e00"},
      {ForcePart::kTail, "#cc79a7"},
      {ForcePart::kFriction, "#e69f00"},
      {ForcePart::kBalance, "#56b4e9"},
      {ForcePart::kLinear, "#009e73"},
      {ForcePart::kInteraction, "#9333ea"},
      {ForcePart::kNetwork, "#6b7280;stroke-dasharray:7 2"}};
  const auto found = colours.find(part);
  return found == colours.end() ? "#999999;stroke-dasharray:2 2" : found->second;
}

std::string PartLook(ForcePart part) {
  return "fill:none;stroke-width:1.5;stroke:" + PartColour(part);
}

constexpr char kNetLook[] = "ink net";
constexpr double kSmallestRange = 10.0;  // N or N m, so that little is not blown up
constexpr double kNothing = 1e-6;        // N or N m

struct ForceRange {
  double lowest = 0.0, highest = 0.0;

  void Add(double force) {
    lowest = std::min(lowest, force);
    highest = std::max(highest, force);
  }
};

// Of what a panel shows.
ForceRange RangeOf(const FormationRun& run, const std::vector<ForcePart>& parts, int person,
                   int row) {
  ForceRange range;
  for (int t = 0; t < run.num_frames(); ++t) {
    const NetForce<double>& force = run.Force(person, t);
    range.Add(force.Total()[row]);
    for (ForcePart part : parts) range.Add(force[part][row]);
  }
  return range;
}

// The net force thick and first, so that a part that is all of it shows on top.
Chart ForceChart(const FormationRun& run, const std::vector<ForcePart>& parts, int person, int row,
                 const ForceRange& scale) {
  Chart chart{"", "time, s"};
  const double air = 0.1 * std::max(kSmallestRange, scale.highest - scale.lowest);
  chart.y_from = scale.lowest - air;
  chart.y_to = scale.highest + air;
  const auto line = [&](auto force_at, const std::string& look) {
    ChartLine drawn{{}, look};
    bool acts = false;
    for (int t = 0; t < run.num_frames(); ++t) {
      const double force = force_at(run.Force(person, t))[row];
      acts = acts || force != 0.0;
      drawn.points.emplace_back(run.Seconds(t), force);
    }
    if (acts) chart.lines.push_back(drawn);
  };
  line([](const NetForce<double>& force) { return force.Total(); }, kNetLook);
  for (ForcePart part : parts) {
    line([part](const NetForce<double>& force) { return force[part]; }, PartLook(part));
  }
  return chart;
}

}  // namespace

Figure ForcesFigure(const FormationRun& run, ForceScale scale) {
  const std::vector<ForcePart> parts = ActingParts(run);
  Figure figure;
  figure.legend = {{"net (the sum)", kNetLook}};
  for (ForcePart part : parts) figure.legend.push_back({std::string(NameOf(part)), PartLook(part)});
  ForceRange shared[2];
  for (int n = 0; n < run.num_people(); ++n) {
    for (int column : {0, 1}) {
      const ForceRange range = RangeOf(run, parts, n, kRows[column]);
      shared[column].Add(range.lowest);
      shared[column].Add(range.highest);
    }
  }
  for (int n = 0; n < run.num_people(); ++n) {
    for (int column : {0, 1}) {
      const ForceRange own = RangeOf(run, parts, n, kRows[column]);
      Chart chart = ForceChart(run, parts, n, kRows[column],
                               scale == ForceScale::kOwn ? own : shared[column]);
      chart.title = kForceHeads[column];
      if (run.num_people() > 1) chart.title = "person " + std::to_string(n) + ": " + chart.title;
      if (own.highest - own.lowest < kNothing) chart.y_label = "nothing";
      figure.panels.push_back(chart);
    }
  }
  return figure;
}

std::string ForcesSvg(const FormationRun& run, const std::string& title, ForceScale scale) {
  Figure figure = ForcesFigure(run, scale);
  for (Chart& panel : figure.panels) {
    panel.width = kForcesPanel;
    panel.height = kForcesHeight;
  }
  figure.heading = title + (scale == ForceScale::kOwn ? "; every panel has its own scale" : "");
  return DrawFigure(figure, kForcesWidth, title).ToString();
}

namespace {

constexpr double kSoleWidth = 0.09;                 // m
constexpr double kAir = 0.15, kShortestFeet = 1.2;  // m
constexpr double kPixelsPerMetre = 300, kWidestFeet = 1000, kSmallestFigure = 640;
constexpr int kCornersOfSole = 24;

constexpr char kSeenSoleLook[] = "ink";
constexpr char kPredictedSoleLook[] = "stroke:none;fill:#3b82f6;fill-opacity:.28";

// What one source says of one person.
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
