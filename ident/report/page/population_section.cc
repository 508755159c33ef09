// ident: how recordings differ from the mean one: the forest of their effects.
#include <algorithm>

#include "datasets/files/number_text.h"
#include "ident/figures/chart.h"
#include "ident/report/page/sections.h"
#include "ident/report/population_text.h"

namespace pushid {
namespace {

constexpr double kWidth = 760, kRow = 15, kTop = 24, kBottom = 36;
constexpr double kNames = 150, kLeft = 160, kRight = 740;  // where names end and the axis goes
constexpr double kNinetyFive = 1.96;

std::string ForestPicture(const std::vector<EffectOfRecording>& effects) {
  const double bottom = kTop + kRow * static_cast<double>(effects.size());
  SvgPicture svg(kWidth, bottom + kBottom, "effects of recordings");
  const SvgScale scale(-kWidestEffect, kWidestEffect, kLeft, kRight);
  for (double tick : scale.Ticks(7)) {
    svg.Line(scale(tick), kTop, scale(tick), bottom, "grid");
    svg.Text(scale(tick), bottom + 14, SvgNumber(tick), "faint small middle");
  }
  svg.Text(0.5 * (kLeft + kRight), bottom + 30, "b: log of the tail's factor",
           "faint small middle");
  svg.Line(scale(0.0), kTop, scale(0.0), bottom, kLimitLook);
  std::string before;
  for (size_t i = 0; i < effects.size(); ++i) {
    const EffectOfRecording& r = effects[i];
    const double y = kTop + kRow * (static_cast<double>(i) + 0.5);
    const double half = kNinetyFive * r.error;
    const auto x = [&scale](double b) {
      return scale(std::clamp(b, -kWidestEffect, kWidestEffect));
    };
    const std::string group = r.person + r.condition;
    if (i > 0 && group != before) svg.Line(kLeft, y - 0.5 * kRow, kRight, y - 0.5 * kRow, "axis");
    before = group;
    svg.Text(kNames, y + 4, r.id, "ink small end");
    svg.Line(x(r.mean - half), y, x(r.mean + half), y, kPredictedLook);
    svg.Circle(x(r.alone), y, 3, kMarkLook, r.id + " alone: " + Rounded(r.alone, 2));
    svg.Circle(x(r.mean), y, 3.5, "fill:#3b82f6",
               r.id + ": " + Rounded(r.mean, 2) + " +- " + Rounded(r.error, 2));
  }
  return svg.ToInline();
}

ReportFigure ForestFigure(const RecordingEffect& effect) {
  TextTable numbers(
      {"recording", "person", "condition", "b", "error", "lower95", "upper95", "alone"},
      {true, true, true, false, false, false, false, false});
  const std::vector<EffectOfRecording> effects = SortedEffects(effect);
  for (const EffectOfRecording& r : effects) {
    const double half = kNinetyFive * r.error;
    numbers.Add({r.id, r.person, r.condition, DoubleText(r.mean), DoubleText(r.error),
                 DoubleText(r.mean - half), DoubleText(r.mean + half), DoubleText(r.alone)});
  }
  return {"recording_effects",
          "Effects with 95 % intervals (blue) and the estimate from each recording alone (orange; "
          "at the edge where it is poorly determined), by person and condition.",
          ForestPicture(effects), numbers};
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
