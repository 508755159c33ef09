// ident: refits of the fit: with other pushes, and of fewer frames.
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/problem/fit_problem.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"
#include "ident/validation/study_plan.h"

namespace pushid {
namespace {

// One parameter over the logarithm of the horizon, with twice its standard error.
Chart DriftChart(const RefitTable& check, size_t i, double all_frames) {
  Chart chart{WithUnit(check.parameters[i], check.units[i]), "frames"};
  chart.logarithmic_x = true;
  chart.Shrink();
  ChartLine line{{}, kPredictedLook, false};
  ChartBand band{{}, {}, kWideBandLook};
  const auto add = [&](double frames, double value, double error) {
    if (!std::isfinite(error)) return;
    const double x = std::log10(frames);
    line.points.emplace_back(x, value);
    band.lower.emplace_back(x, value - 2.0 * error);
    band.upper.emplace_back(x, value + 2.0 * error);
  };
  for (const RefitRow& row : check.rows) {
    if (!row.value.empty()) {
      add(row.frames, row.value[i], row.standard_error[i]);
    }
  }
  add(all_frames, check.value[i], check.standard_error[i]);
  chart.lines = {line};
  chart.bands = {band};
  return chart;
}

TextTable HorizonNumbers(const RefitTable& check) {
  TextTable table({"parameter", "unit", "horizon", "value", "standard_error"});
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    const auto add = [&](const std::string& horizon, double value, double error) {
      table.Add(
          {check.parameters[i], check.units[i], horizon, DoubleText(value), DoubleText(error)});
    };
    for (const RefitRow& row : check.rows) {
      if (!row.value.empty()) add(row.name, row.value[i], row.standard_error[i]);
    }
    add("all", check.value[i], check.standard_error[i]);
  }
  return table;
}

}  // namespace

ReportSection PushCheckSection(const ReportSource& source) {
  ReportSection section;
  if (!source.model.push_check) return section;
  section.paragraphs = {
      "The pushes are not known exactly: a push from inverse dynamics depends on its window and on "
      "smoothing, a measured push on the noise and the clock of its sensor. The fit was repeated "
      "with other pushes; the total error combines the resulting changes with the standard error."};
  section.Say(SameWindowText(*source.model.push_check));
  section.tables.push_back(
      {"errors including those of the pushes", PushErrorTable(*source.model.push_check)});
  section.tables.push_back(
      {"change of each parameter in each refit", MovesTable(*source.model.push_check)});
  return section;
}

ReportSection PriorCheckSection(const ReportSource& source) {
  ReportSection section;
  if (!source.model.prior_check || source.model.prior_check->rows.empty()) return section;
  section.paragraphs = {
      "The fit was repeated with means and widths of all priors halved, and doubled. A parameter "
      "that the recordings determine keeps its value; profiles and bootstrap cannot show this, "
      "because they use the same priors."};
  section.Show("values under other priors", PriorTable(*source.model.prior_check));
  return section;
}

ReportSection HorizonCheckSection(const ReportSource& source) {
  ReportSection section;
  if (!source.model.horizon_check || source.model.horizon_check->rows.empty()) return section;
  const RefitTable& check = *source.model.horizon_check;
  section.paragraphs = {
      "The fit was repeated on only so many frames of every recording, counted from the start of "
      "its push. A parameter with physical meaning keeps its value; one that drifts compensates "
      "for something that the model omits.",
      DriftText(check)};
  section.Say(HorizonClaims(check));
  section.Show("values +- standard errors", HorizonTable(check));
  double all = 0.0;
  for (const FittedRecording& r : source.fit.recordings) all = std::max(all, r.frames - 1.0);
  Figure figure;
  for (size_t i = 0; i < check.parameters.size(); ++i) {
    figure.panels.push_back(DriftChart(check, i, all));
  }
  section.figures.push_back({"horizons",
                             "Each parameter by horizon, with twice its standard error.", figure,
                             HorizonNumbers(check)});
  return section;
}

namespace {

constexpr int kBestPushes = 8;

// The best pushes to record next, over all and for each parameter.
void AddPushes(const ExperimentDesign& design, ReportSection* section) {
  section->Say(
      "Effect of one more recording of each kind on the standard errors, from the sensitivities at "
      "the estimate: for all parameters together (D-optimal) and for each (c-optimal).");
  section->tables.push_back(
      {"for all parameters", DesignTable(design, "all", kBestPushes).value()});
  TextTable best({"parameter", "best push", "m/s^2", "height", "s", "kg", "its error"},
                 {true, true, false, false, false, false, false});
  for (const std::string& parameter : design.parameters) {
    // Its first row under the header: direction, strength, height, duration, mass, error.
    std::vector<std::string> row = DesignTable(design, parameter, 1).value().rows()[1];
    row.insert(row.begin(), parameter);
    row.resize(best.rows()[0].size());
    best.Add(row);
  }
  section->Show("for each parameter", best);
}

// The design needs the fit's own recordings, all of them and as they were.
ExperimentDesign DesignOf(const FitResult& result, const std::vector<RecordingView>& views) {
  ExperimentDesign none;
  none.refused = "it needs all recordings that were fitted, as they were then, each of one person";
  if (views.size() != result.recordings.size() || result.best_start < 0) return none;
  std::vector<PendulumRecording> recordings;
  for (const RecordingView& view : views) {
    const bool same = std::any_of(
        result.recordings.begin(), result.recordings.end(), [&](const FittedRecording& r) {
          return r.id == view.run.recording.id && r.content_hash == view.run.recording.content_hash;
        });
    // A candidate is one person alone.
    if (!same || view.run.recording.num_people() > 1) return none;
    recordings.push_back(view.run.recording);
  }
  const FitProblem problem(recordings, result.options);
  const std::optional<FitPoint> point = problem.PointAt(result.starts[result.best_start].to.Flat());
  if (!point) return none;
  const FitPoint& estimate = *point;
  return DesignExperiments(problem, estimate, result.uncertainty, ErrorPartsAt(problem, estimate),
                           DefaultCandidates(recordings));
}

// What a force sensor and more people would tell.
void AddStudies(const StudyPlan& plan, ReportSection* section) {
  if (plan.no_sensor.empty()) {
    section->tables.push_back(
        {"a force sensor: the same study with the whole push known", SensorTable(plan, "all")});
  }
  section->Say(NoSensorText(plan));
  section->Say(NoSizesText(plan));
  if (plan.sizes.empty()) return;
  section->Say(StudySizesNote(plan));
  section->tables.push_back(
      {"standard errors with more people and more pushes of each (first row: this study)",
       StudySizesTable(plan, "all")});
}

}  // namespace

ReportSection DesignSection(const ReportSource& source) {
  ReportSection section;
  const ExperimentDesign design = DesignOf(source.fit, source.views);
  if (!design.refused.empty()) section.paragraphs = {"Left out: " + design.refused + "."};
  if (!design.rows.empty()) AddPushes(design, &section);
  AddStudies(design.studies, &section);
  return section;
}

namespace {

// Costs on a logarithmic axis. Those of a likelihood may be negative: they count from 1 below the
// lowest.
struct CostAxis {
  double base = 0.0;
  explicit CostAxis(double lowest) : base(lowest > 0.0 ? 0.0 : lowest - 1.0) {}
  std::string Title() const { return base == 0.0 ? "cost" : "1 + cost above the lowest"; }
  double At(double cost) const { return std::log10(std::max(1e-300, cost - base)); }
};

// Costs of the starts, best first: steps are basins, a long first one is trust.
ReportFigure WaterfallFigure(const std::vector<const SolveStart*>& ranked) {
  Chart chart;
  double lowest = HUGE_VAL;
  for (const SolveStart* start : ranked) {
    if (start->usable) lowest = std::min(lowest, start->cost);
  }
  const CostAxis axis(lowest);
  chart.title = axis.Title() + " of the starts, best first";
  chart.x_label = "rank";
  chart.logarithmic_y = true;
  ChartPoints ended;
  TextTable numbers({"rank", "start", "cost", "failed_recordings"}, {false, true, false, false});
  for (size_t i = 0; i < ranked.size(); ++i) {
    const SolveStart& s = *ranked[i];
    numbers.Add({i + 1, s.kind, s.usable ? DoubleText(s.cost) : "", s.failed.size()});
    if (!s.usable || !s.failed.empty()) continue;
    ended.emplace_back(static_cast<double>(i + 1), axis.At(s.cost));
  }
  chart.lines = {{ended, kPredictedLook}, {ended, kDotLook, true}};
  return {"starts_waterfall",
          "Each step is another local minimum; starts on the lowest step agree. Starts with failed "
          "recordings are left out.",
          {{}, {chart}},
          numbers};
}

}  // namespace

ReportSection SolveSection(const ReportSource& source) {
  ReportSection section;
  std::vector<const SolveStart*> ranked;
  for (const SolveStart& start : source.fit.starts) ranked.push_back(&start);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto* a, const auto* b) {
    return std::make_tuple(!a->usable, a->failed.size(), a->cost) <
           std::make_tuple(!b->usable, b->failed.size(), b->cost);
  });
  TextTable starts(
      {"rank", "start", "cost", "iterations", "converged", "failed recordings", "solver's message"},
      {false, true, false, false, true, false, true});
  for (size_t i = 0; i < ranked.size(); ++i) {
    const SolveStart& s = *ranked[i];
    starts.Add({i + 1, s.kind, s.usable ? Rounded(s.cost, 6) : "-", s.iterations,
                s.converged ? "yes" : "no", s.failed.size(), s.message});
  }
  section.Show("starts, best first", starts);
  if (source.fit.likelihood) section.Say(LikelihoodText(source.fit));
  section.Say(AcrossStartsNote(source.fit));
  if (ranked.size() > 1) section.figures.push_back(WaterfallFigure(ranked));
  section.Show("where the best starts ended", AcrossStartsTable(source.fit));
  const std::vector<TracePoint>& trace = source.fit.diagnostics.trace;
  if (trace.size() < 2) return section;
  double lowest = HUGE_VAL;
  for (const TracePoint& point : trace) lowest = std::min(lowest, point.cost);
  const CostAxis axis(lowest);
  Chart cost, gradient;
  cost.title = axis.Title();
  gradient.title = "largest gradient component";
  ChartLine c{{}, kPredictedLook, false}, g = c;
  TextTable numbers({"step", "horizon_frames", "iteration", "cost", "gradient"});
  for (size_t i = 0; i < trace.size(); ++i) {
    const double step = static_cast<double>(i);
    c.points.emplace_back(step, axis.At(trace[i].cost));
    if (trace[i].gradient > 0.0) g.points.emplace_back(step, std::log10(trace[i].gradient));
    numbers.Add({i, trace[i].horizon, trace[i].iteration, trace[i].cost, trace[i].gradient});
  }
  cost.lines = {c};
  gradient.lines = {g};
  for (Chart* chart : {&cost, &gradient}) {
    chart->x_label = "iteration, over all horizons";
    chart->logarithmic_y = true;
    for (size_t i = 1; i < trace.size(); ++i) {
      if (trace[i].horizon != trace[i - 1].horizon) chart->marks.push_back(static_cast<double>(i));
    }
  }
  section.figures.push_back(
      {"trace",
       source.fit.options.likelihood == Likelihood::kTrajectory
           ? "The best start. The cost jumps where the horizon grows (lines) and where "
             "the data are weighed anew."
           : "The best start: Fisher scoring, then BFGS.",
       {{}, {cost, gradient}},
       numbers});
  return section;
}

}  // namespace pushid
