// ident: a report in three sentences, for who reads nothing else, and what its names mean.
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/loading/warning.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/behaviour_text.h"
#include "ident/report/advice.h"
#include "ident/report/page/sections.h"
#include "ident/report/report_text.h"
#include "ident/uncertainty/clusters.h"
#include "ident/validation/scores_report.h"

namespace pushid {
namespace {

constexpr size_t kNamed = 4;  // parameters of a sentence; the table below has all

// "mu = 31.3 N s/m (20 to 42)"; the interval where there is one that tells something.
std::string ValueText(const Estimate& e) {
  std::string text = e.name + " = " + Rounded(e.value, 3) + (e.unit == "1" ? "" : " " + e.unit);
  if (e.lower95 < e.upper95) {
    const double lower = e.total ? e.total->lower95 : e.lower95;
    const double upper = e.total ? e.total->upper95 : e.upper95;
    const double from = ShownEnd(e.value, lower, upper), to = ShownEnd(e.value, upper, lower);
    text += std::isfinite(from) && std::isfinite(to)
                ? " (" + Rounded(from, 3) + " to " + Rounded(to, 3) + ")"
            : std::isfinite(from) ? " (above " + Rounded(from, 3) + ")"
            : std::isfinite(to)   ? " (below " + Rounded(to, 3) + ")"
                                  : " (undetermined)";
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
         "; " + VerdictSentence(verdict, result.behaviour, result.options.model) + ".";
}

// Which intervals ValueText shows, where it shows any.
std::string Brackets(const FitResult& result) {
  if (With(result, EstimateStatus::kIdentified).empty()) return "";
  const bool total = std::any_of(result.estimates.begin(), result.estimates.end(),
                                 [](const Estimate& e) { return e.total.has_value(); });
  return total ? " In brackets: 95 % intervals, with the errors of what is taken as known."
               : " In brackets: 95 % intervals.";
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
  add(EstimateStatus::kModelDependent, "dependent on a model that does not fit: ");
  add(EstimateStatus::kWeak, "with wide intervals: ");
  const Uncertainty& u = result.uncertainty;
  const std::string join = text.empty() ? "" : "; ";
  if (u.about_people_like_them && u.num_people < kFewestPeople) {
    text += join + "anything about people like these " + std::to_string(u.num_people) +
            ", who are fewer than " + std::to_string(kFewestPeople);
  } else if (u.clustered && u.num_clusters < kFewClusters) {
    text += join + "with " + std::to_string(u.num_clusters) +
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
  TextTable table({"name", "unit", "meaning"});
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    if (e.status == EstimateStatus::kFixed || spec == nullptr) continue;
    table.Add({e.name, e.unit == "1" ? "-" : e.unit, spec->meaning});
  }
  return table;
}

}  // namespace

ReportSection LeadSection(const ReportSource& source) {
  ReportSection section;
  if (const std::optional<ReportFigure> typical = TypicalFigure(source))
    section.figures.push_back(*typical);
  section.figures.push_back(IntervalFigure(source));
  const std::string verdict = ModelVerdictText(source.fit.verdict);
  if (source.fit.verdict.fails() || !source.fit.verdict.none_identified.empty()) {
    section.alarm = verdict;
  } else {
    section.Say(verdict);
    section.verdict_first = true;
  }
  section.Say(Known(source.fit) + Brackets(source.fit));
  section.Say(NotKnown(source.fit));
  section.Say(GainsText(source.fit));
  section.Say(Travels(source.propagation));
  section.Say(Next(source.model));
  section.Show("what the names mean", Legend(source.fit));
  return section;
}

namespace {

std::string VerdictText(const FitResult& result) {
  std::string text = result.converged ? "The solve converged. " : "The solve did NOT converge. ";
  text += IdentifiedText(result) + " ";
  const Verdict verdict = VerdictOf(result.behaviour, result.options.model);
  text += Capitalized(VerdictSentence(verdict, result.behaviour, result.options.model)) + ".";
  if (result.behaviour.self_propelling) text += " Do not use the gains.";
  return text;
}

double MeanExplained(const FitResult& result) {
  double sum = 0.0;
  for (const RecordingDiagnostics& r : result.diagnostics.recordings) sum += r.explained;
  return sum / static_cast<double>(std::max<size_t>(1, result.diagnostics.recordings.size()));
}

}  // namespace

ReportSection SummarySection(const ReportSource& source) {
  ReportSection section;
  section.Say(VerdictText(source.fit));
  const FitOptions& o = source.fit.options;
  TextTable facts({"what", "value"});
  facts.Add({"recordings", std::to_string(source.fit.recordings.size()) + " (" +
                               source.model.provenance.setting + ")"});
  facts.Add({"preset", o.preset});
  facts.Add({"posture", NameOf(o.model.posture)});
  facts.Add({"push", NameOf(o.model.push) + ", tail " + NameOf(o.model.push_tail)});
  facts.Add({"feet", FeetOfFit(source.fit)});
  facts.Add({"self force", SelfForceText(o.self_force, o.model.learned.get())});
  if (RodMoves(o.model)) facts.Add({"rod", RodName(o.model.learned->rod)});
  facts.Add({"interaction", InteractionText(o.model)});
  facts.Add({"cost", Rounded(source.fit.cost, 6)});
  if (!source.fit.diagnostics.recordings.empty()) {
    facts.Add({"hip motion explained, mean over recordings",
               Rounded(MeanExplained(source.fit), 3) + " %"});
  }
  section.Show("", facts);
  if (const std::string network = NetworkText(source.fit); !network.empty()) {
    section.Say("Learned terms: " + network + ".");
  }
  section.Say(PreparationText(source.model.provenance.configuration));
  for (const std::string& warning : GroupedWarnings(source.fit.warnings)) {
    section.Say("Warning: " + warning);
  }
  for (const std::string& finding : FindingTexts(source.fit.diagnostics.start.findings)) {
    section.Say("Warning: " + finding);
  }
  return section;
}

ReportSection AdviceSection(const ReportSource& source) {
  ReportSection section;
  for (const Advice& advice : source.model.advice) {
    section.advice.emplace_back(advice.sentence,
                                CommandFor(source.model.provenance, advice.command));
  }
  return section;
}

ReportSection BehaviourSection(const ReportSource& source) {
  ReportSection section;
  section.paragraphs = {BehaviourText(source.fit)};
  section.tables.push_back(
      {"settling simulations: pushed and left alone", BehaviourTable(source.fit)});
  return section;
}

ReportSection ProvenanceSection(const ReportSource& source) {
  ReportSection section;
  section.paragraphs = {"pushid " + source.model.provenance.version + ", manifest " +
                        source.model.provenance.manifest + " (hash " +
                        source.model.provenance.manifest_hash + ")"};
  TextTable flags({"flag", "value"});
  for (const auto& [name, value] : source.model.provenance.configuration)
    flags.Add({"--" + name, value});
  section.Show("flags of the fit (empty: the preset's value)", flags);
  TextTable files({"recording", "frames", "hash of its files"}, {true, false, true});
  for (const FittedRecording& r : source.fit.recordings) {
    files.Add({r.id, r.frames, r.content_hash});
  }
  section.Show("recordings", files);
  return section;
}

}  // namespace pushid
