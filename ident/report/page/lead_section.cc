// ident: a report in three sentences, for who reads nothing else, and what its names mean.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/parameters/presets.h"
#include "ident/problem/behaviour_text.h"
#include "ident/report/page/sections.h"
#include "ident/uncertainty/few_clusters.h"
#include "ident/validation/scores_text.h"

namespace pushid {
namespace {

constexpr size_t kNamed = 4;  // parameters of a sentence; the table below has all

// "mu = 31.3 N s/m (20 to 42)"; the interval where there is one.
std::string ValueText(const Estimate& e) {
  std::string text = e.name + " = " + Rounded(e.value, 3) + (e.unit == "1" ? "" : " " + e.unit);
  if (e.lower95 < e.upper95) {
    text += " (" + Rounded(e.lower95, 3) + " to " + Rounded(e.upper95, 3) + ")";
  }
  return text;
}

std::vector<const Estimate*> With(const FitResult& result, EstimateStatus status) {
  std::vector<const Estimate*> found;
  for (const Estimate& e : result.estimates) {
    if (e.status == status) found.push_back(&e);
  }
  return found;
}

std::string Listed(const std::vector<const Estimate*>& estimates) {
  std::string text;
  for (size_t i = 0; i < std::min(kNamed, estimates.size()); ++i) {
    text += (i > 0 ? ", " : "") + ValueText(*estimates[i]);
  }
  const size_t more = estimates.size() - std::min(kNamed, estimates.size());
  return text + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

std::string Known(const FitResult& result) {
  const std::vector<const Estimate*> known = With(result, EstimateStatus::kIdentified);
  const Verdict verdict = VerdictOf(result.behaviour, result.options.model);
  return "What is known: " +
         (known.empty() ? "these recordings alone identify no parameter"
                        : "these recordings identify " + Listed(known)) +
         "; " + VerdictSentence(verdict, result.behaviour) + ".";
}

std::string NotKnown(const FitResult& result) {
  std::string text;
  const auto add = [&](EstimateStatus status, const std::string& words) {
    const std::vector<const Estimate*> found = With(result, status);
    if (!found.empty()) text += (text.empty() ? "" : "; ") + words + Listed(found);
  };
  add(EstimateStatus::kUnidentifiable, "not identifiable from these recordings: ");
  add(EstimateStatus::kAtBound, "ended at a bound: ");
  add(EstimateStatus::kPriorHeld,
      "determined more by priors or constraints than by the recordings: ");
  add(EstimateStatus::kWeak, "with wide intervals: ");
  const Uncertainty& u = result.uncertainty;
  if (u.clustered && u.num_clusters < kFewClusters) {
    text += (text.empty() ? "" : "; ") + std::string("with ") + std::to_string(u.num_clusters) +
            (u.clustered_by == ClusterBy::kSubject ? " people" : " recordings") +
            " all intervals are rough";
  }
  return "What is not known: " + (text.empty() ? "no free parameter" : text) + ".";
}

// Of groups: what was measured and what the model makes of it.
std::string Travels(const PropagationSummary& p) {
  if (p.recordings == 0 || !p.figures[kSlownessMeasured].known()) return "";
  std::string text = "How the push travels in the fitted recordings: in " +
                     std::to_string(std::lround(p.figures[kSlownessMeasured].weight)) +
                     " recordings the onset of motion propagated at " +
                     SpeedText(p.figures[kSlownessMeasured]) +
                     " m/s (predicted: " + SpeedText(p.figures[kSlownessPredicted]) + ")";
  const PropagationMean &measured = p.figures[kMomentumMeasured],
                        &predicted = p.figures[kMomentumPredicted];
  if (measured.known() && predicted.known()) {
    text += "; the momentum of each person was " + Rounded(measured.value, 2) +
            " times that of the previous one (predicted: " + Rounded(predicted.value, 2) + ")";
  }
  return text + "; the model misses " + Rounded(p.missed_movers, 4) + " of the " +
         Rounded(p.movers, 4) + " people who moved.";
}

std::string Next(const FittedModel& model) {
  if (model.advice.empty()) return "What to do next: predict a push that was not fitted.";
  return "What to do next: " + model.advice.front().sentence;
}

// Of the free parameters: what a reader of the pictures meets.
TextTable Legend(const FitResult& result) {
  TextTable table({"name", "unit", "meaning"}, {true, true, true});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    table.Add({e.name, e.unit == "1" ? "-" : e.unit, spec->meaning});
  }
  return table;
}

}  // namespace

ReportSection LeadSection(const FittedModel& model, const PropagationSummary& propagation) {
  ReportSection section{"short", "In short", {}, {}, {}, {}, {}, ""};
  section.paragraphs = {Known(model.fit) + " In brackets: 95 % intervals.", NotKnown(model.fit)};
  if (const std::string travels = Travels(propagation); !travels.empty()) {
    section.paragraphs.push_back(travels);
  }
  section.paragraphs.push_back(Next(model));
  section.tables.push_back({"the parameters that were fitted", Legend(model.fit)});
  return section;
}

}  // namespace pushid
