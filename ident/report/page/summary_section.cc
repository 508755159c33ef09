// ident: what was fitted and what came of it; and where it came from.
#include "datasets/files/number_text.h"
#include "datasets/loading/recording_warnings.h"
#include "ident/figures/text_table.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/option_names.h"
#include "ident/problem/behaviour_text.h"
#include "ident/report/page/sections.h"
#include "ident/report/preparation_text.h"
#include "ident/report/report_tables.h"
#include "ident/report/report_text.h"

namespace pushid {
namespace {

std::string VerdictText(const FitResult& result) {
  std::string text = result.converged ? "The solve converged. " : "The solve did NOT converge. ";
  text += IdentifiedText(result) + " ";
  const Verdict verdict = VerdictOf(result.behaviour, result.options.model);
  text += Capitalized(VerdictSentence(verdict, result.behaviour)) + ".";
  if (result.behaviour.self_propelling) text += " Do not use the gains.";
  return text;
}

double MeanExplained(const FitResult& result) {
  double sum = 0.0;
  for (const RecordingDiagnostics& r : result.diagnostics.recordings) sum += r.explained;
  return sum / static_cast<double>(std::max<size_t>(1, result.diagnostics.recordings.size()));
}

}  // namespace

ReportSection SummarySection(const FittedModel& model) {
  const FitResult& result = model.fit;
  ReportSection section{"summary", "What was fitted", {}, {}, {}, {}, {}, ""};
  section.paragraphs.push_back(VerdictText(result));
  const FitOptions& o = result.options;
  TextTable facts({"what", "value"}, {true, true});
  facts.Add({"recordings",
             std::to_string(result.recordings.size()) + " (" + model.provenance.setting + ")"});
  facts.Add({"preset", o.preset});
  facts.Add({"posture", NameOf(o.model.posture)});
  facts.Add({"push", NameOf(o.model.push) + ", tail " + NameOf(o.model.push_tail)});
  facts.Add({"feet", NameOf(o.model.stance)});
  facts.Add({"self force", SelfForceText(o.self_force, o.model.learned.get())});
  if (RodMoves(o.model)) facts.Add({"rod", RodName(o.model.learned->rod)});
  facts.Add({"interaction", InteractionText(o.model)});
  facts.Add({"cost", Rounded(result.cost, 6)});
  if (!result.diagnostics.recordings.empty()) {
    facts.Add(
        {"hip motion explained, mean over recordings", Rounded(MeanExplained(result), 3) + " %"});
  }
  section.tables.push_back({"", facts});
  if (const std::string network = NetworkText(result); !network.empty()) {
    section.paragraphs.push_back("Learned terms: " + network + ".");
  }
  const std::string prepared = PreparationText(model.provenance.configuration);
  if (!prepared.empty()) section.paragraphs.push_back(prepared);
  for (const std::string& warning : GroupedWarnings(result.warnings)) {
    section.paragraphs.push_back("Warning: " + warning);
  }
  for (const std::string& warning : GroupedWarnings(result.diagnostics.start.unit_warnings)) {
    section.paragraphs.push_back("Units? " + warning);
  }
  return section;
}

ReportSection AdviceSection(const FittedModel& model) {
  ReportSection section{"advice", "What to try next", {}, {}, {}, {}, {}, ""};
  for (const Advice& advice : model.advice) {
    section.advice.emplace_back(advice.sentence, advice.command);
  }
  return section;
}

ReportSection BehaviourSection(const FittedModel& model) {
  const FitResult& result = model.fit;
  ReportSection section{"behaviour", "After a push", {}, {}, {}, {}, {}, ""};
  section.paragraphs = {BehaviourText(result)};
  section.tables.push_back({"settling simulations: pushed and left alone", BehaviourTable(result)});
  return section;
}

ReportSection ProvenanceSection(const FittedModel& model) {
  const FitResult& result = model.fit;
  ReportSection section{"provenance", "Provenance", {}, {}, {}, {}, {}, ""};
  section.paragraphs = {"pushid " + model.provenance.version + ", manifest " +
                        model.provenance.manifest + " (hash " + model.provenance.manifest_hash +
                        ")"};
  TextTable flags({"flag", "value"}, {true, true});
  for (const auto& [name, value] : model.provenance.configuration) flags.Add({"--" + name, value});
  section.tables.push_back({"flags of the fit (empty: the preset's value)", flags});
  TextTable files({"recording", "frames", "hash of its files"}, {true, false, true});
  for (const FittedRecording& r : result.recordings) {
    files.Add({r.id, std::to_string(r.frames), r.content_hash});
  }
  section.tables.push_back({"recordings", files});
  return section;
}

}  // namespace pushid
