// ident: the section on forecasts: errors against the time seen, and what the filter believes.
#include <cmath>
#include <optional>

#include "ident/figures/chart.h"
#include "ident/observed/first_frames.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr double kBandHalf = 1.645;
constexpr char kStackLook[] = "fill:none;stroke-width:2.6;stroke:#3b82f6";
constexpr const char* kForecasterLooks[kNumForecasters] = {
    "fill:none;stroke-width:1.4;stroke:#d55e00", "fill:none;stroke-width:1.4;stroke:#009e73",
    "fill:none;stroke-width:1.4;stroke-dasharray:5 3;stroke:#cc79a7",
    "fill:none;stroke-width:1.4;stroke-dasharray:2 3;stroke:#888"};

ReportFigure ErrorsFigure(const ForecastStack& forecasts) {
  Chart chart{"", "time seen, s", "mean distance of the hip, m"};
  chart.y_from = 0.0;
  std::vector<LegendEntry> legend = {{"together", kStackLook}};
  for (int c = 0; c < kNumForecasters; ++c) {
    ChartLine line{{}, kForecasterLooks[c], false};
    for (const ForecasterErrors& row : forecasts.scores) {
      if (row.seconds > 0.0 && !std::isnan(row.mean[c])) {
        line.points.emplace_back(row.seconds, row.mean[c]);
      }
    }
    if (line.points.empty()) continue;
    chart.lines.push_back(line);
    legend.push_back({std::string(NameOf(static_cast<Forecaster>(c))), kForecasterLooks[c]});
  }
  ChartLine stack{{}, kStackLook, false};
  for (const ForecasterErrors& row : forecasts.scores) {
    stack.points.emplace_back(row.seconds, row.stack);
  }
  chart.lines.push_back(stack);
  return {
      "forecast_errors",
      "Mean distance of the hip from forecasts, over all frames that were not seen, against the "
      "time that was.",
      {legend, {chart}},
      ForecastTable(forecasts)};
}

// On the pushed person along the push: what was recorded of it, and what the filter adds to push
// and tail. None where the filter leaves the model's domain.
std::optional<ReportFigure> ForceFigure(const IdentifiedModel& model, const ForecastStack& stack,
                                        const PendulumRecording& recording) {
  const int frames = recording.num_frames(), person = recording.pushed_person;
  std::optional<SceneFilter> filter = UnknownForceFilter(model, stack.likeliest, recording, frames);
  if (!filter) return std::nullopt;
  const double dt = recording.scene.dt;
  const Eigen::Vector2d along = PushDirection(recording);
  ChartLine known{{}, kMeasuredLook, false}, believed{{}, kPredictedLook, false};
  ChartBand band{{}, {}, kWideBandLook};
  TextTable numbers =
      TextTable::OfNumbers({"time_s", "push_N", "unknown_N", "lower90_N", "upper90_N"});
  for (int t = 1; t < frames; ++t) {
    const SeenFrame frame = FrameAt(recording, t);
    if (!filter->Observe(frame.states, frame.hips.seen).ok) return std::nullopt;
    double push = 0.0;
    for (const ScenePush& one : recording.scene.pushes) {
      if (one.person == person && one.Active(t))
        push += along.dot(one.force[t - one.start_frame].head<2>());
    }
    const double force = along.dot(filter->Force(person).head<2>());
    const double half =
        kBandHalf * along.cwiseProduct(filter->ForceDeviation(person).head<2>()).norm();
    known.points.emplace_back(t * dt, push);
    believed.points.emplace_back(t * dt, force);
    band.lower.emplace_back(t * dt, force - half);
    band.upper.emplace_back(t * dt, force + half);
    numbers.Add({t * dt, push, force, force - half, force + half});
  }
  Chart chart{recording.id, "time, s", "N"};
  chart.bands = {band};
  chart.lines = {believed, known};
  return ReportFigure{
      "unknown_force_" + recording.id,
      "Along the push, beside it and its tail: what the filter believes (blue) with its 90 % band, "
      "which knows no error of the gains, and the recorded push (black).",
      {{}, {chart}},
      numbers};
}

}  // namespace

ReportSection ForecastSection(const ReportSource& source) {
  ReportSection section;
  const auto& forecasts = source.fit.forecasts;
  if (!forecasts || forecasts->scores.empty()) return section;
  section.Say(ForecastSentence(*forecasts));
  section.figures.push_back(ErrorsFigure(*forecasts));
  const IdentifiedModel model = ModelOf(source.fit);
  for (const RecordingView& view : source.views) {
    const auto figure = ForceFigure(model, *forecasts, view.run.recording);
    if (!figure) continue;
    section.folds.push_back(
        {view.run.recording.id + ": the force that nobody measured", {*figure}});
  }
  return section;
}

}  // namespace pushid
