// ident: refits of the fit: with other pushes, and of fewer frames.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/report/page/sections.h"
#include "ident/report/refits_text.h"

namespace pushid {
namespace {

// One parameter over the logarithm of the horizon, with twice its standard error.
Chart DriftChart(const RefitTable& check, size_t i, double all_frames) {
  Chart chart;
  chart.title = check.parameters[i];
  chart.x_label = "frames, log10";
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
  TextTable table({"parameter", "unit", "horizon", "value", "standard_error"}, AllWords(5));
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

ReportSection PushCheckSection(const FittedModel& model) {
  ReportSection section{"push_check", "Sensitivity to the pushes", {}, {}, {}, {}, {}, ""};
  if (!model.push_check) return section;
  section.paragraphs = {
      "The pushes are not known exactly: a push from inverse dynamics depends on its window and on "
      "smoothing, a measured push on the noise and the clock of its sensor. The fit was repeated "
      "with other pushes; the total error combines the resulting changes with the standard error."};
  section.tables.push_back(
      {"errors including those of the pushes", PushErrorTable(*model.push_check)});
  section.tables.push_back(
      {"change of each parameter in each refit", MovesTable(*model.push_check)});
  return section;
}

ReportSection PriorCheckSection(const FittedModel& model) {
  ReportSection section{"prior_check", "Sensitivity to the priors", {}, {}, {}, {}, {}, ""};
  if (!model.prior_check || model.prior_check->rows.empty()) return section;
  section.paragraphs = {
      "The fit was repeated with means and widths of all priors halved, and doubled. A parameter "
      "that the recordings determine keeps its value; profiles and bootstrap cannot show this, "
      "because they use the same priors."};
  section.tables.push_back({"values under other priors", PriorTable(*model.prior_check)});
  return section;
}

ReportSection HorizonCheckSection(const FittedModel& model) {
  ReportSection section{"horizon_check", "Estimates from fewer frames", {}, {}, {}, {}, {}, ""};
  if (!model.horizon_check || model.horizon_check->rows.empty()) return section;
  const RefitTable& check = *model.horizon_check;
  section.paragraphs = {
      "The fit was repeated on only the first frames of every recording. A parameter with physical "
      "meaning keeps its value; one that drifts compensates for something that the model omits.",
      DriftText(check)};
  if (const std::string claims = HorizonClaims(check); !claims.empty()) {
    section.paragraphs.push_back(claims);
  }
  section.tables.push_back({"values +- standard errors", HorizonTable(check)});
  double all = 0.0;
  for (const FittedRecording& r : model.fit.recordings) all = std::max(all, r.frames - 1.0);
  std::vector<Chart> charts;
  for (size_t i = 0; i < check.parameters.size(); ++i) charts.push_back(DriftChart(check, i, all));
  section.figures.push_back(
      {"horizons", "Each parameter by horizon, with twice its standard error.",
       DrawCharts(charts, "horizons", kPanelColumns, kPanelWidth, kPanelHeight),
       HorizonNumbers(check)});
  return section;
}

}  // namespace pushid
