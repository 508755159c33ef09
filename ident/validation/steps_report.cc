#include "ident/validation/steps_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/problem/statistics.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

struct StepSummary {
  int people = 0, stepping = 0;
  // Times of first lift-offs, s, and lengths of first steps, m, of those who step. A step that the
  // recording cuts off has no length yet.
  std::vector<double> lift_off, length;
};

StepSummary StepSummaryOf(const std::vector<PendulumRecording>& recordings) {
  StepSummary summary;
  for (const PendulumRecording& recording : recordings) {
    for (const PersonSteps& person : recording.steps) {
      ++summary.people;
      const FootStep* first = person.First();
      if (first == nullptr) continue;
      ++summary.stepping;
      summary.lift_off.push_back(first->lift_off * recording.scene.dt);
      if (first->finished) summary.length.push_back(first->Length());
    }
  }
  return summary;
}

Json MedianJson(const std::vector<double>& values) {
  return values.empty() ? Json(nullptr) : Json(Median(values));
}

Json StepJson(const FootStep& step, double dt) {
  return {{"foot", NameOf(step.foot)},
          {"lift_off_s", step.lift_off * dt},
          {"landing_s", step.finished ? Json(step.landing * dt) : Json(nullptr)},
          {"length_m", step.Length()},
          {"direction_deg", step.Direction() * 180.0 / M_PI}};
}

}  // namespace

std::string StepsReport(const std::vector<PendulumRecording>& recordings, bool per_recording) {
  std::string text;
  if (per_recording) {
    TextTable table({"recording", "person", "steps"});
    for (const PendulumRecording& recording : recordings) {
      for (size_t n = 0; n < recording.steps.size(); ++n) {
        table.Add({n == 0 ? recording.id : "", recording.subject_ids[n],
                   StepsText(recording.steps[n], 1.0 / recording.scene.dt)});
      }
    }
    text += table.ToString() + "\n";
  }
  const StepSummary summary = StepSummaryOf(recordings);
  text += "steps: " + std::to_string(summary.stepping) + " of " +
          CountText(summary.people, "person steps", "people step");
  if (summary.stepping > 0) {
    text += "; medians: first lift-off after " + Rounded(Median(summary.lift_off), 2) + " s";
  }
  if (!summary.length.empty()) {
    text += ", first step " + Rounded(Median(summary.length), 2) + " m";
  }
  return text + "\n";
}

void AddStepsJson(const std::vector<PendulumRecording>& recordings, Json* json) {
  for (size_t i = 0; i < recordings.size(); ++i) {
    Json people = Json::array();
    for (const PersonSteps& person : recordings[i].steps) {
      Json steps = Json::array();
      for (const FootStep& step : person.steps) {
        steps.push_back(StepJson(step, recordings[i].scene.dt));
      }
      people.push_back(std::move(steps));
    }
    json->at("recordings").at(i)["steps"] = std::move(people);
  }
  const StepSummary summary = StepSummaryOf(recordings);
  (*json)["steps"] = {{"people", summary.people},
                      {"people_who_step", summary.stepping},
                      {"first_lift_off_median_s", MedianJson(summary.lift_off)},
                      {"first_length_median_m", MedianJson(summary.length)}};
}

namespace {

constexpr int kFewForAuc = 3;

std::string FifthText(const StepFifth& fifth) {
  return Rounded(fifth.predicted, 2) + " -> " + Rounded(fifth.observed, 2);
}

// "+0.05 s, mean |.| 0.11 s, 23 people; place off by 0.14 m"
std::string LiftOffText(const LiftOffError& error) {
  return (error.median > 0.0 ? "+" : "") + Rounded(error.median, 2) + " s, mean |.| " +
         Rounded(error.mean_absolute, 2) + " s, " + std::to_string(error.people) + " people" +
         (error.landed > 0 ? "; place off by " + Rounded(error.place, 2) + " m" : "");
}

// Adds a row where feet step in some model.
void AddLiftOff(const NamedStepScores& scores, TextTable* table) {
  std::vector<std::string> row = {"first lift-off, predicted - recorded: median"};
  bool any = false;
  for (const auto& [name, score] : scores) {
    const LiftOffError& error = score->lift_off;
    any = any || error.people > 0;
    row.push_back(error.people == 0 ? std::string() : LiftOffText(error));
  }
  if (any) table->Add(row);
}

}  // namespace

std::string StepProbabilityText(const StepProbability& p) {
  const double a = p.coefficients[0], b = p.coefficients[1];
  std::string text = "P(step) = 1 / (1 + exp(-(" + Rounded(a, 3) + " + " + Rounded(b, 3) +
                     " margin))), margin in m: how much larger the feet's support in front might "
                     "be, and the person "
                     "would just step (negative: smaller); errors +- " +
                     Rounded(std::sqrt(p.covariance(0, 0)), 2) + " and +- " +
                     Rounded(std::sqrt(p.covariance(1, 1)), 2) + " clustered by " +
                     std::to_string(p.clusters) + " people, of " + std::to_string(p.tracks) +
                     " tracks with " + std::to_string(p.stepped) + " who step";
  if (b > 0.0) text += "; half of all people step at a margin of " + Rounded(-a / b, 2) + " m";
  return text + ".";
}

TextTable StepScoresTable(const NamedStepScores& scores) {
  std::vector<std::string> header = {"who steps"};
  NamedStepScores known;
  size_t fifths = 0;
  for (const auto& [name, score] : scores) {
    if (!score->known()) continue;
    known.emplace_back(name, score);
    header.push_back(name);
    fifths = std::max(fifths, score->fifths.size());
  }
  TextTable table(header);
  if (known.empty()) return table;
  const auto add = [&](const std::string& title, const auto& cell) {
    std::vector<std::string> row = {title};
    for (const auto& [name, score] : known) row.push_back(cell(*score));
    table.Add(row);
  };
  add("tracks with a step / tracks", [](const StepScore& s) {
    return std::to_string(s.stepped) + " / " + std::to_string(s.tracks);
  });
  // With a single person who steps, or one who does not, the AUC says no more than who stands
  // where.
  add("AUC", [](const StepScore& s) {
    return std::min(s.stepped, s.tracks - s.stepped) < kFewForAuc ? std::string("- (too few)")
                                                                  : WithError(s.auc, s.auc_error);
  });
  add("Brier score", [](const StepScore& s) { return WithError(s.brier, s.brier_error); });
  for (size_t i = 0; i < fifths; ++i) {
    const std::string title = "fifth " + std::to_string(i + 1) + " of P(step): mean -> share";
    add(title, [i](const StepScore& s) {
      return i < s.fifths.size() ? FifthText(s.fifths[i]) : std::string();
    });
  }
  AddLiftOff(known, &table);
  return table;
}

std::string StepScoresText(const NamedStepScores& scores) {
  const TextTable table = StepScoresTable(scores);
  if (table.empty()) return "";
  int people = 0;
  for (const auto& [name, score] : scores) people = std::max(people, score->people);
  return table.ToString() + "+-: standard errors by leaving out each of " + std::to_string(people) +
         " people\n";
}

Chart ReliabilityChart(const StepScore& score) {
  Chart chart{"who steps: share over probability", "predicted probability of a step"};
  chart.y_from = 0.0;
  chart.y_to = 1.0;
  ChartPoints shares;
  for (const StepFifth& fifth : score.fifths) shares.emplace_back(fifth.predicted, fifth.observed);
  chart.lines.push_back({{{0.0, 0.0}, {1.0, 1.0}}, kLimitLook, false});
  chart.lines.push_back({shares, kPredictedLook, false});
  chart.lines.push_back({shares, kPredictedLook, true});
  return chart;
}

}  // namespace pushid
