// ident: parameters, by unit, and how sure: what the data cannot tell apart, profiles, bootstrap,
// shorter horizons, what to record next.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"
#include "ident/validation/experiment_design.h"

namespace pushid {
namespace {

constexpr char kTotalLook[] = "fill:none;stroke-width:3;stroke:#9ca3af";
constexpr char kTheseLook[] = "fill:none;stroke-width:3;stroke:#93c5fd";
constexpr char kProfileLook[] = "fill:none;stroke-width:3;stroke:#009e73";
constexpr char kBootstrapLook[] = "fill:none;stroke-width:3;stroke:#cc79a7";
constexpr double kStripHeight = 50, kIntervalHeight = 6;  // pixels

// Ends that tell nothing go to the edge.
Interval Shown(double value, Interval interval) {
  const Interval known = interval;
  interval.lower = ShownEnd(value, known.lower, known.upper);
  interval.upper = ShownEnd(value, known.upper, known.lower);
  return interval;
}

constexpr char kDataLook[] = "stroke:none;fill:#3b82f6";
constexpr char kPriorLook[] = "stroke:none;fill:#d55e00";
constexpr char kSettlingLook[] = "stroke:none;fill:#009e73";
constexpr double kLeastDrawn = 0.001;  // a share that is narrower than a pixel

// A bar a parameter, in three parts.
ReportFigure SharesFigure(const FitResult& result) {
  std::vector<const Estimate*> shown;
  for (const Estimate& e : result.estimates) {
    const bool split =
        e.status != EstimateStatus::kFixed && e.status != EstimateStatus::kUnidentifiable;
    if (split && result.options.table.Find(e.name) != nullptr) shown.push_back(&e);
  }
  Figure figure;
  figure.legend = {{"data", kDataLook}};
  const auto drawn = [&shown](double Shares::*part) {
    return std::any_of(shown.begin(), shown.end(),
                       [part](const Estimate* e) { return e->shares.*part >= kLeastDrawn; });
  };
  if (drawn(&Shares::prior)) figure.legend.push_back({"prior", kPriorLook});
  if (drawn(&Shares::settling)) figure.legend.push_back({"settling", kSettlingLook});
  Chart chart{"", "share of the variance, %"};
  chart.x_from = 0.0;
  chart.x_to = 100.0;
  TextTable numbers(
      {"parameter", "data", "prior", "settling", "prior_pull", "settling_pull", "unit", "status"});
  for (const Estimate* e : shown) {
    const Shares& s = e->shares;
    const std::tuple<const char*, double, const char*> parts[] = {
        {"data", s.data, kDataLook},
        {"prior", s.prior, kPriorLook},
        {"settling", s.settling, kSettlingLook}};
    double from = 0.0;
    for (const auto& [name, share, look] : parts) {
      const double to = from + 100.0 * std::clamp(share, 0.0, 1.0);
      chart.bars.push_back({static_cast<double>(chart.y_categories.size()), from, to, look,
                            std::string(name) + " " + Rounded(100.0 * share, 3) + " %"});
      from = to;
    }
    chart.y_categories.push_back(e->name);
    chart.y_notes.push_back(NameOf(e->status));
    numbers.Add({e->name, s.data, s.prior, s.settling, s.prior_pull, s.settling_pull, e->unit,
                 NameOf(e->status)});
  }
  figure.panels = {chart};
  return {"shares", "Shares of each value's variance: data, prior and settling constraint.", figure,
          numbers};
}

}  // namespace

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

ReportFigure IntervalFigure(const ReportSource& source) {
  Figure figure;
  bool told_apart = false, with_total = false;
  TextTable numbers({"parameter", "unit", "value", "nominal", "clustered_lower95",
                     "clustered_upper95", "total_lower95", "total_upper95", "these_people_lower95",
                     "these_people_upper95", "profile_lower95", "profile_upper95",
                     "bootstrap_lower95", "bootstrap_upper95"});
  for (const Estimate& e : source.fit.estimates) {
    const ParameterSpec* spec = source.fit.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    IntervalRow row{e.name, e.unit, e.value, spec->nominal, {}};
    std::vector<std::string> cells = {e.name, e.unit, DoubleText(e.value),
                                      DoubleText(spec->nominal)};
    const auto add = [&](const std::optional<Interval>& interval, const char* look) {
      if (interval) row.intervals.push_back({Shown(e.value, *interval), look});
      cells.push_back(interval ? DoubleText(interval->lower) : "");
      cells.push_back(interval ? DoubleText(interval->upper) : "");
    };
    add(Interval{e.standard_error, e.lower95, e.upper95}, kIntervalLook);
    std::optional<Interval> total;
    if (e.total) total = Interval{e.total->error, e.total->lower95, e.total->upper95};
    add(total, kTotalLook);
    with_total = with_total || e.total;
    add(e.these, kTheseLook);
    told_apart = told_apart || e.these;
    add(ProfileInterval(source.model, e.name), kProfileLook);
    add(BootstrapInterval(source.model, e.name), kBootstrapLook);
    figure.panels.push_back(IntervalStrip(row));
    numbers.Add(cells);
  }
  figure.legend = {{told_apart ? "people like them, 95 %" : "clustered 95 %", kIntervalLook}};
  if (with_total) figure.legend.push_back({"total 95 %", kTotalLook});
  if (told_apart) figure.legend.push_back({"these people", kTheseLook});
  if (!source.model.profiles.empty()) figure.legend.push_back({"profile", kProfileLook});
  if (source.model.bootstrap) figure.legend.push_back({"bootstrap", kBootstrapLook});
  figure.legend.push_back({"nominal", kMarkLook});
  return {"forest",
          "Fitted values (dots) with their 95 % intervals, and the nominal values (upright lines). "
          "Every row has its own scale; an open interval extends to the edge.",
          figure, numbers};
}

ReportSection ParameterSection(const ReportSource& source) {
  ReportSection section;
  section.paragraphs = {IdentifiedText(source.fit), SharesNote(), HowSure(source.fit),
                        ConventionText(source.fit)};
  section.Say(GainsText(source.fit));
  section.Show("", EstimateTable(source.fit));
  section.Show("derived", DerivedTable(source.fit));
  if (source.fit.verdict.checked()) {
    section.Show("taken as known, and what the recordings say of it", AssumptionTable(source.fit));
  }
  const ReportFigure shares = SharesFigure(source.fit);
  if (!shares.numbers.empty()) section.figures.push_back(shares);
  return section;
}

ReportSection UnitSection(const ReportSource& source) {
  const std::string by = source.fit.options.pool_by;
  ReportSection section;
  const bool may_lack = by != kSubjectUnit && by != kSettingLabel;
  section.title = "By " + by + (may_lack ? " or setting" : "");
  const TextTable pooled = PooledTable(source.fit);
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
      const double shared = source.fit.parameters[source.fit.options.table.Find(name)->id];
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
  for (const auto& [id, subject] : source.fit.subjects) add(id, subject.pooled);
  for (const auto& [setting, estimates] : source.fit.settings) add(setting, estimates);
  for (const auto& [name, drawn] : by_parameter) {
    section.figures.push_back(
        {"units_" + name,
         name + " by " + by +
             ": values (dots), 95 % intervals, and the shared value (upright line).",
         {{}, {drawn.first}},
         drawn.second});
  }
  section.Show("", pooled);
  section.Show("spread of the values", SpreadTable(source.fit));
  return section;
}

namespace {

constexpr double kContrastLevel = 0.05;

// Every row has its own scale, with zero in the middle: units differ, their signs do not.
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

ReportSection ContrastSection(const ReportSource& source) {
  ReportSection section;
  if (!source.fit.contrast) return section;
  const Contrast& contrast = *source.fit.contrast;
  section.title = "By " + contrast.label + ": " + contrast.second + " less " + contrast.first;
  section.Say(ContrastText(source.fit));
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
  const size_t size = result.options.table.Free().size();  // without deviations and velocities
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

// A multiple of one parameter draws that parameter's curve again.
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

ReportSection IdentifiabilitySection(const ReportSource& source) {
  ReportSection section;
  const Diagnostics& d = source.fit.diagnostics;
  section.Say("Condition number of the scaled Jacobian: " + Rounded(d.start.condition_number, 3) +
              " at the start, " + Rounded(source.fit.uncertainty.condition_number, 3) +
              " at the optimum.");
  for (const NullDirection& n : source.fit.uncertainty.null_directions) {
    section.Say("Unidentifiable: " + n.sentence);
  }
  if (source.fit.uncertainty.null_directions.empty()) {
    section.Say("Data, priors and constraints together determine all directions.");
  }
  for (const std::string& held : source.fit.uncertainty.held_directions) {
    section.Say("Prior-dependent: " + held);
  }
  for (const std::string& note : d.start.notes) section.Say("Start: " + note);
  section.Say(CorrelationText(source.fit));
  section.figures.push_back(CorrelationFigure(source.fit));
  return section;
}

ReportSection ProfileSection(const ReportSource& source) {
  ReportSection section;
  if (source.model.profiles.empty()) return section;
  section.paragraphs = {
      "Each parameter is moved away from its estimate and everything else refitted. Where the "
      "curve crosses the dashed line the 95 % interval ends; a flat curve means that the data do "
      "not determine the parameter."};
  section.Show("intervals", IntervalTable(source.model));
  Figure figure;
  TextTable ends({"profile of", "why it ended below", "above"});
  TextTable numbers({"parameter", "unit", "value", "cost_above_best", "threshold"});
  for (const Profile& p : source.model.profiles) {
    if (p.lower_end != "threshold" || p.upper_end != "threshold") {
      ends.Add({p.name, p.lower_end, p.upper_end});
    }
    if (p.points.size() > 1 && !IsAlias(source.model, p)) figure.panels.push_back(ProfileChart(p));
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

ReportSection BootstrapSection(const ReportSource& source) {
  ReportSection section;
  if (!source.model.bootstrap || source.model.bootstrap->values.empty()) return section;
  const Bootstrap& b = *source.model.bootstrap;
  section.paragraphs = {"The fit was repeated on samples drawn with replacement, " +
                        ResamplingText(b) + "."};
  if (source.model.profiles.empty()) {
    section.Show("intervals", IntervalTable(source.model));
  }
  Figure figure;
  std::vector<std::string> header;
  for (size_t i = 0; i < b.names.size(); ++i) {
    header.push_back(b.names[i] + " (" + b.units[i] + ")");
    const Estimate* estimate = nullptr;
    for (const Estimate& e : source.fit.estimates) {
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

ReportSection HorizonCheckSection(const ReportSource& source) {
  ReportSection section;
  if (!source.model.horizon_check || source.model.horizon_check->refits.empty()) return section;
  section.paragraphs = {
      "The fit was repeated on only so many frames of every recording, counted from the start of "
      "its push. A parameter with physical meaning keeps its value; one that drifts compensates "
      "for something that the model omits.",
      DriftText(*source.model.horizon_check)};
  section.Show("values +- standard errors", HorizonTable(*source.model.horizon_check));
  return section;
}

// A design needs the fit's own recordings, all of them and as they were.
ReportSection DesignSection(const ReportSource& source) {
  constexpr int kBestPushes = 8;
  std::vector<PendulumRecording> recordings;
  for (const RecordingView& view : source.views) {
    const PendulumRecording& seen = view.run.recording;
    const bool same = std::any_of(source.fit.recordings.begin(), source.fit.recordings.end(),
                                  [&](const FittedRecording& r) {
                                    return r.id == seen.id && r.content_hash == seen.content_hash;
                                  });
    if (same && seen.num_people() == 1) recordings.push_back(seen);
  }
  ReportSection section;
  if (recordings.empty() || recordings.size() != source.fit.recordings.size()) {
    section.paragraphs = {
        "Left out: it needs all recordings that were fitted, as they were then, each of one "
        "person."};
    return section;
  }
  const ExperimentDesign design = DesignExperiments(recordings, source.fit);
  if (!design.refused.empty()) {
    section.paragraphs = {"Left out: " + design.refused + "."};
    return section;
  }
  section.paragraphs = {
      "Effect of one more recording of each kind on the standard errors, from the sensitivities at "
      "the estimate, for all parameters together (D-optimal); a design for one parameter ranks "
      "them "
      "for that alone (c-optimal)."};
  section.Show("", DesignTable(design, "all", kBestPushes).value());
  return section;
}

}  // namespace pushid
