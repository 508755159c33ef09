// ident: how recordings differ from the mean one: the forest of their effects.
#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/report/page/sections.h"
#include "ident/report/population_text.h"

namespace pushid {
namespace {

constexpr double kWidth = 760, kRow = 15, kMargins = 70;
constexpr double kNinetyFive = 1.96;

ReportFigure ForestFigure(const RecordingEffect& effect) {
  Chart chart;
  chart.title = "effect b of each recording";
  chart.x_label = "b: log of the tail's factor";
  ChartLine shrunk{{}, kPredictedLook, true}, alone{{}, kMarkLook, true};
  TextTable numbers(
      {"recording", "person", "condition", "b", "error", "lower95", "upper95", "alone"},
      {true, true, true, false, false, false, false, false});
  const std::vector<EffectOfRecording> effects = SortedEffects(effect);
  // The first row stands on top.
  double y = static_cast<double>(effects.size()) - 1.0;
  for (const EffectOfRecording& r : effects) {
    const double half = kNinetyFive * r.error;
    chart.lines.push_back({{{r.mean - half, y}, {r.mean + half, y}}, kMeasuredLook, false});
    shrunk.points.emplace_back(r.mean, y);
    alone.points.emplace_back(r.alone, y);
    chart.y_categories.insert(chart.y_categories.begin(), r.id);
    numbers.Add({r.id, r.person, r.condition, DoubleText(r.mean), DoubleText(r.error),
                 DoubleText(r.mean - half), DoubleText(r.mean + half), DoubleText(r.alone)});
    y -= 1.0;
  }
  chart.lines.push_back(alone);
  chart.lines.push_back(shrunk);
  chart.marks = {0.0};
  const double height = kMargins + kRow * static_cast<double>(effects.size());
  return {
      "recording_effects",
      "Effects with 95 % intervals (blue), and what each recording would say alone (orange), by "
      "person and condition.",
      DrawCharts({chart}, "effects of recordings", 1, kWidth, height), numbers};
}

}  // namespace

ReportSection PopulationSection(const FittedModel& model) {
  ReportSection section{"population", "How recordings differ", {}, {}, {}, {}, {}, ""};
  const auto& effect = model.fit.recording_effect;
  if (!effect || effect->recordings.empty()) return section;
  section.paragraphs.push_back(PopulationSentence(*effect));
  section.tables.push_back({"", EffectGroupsTable(*effect)});
  section.figures.push_back(ForestFigure(*effect));
  return section;
}

}  // namespace pushid
