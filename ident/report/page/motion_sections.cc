// ident: recordings beside their predictions, with bands and forces.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/bodies/animation.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/formations/formation_files.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/force_story.h"
#include "ident/report/page/sections.h"

namespace pushid {
namespace {

// Bars where a foot is off the ground.
std::vector<ChartLane> FeetLanes(const FormationRun& run, int person) {
  std::vector<ChartLane> lanes;
  for (Foot foot : kFeet) {
    ChartLane lane{NameOf(foot), {}, kLiftedLook};
    for (const FootStep& step : run.recording.steps[person].steps) {
      const int end = std::min(step.landing, run.recording.num_frames() - 1);
      if (step.foot == foot) lane.bars.emplace_back(run.Seconds(step.lift_off), run.Seconds(end));
    }
    lanes.push_back(lane);
  }
  return lanes;
}

// One coordinate of one person over time: measured, predicted and with bands where there are some.
// measured, predicted: of a frame; edge: of a point of the bands.
template <typename Measured, typename Predicted, typename Edge>
void AddPerson(const RecordingView& view, int person, int predicted_frames,
               const Measured& measured, const Predicted& predicted, const Edge& edge,
               Chart* chart) {
  const FormationRun& run = view.run;
  const auto points = [&run](int frames, const auto& value) {
    ChartPoints placed;
    for (int t = 0; t < frames; ++t) placed.emplace_back(run.Seconds(t), value(t));
    return placed;
  };
  if (!view.bands.people.empty()) {
    const PathBand& band = view.bands.people[person];
    const auto edges = [&](const std::vector<BandPoint>& ends) {
      return points(static_cast<int>(ends.size()), [&](int t) { return edge(ends[t]); });
    };
    chart->bands.push_back({edges(band.lower90), edges(band.upper90), kWideBandLook});
    chart->bands.push_back({edges(band.lower50), edges(band.upper50), kNarrowBandLook});
  }
  if (predicted_frames > 0)
    chart->lines.push_back({points(predicted_frames, predicted), kPredictedLook});
  chart->lines.push_back({points(run.recording.num_frames(), measured), kMeasuredLook});
}

// Of the hip along one axis, from a place on.
void AddHip(const RecordingView& view, int person, int axis, double from, Chart* chart) {
  const FormationRun& run = view.run;
  AddPerson(
      view, person, run.prediction.status.ok ? run.recording.num_frames() : 0,
      [&](int t) { return run.recording.hip[person][t][axis] - from; },
      [&](int t) { return run.prediction.hip[person][t][axis] - from; },
      [&](const BandPoint& end) { return end[axis] - from; }, chart);
}

Chart HipChart(const RecordingView& view, int person, int axis, const std::string& title) {
  Chart chart{title, "time, s"};
  chart.lanes = FeetLanes(view.run, person);
  AddHip(view, person, axis, view.run.recording.hip[person][0][axis], &chart);
  return chart;
}

Chart AngleChart(const RecordingView& view, int person, int row, const std::string& title) {
  const FormationRun& run = view.run;
  Chart chart{title, "time, s"};
  const int frames =
      run.prediction.status.ok ? run.recording.num_frames() : run.prediction.status.frame;
  AddPerson(
      view, person, frames, [&](int t) { return run.recording.states[person][t].q[row]; },
      [&](int t) { return run.prediction.path.At(t, person).q[row]; },
      [&](const BandPoint& end) { return end[row + 1]; }, &chart);
  return chart;
}

TextTable PathNumbers(const RecordingView& view) {
  TextTable table(SplitList(
      "person,frame,time_s,measured_x_m,measured_y_m,predicted_x_m,predicted_y_m,lower90_x_m,"
      "upper90_x_m,lower90_y_m,upper90_y_m,lower50_x_m,upper50_x_m,lower50_y_m,upper50_y_m,"
      "measured_theta_rad,predicted_theta_rad,measured_phi_rad,predicted_phi_rad,left_foot_stands,"
      "right_foot_stands"));
  const FormationRun& run = view.run;
  for (int n = 0; n < run.recording.num_people(); ++n) {
    for (int t = 0; t < run.recording.num_frames(); ++t) {
      std::vector<std::string> cells = {run.recording.subject_ids[n], std::to_string(t),
                                        DoubleText(run.Seconds(t))};
      const auto add = [&](bool known, double value) {
        cells.push_back(known ? DoubleText(value) : "");
      };
      const bool ok = run.prediction.status.ok, bands = !view.bands.people.empty();
      for (int axis : {0, 1}) add(true, run.recording.hip[n][t][axis]);
      for (int axis : {0, 1}) add(ok, ok ? run.prediction.hip[n][t][axis] : 0.0);
      for (int axis : {0, 1}) {
        add(bands, bands ? view.bands.people[n].lower90[t][axis] : 0.0);
        add(bands, bands ? view.bands.people[n].upper90[t][axis] : 0.0);
      }
      for (int axis : {0, 1}) {
        add(bands, bands ? view.bands.people[n].lower50[t][axis] : 0.0);
        add(bands, bands ? view.bands.people[n].upper50[t][axis] : 0.0);
      }
      for (int row : {2, 3}) {
        add(true, run.recording.states[n][t].q[row]);
        add(ok, ok ? run.prediction.path.At(t, n).q[row] : 0.0);
      }
      for (Foot foot : kFeet) add(true, run.recording.steps[n].Stands(foot, t) ? 1.0 : 0.0);
      table.Add(cells);
    }
  }
  return table;
}

TextTable ForceNumbers(const FormationRun& run) {
  TextTable table({"person", "frame", "part", "fx_N", "fy_N", "ftheta_Nm", "fphi_Nm"});
  const std::vector<ForcePart> parts = ActingParts(run);
  for (int n = 0; n < run.num_people(); ++n) {
    for (int t = 0; t < run.num_frames(); ++t) {
      const auto add = [&](std::string_view part, const Vector4<double>& force) {
        std::vector<std::string> cells = {run.recording.subject_ids[n], std::to_string(t),
                                          std::string(part)};
        for (int i = 0; i < 4; ++i) cells.push_back(DoubleText(force[i]));
        table.Add(cells);
      };
      add("net", run.Force(n, t).Total());
      for (ForcePart part : parts) add(NameOf(part), run.Force(n, t)[part]);
    }
  }
  return table;
}

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

// Two panels for each person: the net force along the push (N) and the torque about y (N m) over
// time with their parts, all on one scale, so that heights compare.
Figure ForcesFigure(const FormationRun& run) {
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
      Chart chart = ForceChart(run, parts, n, kRows[column], shared[column]);
      chart.title = kForceHeads[column];
      if (run.num_people() > 1) chart.title = "person " + std::to_string(n) + ": " + chart.title;
      if (own.highest - own.lowest < kNothing) chart.y_label = "nothing";
      figure.panels.push_back(chart);
    }
  }
  return figure;
}

// What this picture draws, and no more.
std::vector<LegendEntry> LegendOf(const RecordingView& view) {
  std::vector<LegendEntry> legend = {{"measured", kMeasuredLook}};
  if (view.run.prediction.status.ok) legend.push_back({"predicted", kPredictedLook});
  if (!view.bands.people.empty()) {
    legend.push_back({"50 %", kNarrowBandLook});
    legend.push_back({"90 %", kWideBandLook});
  }
  const auto& steps = view.run.recording.steps;
  if (std::any_of(steps.begin(), steps.end(), [](const auto& s) { return !s.steps.empty(); })) {
    legend.push_back({"foot off the ground", kLiftedLook});
  }
  return legend;
}

Figure PathFigure(const RecordingView& view) {
  const int people = view.run.recording.num_people();
  Figure figure{LegendOf(view), {}};
  for (int n = 0; n < people; ++n) {
    const std::string who = people == 1 ? "" : view.run.recording.subject_ids[n] + ": ";
    for (const Chart& chart :
         {HipChart(view, n, 0, who + "hip forward, m"), HipChart(view, n, 1, "hip to the left, m"),
          AngleChart(view, n, 2, "theta, rad"), AngleChart(view, n, 3, "phi, rad")}) {
      figure.panels.push_back(chart);
      figure.panels.back().Shrink();
    }
  }
  return figure;
}

// The recorded bodies and the predicted pendulums at a few moments, from the side.
std::string StripOf(const RecordingView& view) {
  Animation animation = AnimationOf(view);
  animation.title = "from the side";
  return "<div class=\"scroll\" tabindex=\"0\">" + PoseStrip(animation, kPosesOfStrip).ToInline() +
         "</div>\n";
}

std::string FoldTitle(const RecordingView& view) {
  const PendulumRecording& r = view.run.recording;
  std::string title = r.id;
  if (view.run.prediction.status.ok) {
    title += ": predicted " + MetricsText(ScoreHip(r, view.run.prediction.hip), 2);
  }
  return title + (view.note.empty() ? "" : " (" + view.note + ")");
}

}  // namespace

namespace {

// The hips of everybody along the push, from the pushed person's start on.
Chart TypicalChart(const RecordingView& view, const std::string& title) {
  const PendulumRecording& recording = view.run.recording;
  const Eigen::Vector2d along = PushDirection(recording);
  const int axis = std::abs(along[0]) >= std::abs(along[1]) ? 0 : 1;
  Chart chart{title, "time, s", axis == 0 ? "hip forward, m" : "hip to the left, m"};
  const double from = recording.hip[std::max(0, recording.pushed_person)][0][axis];
  for (int n = 0; n < recording.num_people(); ++n) AddHip(view, n, axis, from, &chart);
  return chart;
}

}  // namespace

std::optional<ReportFigure> TypicalFigure(const ReportSource& source) {
  std::vector<std::pair<double, const RecordingView*>> ranked;
  for (const RecordingView& view : source.views) {
    if (!view.run.prediction.status.ok) continue;
    ranked.emplace_back(ScoreHip(view.run.recording, view.run.prediction.hip).hip_ade, &view);
  }
  if (ranked.empty()) return std::nullopt;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::string, size_t>> shown = {{"best", 0}};
  if (ranked.size() > 2) shown.emplace_back("median", (ranked.size() - 1) / 2);
  if (ranked.size() > 1) shown.emplace_back("worst", ranked.size() - 1);
  std::vector<LegendEntry> legend;
  std::vector<Chart> panels;
  std::vector<std::vector<std::string>> rows;
  for (const auto& [which, place] : shown) {
    const auto& [error, view] = ranked[place];
    panels.push_back(TypicalChart(*view, which + ": " + view->run.recording.id));
    panels.back().x_label = "time, s (" + kHipMetrics[0].Text(error, 2) + ")";
    if (legend.empty()) legend = LegendOf(*view);
    const TextTable path = PathNumbers(*view);
    for (std::vector<std::string> row : path.rows()) {
      const bool header = row[0] == "person";
      if (header && !rows.empty()) continue;
      row.insert(row.begin(),
                 {header ? "which" : which, header ? "recording" : view->run.recording.id});
      rows.push_back(row);
    }
  }
  legend.erase(std::remove_if(legend.begin(), legend.end(),
                              [](const LegendEntry& e) { return e.look == kLiftedLook; }),
               legend.end());
  TextTable numbers(rows[0]);
  for (size_t i = 1; i < rows.size(); ++i) numbers.Add(rows[i]);
  return ReportFigure{
      "typical",
      "Measured and predicted hips in typical recordings: of these " +
          std::to_string(ranked.size()) + " those whose mean error (" + kHipMetrics[0].name +
          ") is the smallest, the median and the largest. Predicted from the first frame and the "
          "push alone, with 50 % and 90 % bands; lengths are along the push, from where the pushed "
          "person starts.",
      {legend, panels},
      numbers};
}

ReportSection MotionSection(const ReportSource& source) {
  ReportSection section;
  if (source.views.empty()) return section;
  section.paragraphs = {
      "Predicted from the first frame and the push alone. The bands include the uncertainty of the "
      "parameters and, for the pushed person, the variation between people with the same "
      "parameters; for others only the uncertainty of the parameters. Bars under the hip show when "
      "a foot was off the ground. The forces explain the motion: balance, friction, interaction, "
      "push and all others add up to the net force (thick)."};
  for (const RecordingView& view : source.views) {
    ReportFold fold{FoldTitle(view), {}};
    const std::string& id = view.run.recording.id;
    fold.figures.push_back({"motion_" + id, "Measured and predicted motion of " + id + ".",
                            PathFigure(view), PathNumbers(view)});
    if (const std::optional<Figure> feet = FeetFigure(view.run)) {
      fold.figures.push_back({"feet_" + id,
                              "Feet and capture points of " + id +
                                  ", with the times of landings: within a predicted foot, beside "
                                  "a recorded one.",
                              *feet, FeetNumbers(view.run)});
      fold.widget = StripOf(view);
    }
    if (view.run.prediction.status.ok) {
      const ForceStory story = RichestStory(view.run.recording, view.run.prediction);
      fold.figures.push_back({"forces_" + id,
                              "Forces in " + id + ". " + StoryText(view.run.recording, story),
                              ForcesFigure(view.run), ForceNumbers(view.run)});
    }
    section.folds.push_back(std::move(fold));
  }
  return section;
}

}  // namespace pushid
