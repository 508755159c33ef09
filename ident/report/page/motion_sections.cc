// ident: recordings beside their predictions, with bands and forces.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/formations/formation_files.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/force_story.h"
#include "ident/report/page/sections.h"

namespace pushid {
namespace {

constexpr double kMotionWidth = 250, kMotionHeight = 170;

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

// One axis of one person's hip, with its bands where there are some.
Chart HipChart(const RecordingView& view, int person, int axis, const std::string& title) {
  const FormationRun& run = view.run;
  Chart chart;
  chart.title = title;
  chart.x_label = "s";
  chart.lanes = FeetLanes(run, person);
  const auto line = [&](const std::vector<Vector3<double>>& hip) {
    ChartPoints points;
    for (size_t t = 0; t < hip.size(); ++t) {
      points.emplace_back(run.Seconds(static_cast<int>(t)), hip[t][axis] - hip[0][axis]);
    }
    return points;
  };
  if (!view.bands.people.empty()) {
    const PathBand& band = view.bands.people[person];
    const double start = run.recording.hip[person][0][axis];
    const auto shifted = [&](const std::vector<BandPoint>& edge) {
      ChartPoints points;
      for (size_t t = 0; t < edge.size(); ++t) {
        points.emplace_back(run.Seconds(static_cast<int>(t)), edge[t][axis] - start);
      }
      return points;
    };
    chart.bands.push_back({shifted(band.lower90), shifted(band.upper90), kWideBandLook});
    chart.bands.push_back({shifted(band.lower50), shifted(band.upper50), kNarrowBandLook});
  }
  if (run.prediction.status.ok) {
    chart.lines.push_back({line(run.prediction.hip[person]), kPredictedLook, false});
  }
  chart.lines.push_back({line(run.recording.hip[person]), kMeasuredLook, false});
  return chart;
}

Chart AngleChart(const RecordingView& view, int person, int row, const std::string& title) {
  const FormationRun& run = view.run;
  Chart chart;
  chart.title = title;
  chart.x_label = "s";
  if (!view.bands.people.empty()) {
    const PathBand& band = view.bands.people[person];
    const auto edge = [&](const std::vector<BandPoint>& points) {
      ChartPoints placed;
      for (size_t t = 0; t < points.size(); ++t) {
        placed.emplace_back(run.Seconds(static_cast<int>(t)), points[t][row + 1]);
      }
      return placed;
    };
    chart.bands.push_back({edge(band.lower90), edge(band.upper90), kWideBandLook});
    chart.bands.push_back({edge(band.lower50), edge(band.upper50), kNarrowBandLook});
  }
  ChartLine measured{{}, kMeasuredLook, false}, predicted{{}, kPredictedLook, false};
  const int frames = run.recording.num_frames();
  const int valid = run.prediction.status.ok ? frames : run.prediction.status.frame;
  for (int t = 0; t < frames; ++t) {
    measured.points.emplace_back(run.Seconds(t), run.recording.states[person][t].q[row]);
    if (t >= valid) continue;
    predicted.points.emplace_back(run.Seconds(t), run.prediction.path.At(t, person).q[row]);
  }
  chart.lines.push_back(predicted);
  chart.lines.push_back(measured);
  return chart;
}

TextTable PathNumbers(const RecordingView& view) {
  TextTable table({"person",
                   "frame",
                   "time_s",
                   "measured_x_m",
                   "measured_y_m",
                   "predicted_x_m",
                   "predicted_y_m",
                   "lower90_x_m",
                   "upper90_x_m",
                   "lower90_y_m",
                   "upper90_y_m",
                   "lower50_x_m",
                   "upper50_x_m",
                   "lower50_y_m",
                   "upper50_y_m",
                   "measured_theta_rad",
                   "predicted_theta_rad",
                   "measured_phi_rad",
                   "predicted_phi_rad",
                   "left_foot_stands",
                   "right_foot_stands"});
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

std::string PathPicture(const RecordingView& view) {
  const int people = view.run.recording.num_people();
  SvgPicture svg(4 * kMotionWidth, 24 + kMotionHeight * people, view.run.recording.id);
  DrawLegend(LegendOf(view), 52, 16, &svg);
  for (int n = 0; n < people; ++n) {
    const std::string who = people == 1 ? "" : view.run.recording.subject_ids[n] + ": ";
    std::vector<Chart> charts = {
        HipChart(view, n, 0, who + "hip forward, m"), HipChart(view, n, 1, "hip to the left, m"),
        AngleChart(view, n, 2, "theta, rad"), AngleChart(view, n, 3, "phi, rad")};
    for (size_t i = 0; i < charts.size(); ++i) {
      charts[i].bare_x = n + 1 < people;
      DrawChart(charts[i],
                {kMotionWidth * static_cast<double>(i), 24 + kMotionHeight * n, kMotionWidth,
                 kMotionHeight},
                &svg);
    }
  }
  return svg.ToInline();
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
    fold.figures.push_back({"motion_" + id, "", PathPicture(view), PathNumbers(view)});
    if (view.run.prediction.status.ok) {
      const ForceStory story = RichestStory(view.run.recording, view.run.prediction);
      fold.figures.push_back({"forces_" + id, StoryText(view.run.recording, story),
                              ForcesPictureOf(view.run, "forces on each person").ToInline(),
                              ForceNumbers(view.run)});
    }
    section.folds.push_back(std::move(fold));
  }
  return section;
}

}  // namespace pushid
