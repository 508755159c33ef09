// ident: how sure: what the data cannot tell apart, profiles, bootstrap.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/figures/text_table.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"
#include "ident/validation/experiment_design.h"

namespace pushid {
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
  section.Say(AgreementNote(source.model));
  section.Show("three kinds of intervals", AgreementTable(source.model));
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
    section.Say(AgreementNote(source.model));
    section.Show("two kinds of intervals", AgreementTable(source.model));
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

namespace {

constexpr double kNinetyFive = 1.96;
constexpr char kAloneLook[] = "fill:none;stroke:#d55e00";

// Beyond the widest effect at the edge.
Chart EffectsChart(const std::vector<EffectOfRecording>& effects) {
  Chart chart{"", "b: log of the tail's factor"};
  chart.marks = {0.0};
  chart.x_from = -kWidestEffect;
  chart.x_to = kWidestEffect;
  ChartLine alone{{}, kAloneLook, true}, means{{}, kDotLook, true};
  for (size_t i = 0; i < effects.size(); ++i) {
    const EffectOfRecording& r = effects[i];
    const double row = static_cast<double>(i), half = kNinetyFive * r.error;
    chart.y_categories.push_back(r.id);
    chart.lines.push_back({{{r.mean - half, row}, {r.mean + half, row}}, kPredictedLook});
    alone.points.emplace_back(r.alone, row);
    means.points.emplace_back(r.mean, row);
  }
  chart.lines.push_back(alone);
  chart.lines.push_back(means);
  return chart;
}

ReportFigure ForestFigure(const RecordingEffect& effect) {
  TextTable numbers(
      {"recording", "person", "condition", "b", "error", "lower95", "upper95", "alone"},
      {true, true, true, false, false, false, false, false});
  const std::vector<EffectOfRecording> effects = SortedEffects(effect);
  for (const EffectOfRecording& r : effects) {
    const double half = kNinetyFive * r.error;
    numbers.Add(
        {r.id, r.person, r.condition, r.mean, r.error, r.mean - half, r.mean + half, r.alone});
  }
  return {"recording_effects",
          "Effects with 95 % intervals (blue) and the estimate from each recording alone (orange; "
          "at the edge where it is poorly determined), by person and condition.",
          {{}, {EffectsChart(effects)}},
          numbers};
}

}  // namespace

ReportSection PopulationSection(const ReportSource& source) {
  ReportSection section;
  const auto& effect = source.fit.recording_effect;
  if (!effect || effect->recordings.empty()) return section;
  section.Say(PopulationSentence(*effect));
  section.Show("", EffectGroupsTable(*effect));
  section.figures.push_back(ForestFigure(*effect));
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
    const bool same = std::any_of(
        source.fit.recordings.begin(), source.fit.recordings.end(), [&](const FittedRecording& r) {
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
      "the estimate: for all parameters together (D-optimal) and for each (c-optimal)."};
  section.Show("for all parameters", DesignTable(design, "all", kBestPushes).value());
  TextTable best({"parameter", "best push", "m/s^2", "height", "s", "kg", "sensor", "its error"},
                 {true, true, false, false, false, false, false, false});
  for (const std::string& parameter : design.parameters) {
    std::vector<std::string> row = DesignTable(design, parameter, 1).value().rows()[1];
    row.insert(row.begin(), parameter);
    row.resize(best.rows()[0].size());
    best.Add(row);
  }
  section.Show("for each parameter", best);
  return section;
}

}  // namespace pushid
