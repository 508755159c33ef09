#include "ident/report/parameter_sections.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

constexpr char kProfileLook[] = "fill:none;stroke-width:3;stroke:#009e73";
constexpr char kBootstrapLook[] = "fill:none;stroke-width:3;stroke:#cc79a7";
constexpr double kStripHeight = 50, kIntervalHeight = 6;  // pixels

// A value with its intervals, one above the other, and what it is compared with (an upright line),
// on a scale of its own. Interval ends that tell nothing are infinite.
struct IntervalRow {
  std::string name, unit;
  double value = 0.0, nominal = 0.0;
  std::vector<std::pair<Interval, std::string>> intervals;  // with their looks
};
constexpr char kIntervalLook[] = "fill:none;stroke-width:3;stroke:#3b82f6";
constexpr char kToldLook[] = "fill:none;stroke-width:3;stroke:#d55e00";

Chart IntervalStrip(const IntervalRow& row) {
  Chart chart{WithUnit(row.name, row.unit)};
  chart.bare_y = true;
  chart.height = kStripHeight + kIntervalHeight * static_cast<double>(row.intervals.size());
  chart.marks = {row.nominal};
  const double rows = static_cast<double>(row.intervals.size());
  chart.y_from = -1.0 - 0.5 * rows;
  chart.y_to = 1.0 + 0.5 * rows;
  double y = 0.5 * (rows - 1.0);
  for (const auto& [interval, look] : row.intervals) {
    chart.lines.push_back({{{interval.lower, y}, {interval.upper, y}}, look});
    y -= 1.0;
  }
  chart.lines.push_back({{{row.value, 0.0}}, kMeasuredLook, true});
  return chart;
}

// An interval with ends that tell nothing moved to infinity, which charts draw to the edge.
Interval Shown(double value, Interval interval) {
  const Interval known = interval;
  interval.lower = ShownEnd(value, known.lower, known.upper);
  interval.upper = ShownEnd(value, known.upper, known.lower);
  return interval;
}

}  // namespace

ReportFigure IntervalFigure(const FittedModel& model, bool known) {
  Figure figure;
  TextTable numbers({"parameter", "unit", "value", "nominal", "lower95", "upper95",
                     "profile_lower95", "profile_upper95", "bootstrap_lower95",
                     "bootstrap_upper95"});
  for (const Estimate& e : model.fit.estimates) {
    const ParameterSpec* spec = model.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    if (known && e.status != EstimateStatus::kIdentified) continue;
    IntervalRow row{e.name, e.unit, e.value, spec->nominal, {}};
    std::vector<std::string> cells = {e.name, e.unit, DoubleText(e.value),
                                      DoubleText(spec->nominal)};
    const auto add = [&](const std::optional<Interval>& interval, const char* look) {
      if (interval) row.intervals.push_back({Shown(e.value, *interval), look});
      cells.push_back(interval ? DoubleText(interval->lower) : "");
      cells.push_back(interval ? DoubleText(interval->upper) : "");
    };
    add(e.interval(), kIntervalLook);
    add(ProfileInterval(model, e.name), kProfileLook);
    add(BootstrapInterval(model, e.name), kBootstrapLook);
    figure.panels.push_back(IntervalStrip(row));
    numbers.Add(cells);
  }
  figure.legend = {{"95 % interval", kIntervalLook}};
  if (!model.profiles.empty()) figure.legend.push_back({"profile", kProfileLook});
  if (model.bootstrap) figure.legend.push_back({"bootstrap", kBootstrapLook});
  figure.legend.push_back({"nominal", kMarkLook});
  return {
      known ? "known" : "forest",
      (known ? "What the recordings identify: values" : "Fitted values") +
          std::string(" (dots) with 95 % intervals, and nominal values (upright lines). Every row "
                      "has its own scale; an open interval extends to the edge."),
      figure, numbers};
}

ReportSection ParameterSection(const FittedModel& model) {
  ReportSection section{"parameters", "Parameters"};
  section.paragraphs = {SharesNote(), ErrorsText(model.fit), ConventionText(model.fit)};
  section.Say(SharperText(model.fit));
  section.Show("", EstimateTable(model.fit));
  section.Show("", DerivedTable(model.fit));
  section.Show("what the intervals are made of", PartsTable(model.fit));
  if (model.fit.verdict.checked()) {
    section.Say(ModelVerdictText(model.fit.verdict));
    section.Show("taken as known, and what the recordings say of it", AssumptionTable(model.fit));
  }
  section.figures.push_back(IntervalFigure(model, false));
  return section;
}

ReportSection UnitSection(const FittedModel& model) {
  const std::string by = model.fit.options.pool_by;
  ReportSection section{"units"};
  const bool may_lack = by != kSubjectUnit && by != kSettingLabel;
  section.title = "By " + by + (may_lack ? " or setting" : "");
  const TextTable pooled = PooledTable(model.fit);
  if (pooled.empty()) return section;
  section.paragraphs = {
      "Partially pooled: each value deviates from the shared value as far as its "
      "recordings require."};
  if (may_lack) {
    section.paragraphs.back() += " A recording without a " + by + " is grouped by its setting.";
  }
  std::map<std::string, std::pair<Chart, TextTable>> by_parameter;
  const auto add = [&](const std::string& unit, const std::map<std::string, Estimate>& estimates) {
    for (const auto& [name, e] : estimates) {
      auto& [chart, numbers] =
          by_parameter
              .try_emplace(name, Chart(),
                           TextTable({"unit", "value", "lower95", "upper95", "shared"}))
              .first->second;
      const double shared = model.fit.parameters[model.fit.options.table.Find(name)->id];
      const double row = static_cast<double>(chart.y_categories.size());
      const Interval shown = Shown(e.value, {e.standard_error, e.lower95, e.upper95});
      chart.title = WithUnit(name, e.unit);
      chart.marks = {shared};
      chart.y_categories.push_back(unit);
      chart.lines.push_back({{{shown.lower, row}, {shown.upper, row}}, kIntervalLook});
      chart.lines.push_back({{{e.value, row}}, kMeasuredLook, true});
      numbers.Add({unit, e.value, shown.lower, shown.upper, shared});
    }
  };
  for (const auto& [id, subject] : model.fit.subjects) add(id, subject.pooled);
  for (const auto& [setting, estimates] : model.fit.settings) add(setting, estimates);
  for (const auto& [name, drawn] : by_parameter) {
    section.figures.push_back(
        {"units_" + name,
         name + " by " + by +
             ": values (dots), 95 % intervals, and the shared value (upright line).",
         {{}, {drawn.first}},
         drawn.second});
  }
  section.Show("", pooled);
  section.Show("", SpreadTable(model.fit));
  return section;
}

namespace {

constexpr double kContrastLevel = 0.05;

// Rows have scales of their own with zero in the middle: units differ, signs do not.
Figure ContrastForest(const Contrast& contrast) {
  Figure figure;
  figure.legend = {{"95 %", kIntervalLook}, {"differs after Holm's correction", kToldLook}};
  for (const ContrastRow& row : contrast.rows) {
    double reach = std::abs(row.difference);
    for (double end : {row.lower95, row.upper95}) {
      if (std::isfinite(end)) reach = std::max(reach, std::abs(end));
    }
    reach = reach > 0.0 ? 1.08 * reach : 1.0;
    Chart strip = IntervalStrip({row.name,
                                 row.unit,
                                 row.difference,
                                 0.0,
                                 {{{0.0, row.lower95, row.upper95},
                                   row.p_holm < kContrastLevel ? kToldLook : kIntervalLook}}});
    strip.y_label = "Holm's p " + Rounded(row.p_holm, 2);
    strip.x_from = -reach;
    strip.x_to = reach;
    figure.panels.push_back(strip);
  }
  return figure;
}

TextTable ContrastNumbers(const Contrast& contrast) {
  TextTable numbers({"parameter", "unit", "first", "second", "difference", "lower95", "upper95",
                     "effect_sd", "p", "p_holm"});
  for (const ContrastRow& row : contrast.rows) {
    numbers.Add(std::vector<std::string>{
        row.name, row.unit, DoubleText(row.first), DoubleText(row.second),
        DoubleText(row.difference), DoubleText(row.lower95), DoubleText(row.upper95),
        row.effect ? DoubleText(*row.effect) : "", DoubleText(row.p), DoubleText(row.p_holm)});
  }
  return numbers;
}

}  // namespace

ReportSection ContrastSection(const FittedModel& model) {
  ReportSection section{"contrast"};
  if (!model.fit.contrast) return section;
  const Contrast& contrast = *model.fit.contrast;
  section.title = "By " + contrast.label + ": " + contrast.second + " less " + contrast.first;
  section.Say(ContrastText(model.fit));
  section.Show("", ContrastTable(contrast));
  section.figures.push_back(
      {"contrast",
       "Differences (dots) with their 95 % intervals. Every row has its own "
       "scale around zero (upright line); an open interval extends to the edge.",
       ContrastForest(contrast), ContrastNumbers(contrast)});
  return section;
}

namespace {

constexpr int kBars = 24;

ReportFigure CorrelationFigure(const FitResult& result) {
  const Uncertainty& u = result.uncertainty;
  // Without deviations and velocities.
  const size_t size = std::min(result.options.table.Free().size(), u.estimates.size());
  Chart map{"correlation of the estimates"};
  map.width = kWidestMap;
  std::vector<std::string> header = {"parameter"};
  for (size_t i = 0; i < size; ++i) header.push_back(u.estimates[i].name);
  TextTable numbers(header);
  for (size_t i = 0; i < size; ++i) {
    map.y_categories.push_back(u.estimates[i].name);
    map.x_categories.push_back(u.estimates[i].name);
    std::vector<std::string> cells = {u.estimates[i].name};
    std::vector<double> row;
    for (size_t j = 0; j < size; ++j) {
      row.push_back(u.correlation(static_cast<int>(i), static_cast<int>(j)));
      cells.push_back(DoubleText(row.back()));
    }
    map.cells.push_back(row);
    numbers.Add(cells);
  }
  return {
      "correlation",
      "Near 1 or -1: the data determine the joint effect of two parameters, but not that of each.",
      {{}, {map}},
      numbers};
}

// Whether a combination is a multiple of one parameter, whose curve it would draw again.
bool IsAlias(const FittedModel& model, const Profile& p) {
  const FitResult& result = model.fit;
  const bool parameter = result.options.table.Find(p.name) != nullptr;
  return !parameter &&
         std::any_of(model.profiles.begin(), model.profiles.end(), [&](const auto& q) {
           return &q != &p && result.options.table.Find(q.name) != nullptr &&
                  q.points.size() == p.points.size() && q.threshold == p.threshold &&
                  q.cost == p.cost &&
                  std::abs(q.lower95 / q.estimate - p.lower95 / p.estimate) < 1e-9;
         });
}

Chart ProfileChart(const Profile& p) {
  Chart chart{p.name, WithUnit(p.name, p.unit)};
  chart.Shrink();
  ChartLine line{{}, kPredictedLook}, dots{{}, kDotLook, true};
  for (const ProfilePoint& point : p.points) {
    line.points.emplace_back(point.value, (point.cost - p.cost) / p.threshold);
  }
  dots.points = line.points;
  chart.lines = {line, dots};
  chart.levels = {1.0};
  chart.marks = {p.estimate};
  chart.y_from = -0.1;
  chart.y_to = 2.0;
  return chart;
}

Chart Histogram(const std::vector<double>& values, const std::string& name, const std::string& unit,
                double estimate) {
  Chart chart{name, WithUnit(name, unit), "replicas"};
  chart.Shrink();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double width = (*high - *low) / kBars;
  std::vector<int> counts(kBars, 0);
  for (double value : values) {
    ++counts[width > 0.0 ? std::min(kBars - 1, static_cast<int>((value - *low) / width)) : 0];
  }
  ChartBand bars{{}, {}, "stroke:none;fill:#cc79a7;fill-opacity:.75"};
  for (int k = 0; k < kBars; ++k) {
    for (const double x : {*low + k * width, *low + (k + 1) * width}) {
      bars.lower.emplace_back(x, 0.0);
      bars.upper.emplace_back(x, counts[k]);
    }
  }
  chart.bands = {bars};
  chart.marks = {estimate};
  chart.y_from = 0.0;
  return chart;
}

}  // namespace

ReportSection IdentifiabilitySection(const FittedModel& model) {
  ReportSection section{"identifiability", "Identifiability"};
  const Diagnostics& d = model.fit.diagnostics;
  section.Say("Condition number of the scaled Jacobian: " + Rounded(d.start.condition_number, 3) +
              " at the start, " + Rounded(model.fit.uncertainty.condition_number, 3) +
              " at the optimum.");
  for (const NullDirection& n : model.fit.uncertainty.null_directions) {
    section.Say("Unidentifiable: " + n.sentence);
  }
  if (model.fit.uncertainty.null_directions.empty()) {
    section.Say("Data, priors and constraints together determine all directions.");
  }
  for (const std::string& held : model.fit.uncertainty.held_directions) {
    section.Say("Prior-dependent: " + held);
  }
  for (const std::string& note : d.start.notes) section.Say("Start: " + note);
  section.Say(CorrelationText(model.fit));
  section.figures.push_back(CorrelationFigure(model.fit));
  return section;
}

ReportSection ProfileSection(const FittedModel& model) {
  ReportSection section{"profiles", "Profile likelihood"};
  if (model.profiles.empty()) return section;
  section.paragraphs = {
      "Each parameter is moved away from its estimate and everything else refitted; the 95 % "
      "interval ends where the cost has risen by the threshold. A profile that stays flat means "
      "that the data do not determine the parameter."};
  section.Show("", IntervalTable(model));
  Figure figure;
  TextTable ends({"profile of", "why it ended below", "above"});
  TextTable numbers({"parameter", "unit", "value", "cost_above_best", "threshold"});
  for (const Profile& p : model.profiles) {
    if (p.lower_end != "threshold" || p.upper_end != "threshold") {
      ends.Add({p.name, p.lower_end, p.upper_end});
    }
    if (p.points.size() > 1 && !IsAlias(model, p)) figure.panels.push_back(ProfileChart(p));
    for (const ProfilePoint& point : p.points) {
      numbers.Add({p.name, p.unit, point.value, point.cost - p.cost, p.threshold});
    }
  }
  section.Show("profiles that ended elsewhere than at the threshold", ends);
  section.figures.push_back(
      {"profiles",
       "Cost above the optimum, over the 95 % threshold (dashed); the estimate is the line.",
       figure, numbers});
  return section;
}

ReportSection BootstrapSection(const FittedModel& model) {
  ReportSection section{"bootstrap", "Bootstrap"};
  if (!model.bootstrap || model.bootstrap->values.empty()) return section;
  const Bootstrap& b = *model.bootstrap;
  section.paragraphs = {"The fit was repeated on samples drawn with replacement, " +
                        ResamplingText(b) + "."};
  if (model.profiles.empty()) {
    section.Show("", IntervalTable(model));
  }
  Figure figure;
  std::vector<std::string> header;
  for (size_t i = 0; i < b.names.size(); ++i) {
    header.push_back(b.names[i] + " (" + b.units[i] + ")");
    const Estimate* estimate = nullptr;
    for (const Estimate& e : model.fit.estimates) {
      if (e.name == b.names[i]) estimate = &e;
    }
    if (estimate == nullptr) continue;  // combinations are their parameter on another scale
    std::vector<double> values;
    for (const auto& row : b.values) values.push_back(row[i]);
    figure.panels.push_back(Histogram(values, b.names[i], b.units[i], estimate->value));
  }
  TextTable numbers(header);
  for (const auto& row : b.values) {
    std::vector<std::string> cells;
    for (double value : row) cells.push_back(DoubleText(value));
    numbers.Add(cells);
  }
  section.figures.push_back(
      {"bootstrap", "Replicas, and the estimate of the fit (line).", figure, numbers});
  return section;
}

ReportSection HorizonCheckSection(const FittedModel& model) {
  ReportSection section{"horizon_check", "Estimates from fewer frames"};
  if (!model.horizon_check || model.horizon_check->refits.empty()) return section;
  section.paragraphs = {
      "The fit was repeated on only so many frames of every recording, counted from the start of "
      "its push. A parameter with physical meaning keeps its value; one that drifts compensates "
      "for something that the model omits.",
      DriftText(*model.horizon_check)};
  section.Show("", HorizonTable(*model.horizon_check));
  return section;
}

}  // namespace pushid
