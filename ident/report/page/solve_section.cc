// ident: how the solver got there: where its starts ended, and the way of the best one.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"
#include "ident/report/starts_text.h"

namespace pushid {
namespace {

constexpr double kWaterfallWidth = 450, kWaterfallHeight = 210;

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
  chart.logarithmic = true;
  ChartPoints ended;
  TextTable numbers({"rank", "start", "cost", "failed_recordings"}, {false, true, false, false});
  for (size_t i = 0; i < ranked.size(); ++i) {
    const SolveStart& s = *ranked[i];
    numbers.Add({std::to_string(i + 1), s.kind, s.usable ? DoubleText(s.cost) : "",
                 std::to_string(s.failed.size())});
    if (!s.usable || !s.failed.empty()) continue;
    ended.emplace_back(static_cast<double>(i + 1), axis.At(s.cost));
  }
  chart.lines = {{ended, kPredictedLook, false}, {ended, kPredictedLook, true}};
  return {"starts_waterfall",
          "Each step is another local minimum; starts on the lowest step agree. Starts with failed "
          "recordings are left out.",
          DrawCharts({chart}, "waterfall of the starts", 1, kWaterfallWidth, kWaterfallHeight),
          numbers};
}

}  // namespace

ReportSection SolveSection(const FittedModel& model) {
  const FitResult& result = model.fit;
  ReportSection section{"solve", "Solver convergence", {}, {}, {}, {}, {}, ""};
  std::vector<const SolveStart*> ranked;
  for (const SolveStart& start : result.starts) ranked.push_back(&start);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto* a, const auto* b) {
    return std::make_tuple(!a->usable, a->failed.size(), a->cost) <
           std::make_tuple(!b->usable, b->failed.size(), b->cost);
  });
  TextTable starts(
      {"rank", "start", "cost", "iterations", "converged", "failed recordings", "solver's message"},
      {false, true, false, false, true, false, true});
  for (size_t i = 0; i < ranked.size(); ++i) {
    const SolveStart& s = *ranked[i];
    starts.Add({std::to_string(i + 1), s.kind, s.usable ? Rounded(s.cost, 6) : "-",
                std::to_string(s.iterations), s.converged ? "yes" : "no",
                std::to_string(s.failed.size()), s.message});
  }
  section.tables.push_back({"starts, best first", starts});
  if (result.likelihood) section.paragraphs.push_back(LikelihoodText(result));
  const std::string across = AcrossStartsNote(result);
  if (!across.empty()) section.paragraphs.push_back(across);
  if (ranked.size() > 1) section.figures.push_back(WaterfallFigure(ranked));
  const TextTable spread = AcrossStartsTable(result);
  if (spread.rows().size() > 1) section.tables.push_back({"where the best starts ended", spread});
  const std::vector<TracePoint>& trace = result.diagnostics.trace;
  if (trace.size() < 2) return section;
  double lowest = HUGE_VAL;
  for (const TracePoint& point : trace) lowest = std::min(lowest, point.cost);
  const CostAxis axis(lowest);
  Chart cost, gradient;
  cost.title = axis.Title();
  gradient.title = "largest gradient component";
  ChartLine c{{}, kPredictedLook, false}, g = c;
  TextTable numbers({"step", "horizon_frames", "iteration", "cost", "gradient"}, AllWords(5));
  for (size_t i = 0; i < trace.size(); ++i) {
    const double step = static_cast<double>(i);
    c.points.emplace_back(step, axis.At(trace[i].cost));
    if (trace[i].gradient > 0.0) g.points.emplace_back(step, std::log10(trace[i].gradient));
    numbers.Add({std::to_string(i), std::to_string(trace[i].horizon),
                 std::to_string(trace[i].iteration), DoubleText(trace[i].cost),
                 DoubleText(trace[i].gradient)});
  }
  cost.lines = {c};
  gradient.lines = {g};
  for (Chart* chart : {&cost, &gradient}) {
    chart->x_label = "iteration, over all horizons";
    chart->logarithmic = true;
    for (size_t i = 1; i < trace.size(); ++i) {
      if (trace[i].horizon != trace[i - 1].horizon) chart->marks.push_back(static_cast<double>(i));
    }
  }
  section.figures.push_back({"trace",
                             result.options.likelihood == Likelihood::kTrajectory
                                 ? "The best start. The cost jumps where the horizon grows (lines)."
                                 : "The best start: Fisher scoring, then BFGS.",
                             DrawCharts({cost, gradient}, "trace", 2, 450, 210), numbers});
  return section;
}

}  // namespace pushid
