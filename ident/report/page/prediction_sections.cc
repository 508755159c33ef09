// ident: who steps: the probability of a step, how well it holds, and what it says of other pushes.
#include <algorithm>

#include "datasets/files/number_text.h"
#include "ident/bodies/body_recording.h"
#include "ident/figures/chart.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/prediction.h"
#include "ident/report/page/sections.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

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
  return {"step_reliability",
          "Share of people who stepped, by fifths of the predicted probability.",
          {{}, {ReliabilityChart(score)}},
          numbers};
}

}  // namespace

ReportSection StepSection(const ReportSource& source) {
  ReportSection section;
  const auto& probability = source.fit.step_probability;
  if (!probability) return section;
  section.Say(StepProbabilityText(*probability));
  const StepScore score = ScoreOf(source.views);
  if (!score.known()) return section;
  section.tables.push_back(
      {"who steps in the recordings shown here, which were fitted; pushid-crossvalidate scores "
       "others",
       StepScoresTable({{"predicted", &score}})});
  section.figures.push_back(ReliabilityFigure(score));
  return section;
}

namespace {

// Hips of the recordings of more than one person that the model predicts, by the model and by a
// baseline that sees the recording until the last push ends.
struct ShownGroups {
  std::vector<PendulumRecording> recordings;
  std::vector<Recording> with_bodies;
  std::vector<PredictedGroup> by_model, by_velocity;
};

ShownGroups GroupsOf(const std::vector<RecordingView>& views) {
  ShownGroups groups;
  for (const RecordingView& view : views) {
    const PendulumRecording& recording = view.run.recording;
    if (recording.num_people() < 2 || !view.run.prediction.status.ok) continue;
    const int index = static_cast<int>(groups.recordings.size());
    groups.recordings.push_back(recording);
    groups.with_bodies.push_back(*view.recording);
    groups.by_model.push_back({index, view.run.prediction.hip});
    groups.by_velocity.push_back({index, ConstantVelocityBaseline(recording)});
  }
  return groups;
}

}  // namespace

ReportSection GroupSection(const ReportSource& source) {
  ReportSection section;
  const ShownGroups groups = GroupsOf(source.views);
  const RecordedBodies bodies = BodiesOfGroups(groups.with_bodies);
  const auto model = CompareHips(groups.recordings, bodies, groups.by_model);
  if (!model) return section;
  const auto velocity = CompareHips(groups.recordings, bodies, groups.by_velocity);
  section.paragraphs = {bodies.empty()
                            ? "The recordings have no whole bodies, so only onsets are scored."
                            : "For these scores whole bodies are the first poses, carried by the "
                              "predicted hips; steps that the model predicts do "
                              "not move them.",
                        GroupMetricsLegend()};
  section.tables.push_back(
      {"the recordings shown here; pushid-crossvalidate scores recordings that were not fitted",
       GroupMetricsTable({{"predicted", &*model}, {"constant velocity", &*velocity}})});
  section.tables.push_back(
      {"how the push travels through them, +- a standard error over recordings",
       PropagationTable({{"predicted and measured", &source.propagation}})});
  return section;
}

namespace {

constexpr char kMiddleBandLook[] = "stroke:none;fill:#d55e00;fill-opacity:.18";

Chart StratumChart(const CheckedStratum& stratum) {
  Chart chart{stratum.name + " (n = " + std::to_string(stratum.recordings) + ")", "time, s",
              "hip/push speed, s"};
  for (int q = 0; q < kNumCheckedShares; ++q) {
    const bool middle = q == kNumCheckedShares / 2;
    ChartBand band{{}, {}, middle ? kMiddleBandLook : kWideBandLook};
    ChartLine line{{}, kMeasuredLook, false};
    for (const CheckedFrame& frame : stratum.frames) {
      band.lower.emplace_back(frame.seconds, frame.lower90[q]);
      band.upper.emplace_back(frame.seconds, frame.upper90[q]);
      line.points.emplace_back(frame.seconds, frame.observed[q]);
    }
    chart.bands.push_back(band);
    chart.lines.push_back(line);
  }
  return chart;
}

ReportFigure StrataFigure(const VisualCheck& check) {
  Figure figure;
  TextTable numbers = TextTable::OfNumbers(
      {"stratum", "time_s", "recordings", "percentile", "observed_s", "lower90_s", "upper90_s"});
  for (const CheckedStratum& stratum : check.strata) {
    figure.panels.push_back(StratumChart(stratum));
    for (const CheckedFrame& frame : stratum.frames) {
      for (int q = 0; q < kNumCheckedShares; ++q) {
        numbers.Add({stratum.name, frame.seconds, frame.recordings, 100.0 * kCheckedShares[q],
                     frame.observed[q], frame.lower90[q], frame.upper90[q]});
      }
    }
  }
  return {"visual_predictive_check",
          "10th, 50th and 90th percentile over recordings of the hip's displacement along the "
          "push, divided by the speed of the push (lines), and the central 90 % of the same "
          "percentiles in simulated recordings (blue; of the median orange).",
          figure, numbers};
}

TextTable StrataTable(const VisualCheck& check) {
  TextTable table =
      TextTable::OfNumbers({"stratum", "recordings", "observed percentiles within their 90 %"});
  for (const CheckedStratum& stratum : check.strata) {
    table.Add({stratum.name, stratum.recordings, Rounded(100.0 * stratum.Inside(), 2) + " %"});
  }
  return table;
}

Chart HistogramChart(const std::string& title, const UniformityTest& test) {
  Chart chart{title, "share of the model's distribution below", "share of frames"};
  const double bins = static_cast<double>(test.shares.size());
  double most = 0.0;
  for (size_t b = 0; b < test.shares.size(); ++b) {
    const double from = static_cast<double>(b) / bins, to = from + 1.0 / bins;
    const double share = test.shares[b], middle = 0.5 * (from + to);
    chart.bands.push_back(
        {{{from, 0.0}, {to, 0.0}}, {{from, share}, {to, share}}, kNarrowBandLook});
    chart.lines.push_back({{{middle, share - test.errors[b]}, {middle, share + test.errors[b]}},
                           kMeasuredLook,
                           false});
    most = std::max(most, share + test.errors[b]);
  }
  chart.levels = {1.0 / bins};
  chart.y_from = 0.0;
  chart.y_to = std::max(2.0 / bins, 1.1 * most);
  return chart;
}

ReportFigure HistogramFigure(const VisualCheck& check) {
  TextTable numbers = TextTable::OfNumbers({"axis", "from", "to", "share", "standard_error"});
  Figure figure;
  const auto add = [&](const std::string& axis, const UniformityTest& test) {
    figure.panels.push_back(HistogramChart(axis + " the push", test));
    const double bins = static_cast<double>(test.shares.size());
    for (size_t b = 0; b < test.shares.size(); ++b) {
      const double from = static_cast<double>(b) / bins;
      numbers.Add({axis, from, from + 1.0 / bins, test.shares[b], test.errors[b]});
    }
  };
  add("along", check.along);
  add("across", check.across);
  return {"probability_integral_transform",
          "Position of the recorded hip in the model's distribution, with standard errors "
          "clustered by recording; uniform if the model is correct.",
          figure, numbers};
}

std::string TestText(const std::string& axis, const UniformityTest& test) {
  return axis + " the push: F = " + Rounded(test.f, 3) + ", p = " + Rounded(test.p, 2) + " (" +
         std::to_string(test.values.size()) + " values of " + std::to_string(test.recordings) +
         " recordings)" +
         (test.TooWide() ? ", as the recorded hips are nearer to the prediction than its errors "
                           "say: predicted intervals are too wide rather than wrong"
                         : "");
}

}  // namespace

ReportSection VisualCheckSection(const ReportSource& source) {
  ReportSection section;
  const VisualCheck& check = source.check;
  if (check.strata.empty()) return section;
  section.paragraphs = {
      "Simulated recordings have their own recording effects and correlated errors; only the first "
      "frame and the push of a recording are used. These recordings were fitted: errors on new "
      "ones are larger.",
      "Uniformity " + TestText("along", check.along) + "; " + TestText("across", check.across) +
          ". Values 0.25 s apart, Hotelling's test of five bins, clustered by recording: a small p "
          "indicates that the distribution is wrong."};
  section.Show("", StrataTable(check));
  section.figures.push_back(StrataFigure(check));
  section.figures.push_back(HistogramFigure(check));
  return section;
}

}  // namespace pushid
