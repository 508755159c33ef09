// ident: slopes as rows of the table.
#include "ident/fit/covariates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "ident/fit/fit.h"
#include "ident/problem/parallel.h"
#include "ident/problem/statistics.h"
#include "ident/uncertainty/contrast.h"
#include "residuals/rollout_residual.h"

namespace pushid {
namespace {

// The bound of a slope, in standard deviations of its prior.
constexpr double kSlopeBound = 10.0;

using Recordings = std::vector<PendulumRecording>;

std::string Who(const PendulumRecording& recording, int person) {
  return "person " + Quoted(recording.subject_ids[person]) + " of recording " +
         Quoted(recording.id);
}

// each(recording, person) for everybody.
template <typename Each>
void ForPeople(const Recordings& recordings, const Each& each) {
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) each(recording, n);
  }
}

// A key that nobody has; known: those that there are.
Error NobodyHas(const std::string& option, const std::string& key, const std::string& what,
                const std::set<std::string>& known) {
  return Error{option + " " + Quoted(key) + ", a " + what + " has" +
               Suggestion(key, {known.begin(), known.end()}) + "; there are " +
               Listed({known.begin(), known.end()}, ",")};
}

class SlopeRows {
 public:
  SlopeRows(const Recordings& recordings, ParameterTable* table, bool priors)
      : recordings_(recordings), table_(*table), priors_(priors) {}

  // spread: what x differs by between people.
  MaybeError Add(Parameter target, const Covariate& covariate, double spread) {
    const ParameterSpec of = table_[target];
    const std::string name = of.name + "~" + covariate.key;
    if (table_.Find(name) != nullptr) {
      return Error{"--contrast and --covariate both name " + covariate.key +
                   "; a label is compared, a number is a covariate"};
    }
    if (table_.specs.size() >= static_cast<size_t>(kNumParameters)) {
      return Error{"there is no room for the slope " + name + ": a fit has at most " +
                   std::to_string(kNumOwnParameters) +
                   " (kNumOwnParameters in models/parameters.h); fix parameters that need not be "
                   "compared (--fix)"};
    }
    const bool plain = of.transform == Transform::kIdentity;
    const std::string per = covariate.is_contrast() ? "" : " per " + covariate.key;
    const std::string unit = (plain ? of.unit : "1") + per;
    const std::string meaning =
        (plain ? "difference of " : "logarithm of the ratio of ") + of.name +
        (covariate.is_contrast() ? ", " + covariate.second + " to " + covariate.first : per);
    ParameterFacts facts;
    facts.name = name;
    facts.unit = unit;
    facts.meaning = meaning;
    facts.scale = (plain ? of.scale : 1.0) / spread;
    facts.lower = -kSlopeBound * facts.scale;
    facts.upper = kSlopeBound * facts.scale;
    ParameterSpec& row = table_.Add(facts);
    row.free = true;
    row.slope_of = ParameterSpec::SlopeOf{target, covariate};
    if (priors_) row.prior = Prior{0.0, facts.scale};
    return std::nullopt;
  }

  MaybeError AddContrast(const std::string& label) {
    const Result<Covariate> values = ContrastBetween(label);
    if (!values.ok()) return values.error();
    const bool shared = SharedByRecording(label);
    for (Parameter target : table_.Free()) {
      if (IsNoiseParameter(target) || (IsPairParameter(target) && !shared)) continue;
      if (MaybeError error = Add(target, values.value(), 1.0)) return error;
    }
    return std::nullopt;
  }

  MaybeError AddNumber(const std::string& parameter, const std::string& key) {
    const ParameterSpec* target = table_.Find(parameter);
    if (target == nullptr || target->slope_of) {
      std::vector<std::string> names;
      for (Parameter id : table_.Free()) names.push_back(table_[id].name);
      return Error{"--covariate names " + Quoted(parameter) + ", which is not a parameter" +
                   Suggestion(parameter, names) + "; free ones are " +
                   ListOfNames(names, names.size())};
    }
    if (!target->free) {
      return Error{"--covariate names " + parameter +
                   ", which is fixed; free it first (--free=" + parameter + ")"};
    }
    if (IsPairParameter(target->id)) {
      return Error{"--covariate names " + parameter +
                   ", which two people share: it cannot follow what one person is like"};
    }
    std::set<double> distinct;
    std::map<std::string, std::vector<double>> of_people;
    std::string lacking;
    ForPeople(recordings_, [&](const PendulumRecording& recording, int n) {
      const std::optional<double> number = NumberOf(recording, n, key);
      if (!number && lacking.empty()) lacking = Who(recording, n);
      if (!number) return;
      distinct.insert(*number);
      of_people[recording.subject_ids[n]].push_back(*number);
    });
    if (of_people.empty()) {
      std::set<std::string> known = {kMassCovariate, kRodCovariate};
      ForPeople(recordings_, [&known](const PendulumRecording& recording, int n) {
        if (recording.known.empty()) return;
        for (const auto& [name, value] : recording.known[n].numbers) known.insert(name);
      });
      return NobodyHas("--covariate names", key, "number that nobody", known);
    }
    if (!lacking.empty()) {
      return Error{"--covariate names " + key + ", which is not known of " + lacking +
                   "; give it as a number in the manifest's subjects"};
    }
    if (std::min(distinct.size(), of_people.size()) < kLeastDistinctValues) {
      return Error{"--covariate names " + key + ", which has " + std::to_string(distinct.size()) +
                   " distinct value" + (distinct.size() == 1 ? "" : "s") + " among " +
                   std::to_string(of_people.size()) +
                   (of_people.size() == 1 ? " person" : " people") + "; a slope needs at least " +
                   std::to_string(kLeastDistinctValues) + " of both"};
    }
    std::vector<double> means;
    for (const auto& [person, values] : of_people) means.push_back(MeanOf(values).mean);
    const MeanAndError people = MeanOf(means);
    Covariate covariate;
    covariate.key = key;
    covariate.centre = people.mean;
    const double spread = people.error * std::sqrt(static_cast<double>(means.size()));
    if (!(spread > 0.0)) {
      return Error{"--covariate names " + key + ", which differs within people, not between them"};
    }
    return Add(target->id, covariate, spread);
  }

 private:
  Result<Covariate> ContrastBetween(const std::string& label) const {
    std::set<std::string> values;
    std::string lacking;
    ForPeople(recordings_, [&](const PendulumRecording& recording, int n) {
      const std::string value = LabelOf(recording, n, label);
      if (!value.empty()) values.insert(value);
      if (value.empty() && lacking.empty()) lacking = Who(recording, n);
    });
    if (values.empty()) {
      std::set<std::string> known;
      for (const PendulumRecording& recording : recordings_) {
        for (const std::string& key : recording.labels.Keys()) known.insert(key);
        for (const PersonFacts& facts : recording.known) {
          for (const auto& [key, text] : facts.texts) known.insert(key);
        }
      }
      return NobodyHas("--contrast is", label, "label that no recording or person", known);
    }
    if (!lacking.empty()) {
      return Error{"--contrast is " + Quoted(label) + ", a label that " + lacking +
                   " lacks; give it in the manifest, or leave the recording out"};
    }
    if (values.size() != 2) {
      return Error{"--contrast compares the two values of a label, and " + label + " has " +
                   std::to_string(values.size()) + " (" +
                   Listed({values.begin(), values.end()}, ",") +
                   "); choose recordings of two (--setting, --leave_out), or another label"};
    }
    Covariate covariate;
    covariate.key = label;
    covariate.first = *values.begin();
    covariate.second = *values.rbegin();
    return covariate;
  }

  // Whether nobody shares a recording with somebody of the other value.
  bool SharedByRecording(const std::string& label) const {
    bool shared = true;
    ForPeople(recordings_, [&](const PendulumRecording& recording, int n) {
      shared = shared && LabelOf(recording, n, label) == LabelOf(recording, 0, label);
    });
    return shared;
  }

  const Recordings& recordings_;
  ParameterTable& table_;
  bool priors_;
};

// A label that is compared is not pooled by as well: deviations would take part of the difference.
void UnpoolLabel(FitOptions* options, Warnings* warnings) {
  if (options->contrast.empty() || options->pool_by != options->contrast) return;
  std::vector<std::string> names;
  for (ParameterSpec& spec : options->table.specs) {
    if (spec.pooled && spec.free) names.push_back(spec.name);
    spec.pooled = false;
  }
  if (names.empty()) return;
  warnings->push_back("--contrast=" + options->contrast + " compares " + Joined(names) +
                      ", which would be pooled by the same label: not pooled");
}

}  // namespace

MaybeError AddCovariates(const std::vector<PendulumRecording>& recordings, FitOptions* options,
                         Warnings* warnings) {
  if (options->contrast.empty() && options->covariates.empty()) return std::nullopt;
  for (const ParameterSpec& spec : options->table.specs) {
    if (spec.slope_of) return std::nullopt;
  }
  if (NeedsGradientTraining(*options)) {
    return Error{std::string(options->contrast.empty() ? "--covariate" : "--contrast") +
                 " does not go together with a network that is trained by its gradient"};
  }
  const Result<std::vector<CovariatesOfParameter>> chosen = ParseCovariates(options->covariates);
  if (!chosen.ok()) return chosen.error();
  UnpoolLabel(options, warnings);
  SlopeRows rows(recordings, &options->table, options->preset_priors);
  // Contrasts first: numbers are no targets of theirs.
  if (!options->contrast.empty()) {
    if (MaybeError error = rows.AddContrast(options->contrast)) return error;
  }
  for (const CovariatesOfParameter& one : chosen.value()) {
    for (const std::string& key : one.keys) {
      if (MaybeError error = rows.AddNumber(one.parameter, key)) return error;
    }
  }
  return std::nullopt;
}

void JudgeContrastByPeople(const std::vector<PendulumRecording>& recordings, FitResult* result) {
  if (!result->contrast) return;
  const FitOptions& fitted = result->options;
  if (!fitted.covariates.empty() || fitted.likelihood != Likelihood::kTrajectory) return;
  Contrast& contrast = *result->contrast;
  // The recordings of everybody with each value of the label.
  using ByPersonAndValue =
      std::map<std::pair<std::string, std::string>, std::vector<PendulumRecording>>;
  ByPersonAndValue apart;
  for (const PendulumRecording& recording : recordings) {
    if (recording.num_people() != 1) return;
    apart[{recording.subject_ids[0], LabelOf(recording, 0, contrast.label)}].push_back(recording);
  }
  // Options of the joint fit, without slopes and pools.
  FitOptions options = fitted;
  options.contrast.clear();
  options.num_threads = 1;
  for (ParameterSpec& spec : options.table.specs) {
    spec.pooled = false;
    if (spec.slope_of) spec.free = false;
  }
  const std::vector<ByPersonAndValue::value_type> people(apart.begin(), apart.end());
  std::vector<std::optional<Result<IdentifiedModel>>> own(people.size());
  ParallelFor(static_cast<int>(people.size()), fitted.num_threads,
              [&](int i) { own[i].emplace(SolveModel(people[i].second, options)); });
  for (size_t i = 0; i < people.size(); ++i) {
    if (own[i]->ok()) continue;
    result->warnings.emplace_back("the contrast is judged by the joint fit, as " +
                                  people[i].first.first +
                                  " cannot be fitted alone: " + own[i]->error().message);
    return;
  }
  for (ContrastRow& row : contrast.rows) {
    const ParameterSpec* spec = fitted.table.Find(row.name);
    std::vector<OwnEstimate> estimates;
    bool free = row.status != EstimateStatus::kUnidentifiable;
    for (size_t i = 0; i < people.size(); ++i) {
      const auto& [person, value] = people[i].first;
      const IdentifiedModel& model = own[i]->value();
      // A parameter that one person's pushes say nothing of is held there, and is no estimate.
      free = free && model.table[spec->id].free;
      estimates.push_back({person, value == contrast.second,
                           ToFitted(spec->transform, model.parameters[spec->id])});
    }
    if (free) JudgeByPeople(spec->transform, estimates, &row);
  }
  CorrectForRows(&contrast);
}

}  // namespace pushid
