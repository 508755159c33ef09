// ident: the steps that people took in recordings, in words and as JSON.
#include "ident/validation/steps_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/uncertainty/median.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

struct StepSummary {
  int people = 0, stepping = 0;
  // Of those who step: when they first lift a foot, s, and how far that step goes, m. One that the
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
  return {{"foot", Name(step.foot)},
          {"lift_off_s", step.lift_off * dt},
          {"landing_s", step.finished ? Json(step.landing * dt) : Json(nullptr)},
          {"length_m", step.Length()},
          {"direction_deg", step.Direction() * 180.0 / M_PI}};
}

}  // namespace

std::string StepsReport(const std::vector<PendulumRecording>& recordings, bool per_recording) {
  std::string text;
  if (per_recording) {
    TextTable table({"recording", "person", "steps"}, {true, true, true});
    for (const PendulumRecording& recording : recordings) {
      for (size_t n = 0; n < recording.steps.size(); ++n) {
        table.Add({n == 0 ? recording.id : "", recording.subject_ids[n],
                   StepsText(recording.steps[n], 1.0 / recording.scene.dt)});
      }
    }
    text += table.ToString() + "\n";
  }
  const StepSummary summary = StepSummaryOf(recordings);
  text += "steps: " + std::to_string(summary.stepping) + " of " + std::to_string(summary.people) +
          (summary.people == 1 ? " person steps" : " people step");
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

}  // namespace pushid
