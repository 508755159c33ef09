#include "ident/report/report_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/report/document.h"
#include "ident/report/fit_sections.h"
#include "ident/report/parameter_sections.h"

namespace pushid {
namespace {

std::string TrainingText(const FitOptions& o) {
  std::string text =
      o.network_prior > 0.0 ? "prior " + Rounded(o.network_prior, 4) : std::string("no prior");
  if (o.model.learned->num_weights() > kMostGaussNewtonWeights) {
    text += ", trained together with the free parameters by Adam, fixed while errors were computed";
  }
  return text;
}

}  // namespace

std::string NetworkText(const FitResult& result) {
  const auto& network = result.options.model.learned;
  if (network == nullptr) return "";
  return (network->shape.any() ? "network " : "") + LearnedName(*network) + " (" +
         CountText(network->num_weights(), "weight") + ", " + TrainingText(result.options) + ")";
}

std::string LikelihoodText(const FitResult& result) {
  const LikelihoodScore& score = *result.likelihood;
  return "likelihood " + NameOf(result.options.likelihood) + ", noise " +
         NameOf(result.options.model.process_noise) + ": -2 log L " + Rounded(score.deviance, 7) +
         " of " + std::to_string(score.measured) + " values, AIC " + Rounded(score.Aic(), 7) +
         ", BIC " + Rounded(score.Bic(), 7) + " (" + CountText(score.parameters, "parameter") +
         "); compare only with models of the same likelihood and the same recordings\n" +
         (AnyPooled(result.options.table) ? "  units' deviations are not counted as parameters: "
                                            "compare only models with the same pooling\n"
                                          : "") +
         "  this likelihood is of single steps; settling, errors and outliers below are those of\n"
         "  rollouts";
}

std::string PreparationText(const std::map<std::string, std::string>& configuration) {
  const auto flag = [&configuration](const char* name) {
    const auto found = configuration.find(name);
    double value = 0.0;
    return found != configuration.end() && ParseDouble(found->second, &value) ? value : 0.0;
  };
  std::string text;
  const double cutoff = flag("lowpass_hz"), rate = flag("resample_fps");
  if (cutoff > 0.0) text = "low-pass at " + Rounded(cutoff) + " Hz (zero-phase Butterworth)";
  if (rate > 0.0) {
    text += (text.empty() ? "" : ", ") + std::string("resampled to ") + Rounded(rate) +
            " frames per second";
  }
  if (!text.empty()) text = "motion: " + text + "\n";
  const double replica = flag("replica");
  if (replica > 0.0) {
    text += "recordings: drawn with replacement, as replica " + Rounded(replica) +
            " of a bootstrap (--replica)\n";
  }
  return text;
}

namespace {

using Place = nlohmann::ordered_json::json_pointer;

constexpr double kFileRounding = 1e-6;  // of a parameter

}  // namespace

Result<std::map<std::string, double>> ReadTruth(const std::string& manifest_path) {
  const Result<JsonDocument> document = ReadJsonDocument(manifest_path);
  if (!document.ok()) return document.error();
  try {
    return document.value()
        .content.at("synthetic")
        .at("truth")
        .get<std::map<std::string, double>>();
  } catch (const nlohmann::json::exception&) {
    if (document.value().content.contains(Place("/synthetic/formation"))) {
      return Error{
          "a formation of pushid-formation: its truth is the model it was rolled out "
          "with; compare with that model's own report",
          manifest_path};
    }
    return Error{"no `synthetic.truth`: only recordings of pushid-simulate have a known truth",
                 manifest_path};
  }
}

std::string TruthTable(const FitResult& result, const std::map<std::string, double>& truth) {
  TextTable table({"parameter", ">truth", ">fitted", ">std error", "95 % interval", "unit", ""});
  int covered = 0, compared = 0;
  for (const Estimate& e : result.estimates) {
    const auto known = truth.find(e.name);
    if (e.status == EstimateStatus::kFixed || known == truth.end()) continue;
    // Without noise an interval shrinks below what the files' decimals can hold.
    const double slack = kFileRounding * std::abs(known->second);
    const Interval i = e.interval();
    const bool inside = i.lower - slack <= known->second && known->second <= i.upper + slack;
    ++compared;
    covered += inside;
    table.Add({e.name, Rounded(known->second, 4), Rounded(e.value, 4), Rounded(i.standard_error, 3),
               IntervalText(e.value, i.lower, i.upper), e.unit, inside ? "covers" : "misses"});
  }
  return table.ToString() + std::to_string(covered) + " of " + std::to_string(compared) +
         " intervals cover the truth (on average one in 20 does not)\n";
}

std::string ForecastText(const ForecastRule& f) {
  const std::string judged =
      f.folds > 0
          ? "by models fitted without them, in " + std::to_string(f.folds) + " folds"
          : "by the model that was fitted to them: too few people or recordings to leave some out, "
            "so expect larger errors on new recordings";
  return "From a quarter of a second of first frames on (--observed) the rollout and a filter with "
         "an unknown force are combined; after half a second the filter has the weight " +
         Rounded(std::min(1.0, std::sqrt(f.input_time / 0.5)), 2) + ". Forecasts of " +
         std::to_string(f.recordings) + " recordings " + judged + ". The filter's tail is " +
         Rounded(f.tail, 2) + " times as strong and as long as the model's.\n";
}

namespace {

constexpr int kFewUnits = 5;  // of fewer a bootstrap has too few distinct resamples

std::string OrDash(double value, const std::optional<Interval>& interval) {
  return interval ? IntervalText(value, interval->lower, interval->upper) : "-";
}

}  // namespace

std::optional<Interval> ProfileInterval(const FittedModel& model, const std::string& name) {
  for (const Profile& p : model.profiles) {
    if (p.name == name) return Interval{0.0, p.lower95, p.upper95};
  }
  return std::nullopt;
}

std::optional<Interval> BootstrapInterval(const FittedModel& model, const std::string& name) {
  if (!model.bootstrap) return std::nullopt;
  const Bootstrap& b = *model.bootstrap;
  for (size_t i = 0; i < b.names.size(); ++i) {
    if (b.names[i] == name) return Interval{b.standard_error[i], b.lower95[i], b.upper95[i]};
  }
  return std::nullopt;
}

TextTable IntervalTable(const FittedModel& model) {
  TextTable table({"95 % intervals", ">value", "clustered", "profile", "bootstrap", "unit", "class",
                   "by the data alone"});
  const auto add = [&](const auto& row) {
    const auto profile = ProfileInterval(model, row.name);
    const auto bootstrap = BootstrapInterval(model, row.name);
    if (!profile && !bootstrap) return;
    std::string classification, by_data_alone;
    for (const Profile& p : model.profiles) {
      if (p.name != row.name) continue;
      classification = NameOf(p.classification);
      if (p.by_data_alone) by_data_alone = NameOf(*p.by_data_alone);
    }
    table.Add({row.name, Rounded(row.value, 4), IntervalText(row.value, row.lower95, row.upper95),
               OrDash(row.value, profile), OrDash(row.value, bootstrap), row.unit, classification,
               by_data_alone});
  };
  for (const Estimate& e : model.fit.estimates) {
    if (e.status != EstimateStatus::kFixed) add(e);
  }
  for (const Combination& c : model.fit.derived) {
    if (c.standard_error != 0.0) add(c);
  }
  return table;
}

std::string ResamplingText(const Bootstrap& b) {
  const std::string what = b.drawn_by == ClusterBy::kSubject ? "people" : "recordings";
  const std::string number = b.drawn_from > 0 ? std::to_string(b.drawn_from) + " " : "";
  std::string text = "resampling " + number + what + ": " + std::to_string(b.values.size()) +
                     " of " + std::to_string(b.replicas) + " replicas, seed " +
                     std::to_string(b.seed);
  if (b.people_shared) {
    text +=
        "; people share recordings and cannot be drawn individually, so the correlation between a "
        "person's recordings is neglected";
  }
  if (b.drawn_from > 0 && b.drawn_from < kFewUnits) {
    text += "; of " + number + what + " only " + Rounded(DistinctResamples(b.drawn_from), 3) +
            " distinct resamples exist: its intervals are rough, and usually too narrow";
  }
  return text;
}

namespace {

// Recordings of which the model explains less than nothing; empty: there are none.
std::string WorseThanStaticText(const std::vector<RecordingDiagnostics>& recordings) {
  std::vector<std::string> ids;
  const RecordingDiagnostics* worst = nullptr;
  for (const RecordingDiagnostics& r : recordings) {
    if (!WorseThanStatic(r)) continue;
    ids.push_back(r.id);
    if (worst == nullptr || r.explained < worst->explained) worst = &r;
  }
  if (worst == nullptr) return "";
  const bool most = 2 * ids.size() >= recordings.size();
  return std::string(most ? "This fit loses to standing still, which" : "Standing still") +
         " predicts " + std::to_string(ids.size()) + " of " + std::to_string(recordings.size()) +
         " recordings better (" + ListOfNames(ids, 3, "recordings") +
         "; the worst is explained to " + Rounded(worst->explained, 3) + " %)" +
         (most ? ": do not use the gains; try another --stance, and check pushes and axes. "
               : ". ");
}

}  // namespace

std::string FirstSentences(const FitResult& result) {
  const std::string worse = WorseThanStaticText(result.diagnostics.recordings);
  return worse + ModelVerdictText(result.verdict, !worse.empty());
}

std::string ReportText(const FittedModel& model) {
  const FitResult& result = model.fit;
  const Provenance& from = model.provenance;  // empty where no program fitted
  Report report;
  report.title = (from.version.empty() ? "pushid" : "pushid " + from.version) + ", preset " +
                 result.options.preset + ": " + CountText(result.recordings.size(), "recording") +
                 (from.setting.empty() ? "" : " (" + from.setting + ")");
  report.subtitle = FirstSentences(result);
  report.sections = {ShortSection(model)};
  for (const auto section :
       {SummarySection, ParameterSection, ContrastSection, UnitSection, IdentifiabilitySection,
        ProfileSection, BootstrapSection, HorizonCheckSection, BehaviourSection, LoopSection,
        RecordingSection, AdviceSection}) {
    report.sections.push_back(section(model));
  }
  for (ReportSection& shown : report.sections) {
    shown.figures.clear();
    // Tables that the page folds are left out.
    shown.tables.erase(std::remove_if(shown.tables.begin(), shown.tables.end(),
                                      [](const auto& table) { return !table.caption.empty(); }),
                       shown.tables.end());
  }
  return ToText(report);
}

}  // namespace pushid
