// ident: who steps: the probability of a step, how well it holds, and what it says of other pushes.
#include "datasets/files/number_text.h"
#include "ident/figures/heat_map.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/step_map.h"
#include "ident/report/page/sections.h"
#include "ident/validation/step_score_report.h"

namespace pushid {
namespace {

constexpr double kChartWidth = 320, kChartHeight = 260;

ReportFigure MapFigure(const IdentifiedModel& model) {
  const StepMap map = ComputeStepMap(model);
  HeatMap picture;
  picture.title = "P(step) by impulse per mass and duration";
  std::vector<std::string> header = {"impulse_per_mass_m_s"};
  for (double duration : map.duration_s) {
    picture.columns.push_back(Rounded(duration, 2) + " s");
    header.push_back("p_step_after_" + Rounded(duration, 2) + "_s");
  }
  TextTable numbers(header, std::vector<bool>(header.size(), false));
  for (size_t i = 0; i < map.impulse_per_mass.size(); ++i) {
    picture.rows.push_back(Rounded(map.impulse_per_mass[i], 2) + " m/s");
    std::vector<std::string> row = {DoubleText(map.impulse_per_mass[i])};
    for (double p : map.probability[i]) row.push_back(DoubleText(p));
    numbers.Add(row);
  }
  picture.values = map.probability;
  return {"step_probability",
          "Probability that a person of 80 kg steps after a forward push at the hip, by the "
          "duration of the push and its impulse divided by the mass.",
          DrawHeatMap(picture), numbers};
}

StepScore ScoreOf(const std::vector<RecordingView>& views) {
  std::vector<StepPrediction> predictions;
  for (const RecordingView& view : views) {
    const auto steps = StepPredictions(view.run.recording, view.run.prediction);
    predictions.insert(predictions.end(), steps.begin(), steps.end());
  }
  return ScoreSteps(predictions);
}

ReportFigure ReliabilityFigure(const StepScore& score) {
  TextTable numbers({"tracks", "predicted", "observed"}, {false, false, false});
  for (const StepFifth& fifth : score.fifths) {
    numbers.Add(
        {std::to_string(fifth.tracks), DoubleText(fifth.predicted), DoubleText(fifth.observed)});
  }
  return {
      "step_reliability", "Share of people who stepped, by fifths of the predicted probability.",
      DrawCharts({ReliabilityChart(score)}, "reliability", 1, kChartWidth, kChartHeight), numbers};
}

}  // namespace

ReportSection StepSection(const FittedModel& model, const std::vector<RecordingView>& views) {
  ReportSection section{"steps", "Who steps", {}, {}, {}, {}, {}, ""};
  const auto& probability = model.fit.step_probability;
  if (!probability) return section;
  section.paragraphs.push_back(StepProbabilityText(*probability));
  section.figures.push_back(MapFigure(ModelOf(model.fit)));
  const StepScore score = ScoreOf(views);
  if (!score.known()) return section;
  section.tables.push_back(
      {"who steps in the recordings shown here, which were fitted; pushid-crossvalidate scores "
       "others",
       StepScoresTable({{"predicted", &score}})});
  section.figures.push_back(ReliabilityFigure(score));
  return section;
}

}  // namespace pushid
