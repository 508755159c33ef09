// ident: the parameters of a fit.
#include "ident/parameters/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"

namespace pushid {

ParameterTable BaseTable() {
  ParameterTable table;
  for (const ParameterRow& row : kParameterRows) table.Add(row.facts);
  return table;
}

ParameterSpec& ParameterTable::Add(const ParameterFacts& facts) {
  ParameterSpec spec;
  spec.id = static_cast<Parameter>(specs.size());
  spec.name = facts.name;
  spec.unit = facts.unit;
  spec.nominal = facts.nominal;
  spec.lower = facts.lower;
  spec.upper = facts.upper;
  spec.scale = facts.scale;
  spec.transform = facts.transform;
  spec.meaning = facts.meaning;
  specs.push_back(std::move(spec));
  return specs.back();
}

const ParameterSpec* ParameterTable::Find(const std::string& name) const {
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return &spec;
  }
  return nullptr;
}

ParameterSpec* ParameterTable::Find(const std::string& name) {
  return const_cast<ParameterSpec*>(static_cast<const ParameterTable*>(this)->Find(name));
}

std::vector<Parameter> ParameterTable::Free() const {
  std::vector<Parameter> free;
  for (const ParameterSpec& spec : specs) {
    if (spec.free) free.push_back(spec.id);
  }
  return free;
}

ParameterSet<double> ParameterTable::Values() const {
  ParameterSet<double> values{};
  for (const ParameterSpec& spec : specs) values[spec.id] = spec.nominal;
  SetTied(&values);
  return values;
}

void ParameterTable::SetTied(ParameterSet<double>* values) const {
  for (const ParameterSpec& spec : specs) {
    if (spec.tied_to) (*values)[spec.id] = (*values)[*spec.tied_to];
  }
}

ParameterMap ParameterTable::Map() const {
  ParameterMap map;
  map.values = Values();
  for (Parameter id : Free()) {
    const int deviation = specs[id].pooled ? map.num_deviations++ : -1;
    map.fitted.push_back({id, specs[id].transform, deviation});
    for (const ParameterSpec& spec : specs) {
      if (spec.tied_to == id) map.fitted.back().also = spec.id;
    }
  }
  for (const ParameterSpec& spec : specs) {
    if (!spec.slope_of) continue;
    const auto& [target, covariate] = *spec.slope_of;
    const auto known = std::find(map.covariates.begin(), map.covariates.end(), covariate);
    CovariateShift shift{spec.id, target, specs[target].transform,
                         static_cast<int>(known - map.covariates.begin())};
    if (known == map.covariates.end()) map.covariates.push_back(covariate);
    for (const ParameterSpec& other : specs) {
      if (other.tied_to == target) shift.also = other.id;
    }
    map.shifts.push_back(shift);
  }
  return map;
}

double PoolingSigma(const ParameterSpec& spec) {
  return spec.pooling_sigma * (spec.transform == Transform::kIdentity ? spec.scale : 1.0);
}

bool AnyPooled(const ParameterTable& table) {
  return std::any_of(table.specs.begin(), table.specs.end(),
                     [](const ParameterSpec& spec) { return spec.free && spec.pooled; });
}

std::string ParameterGlossary() {
  std::string text =
      "| name | symbol | unit | without preset | bounds | meaning | when to free it |\n"
      "|---|---|---|--:|---|---|---|\n";
  for (const ParameterRow& row : kParameterRows) {
    const ParameterFacts& facts = row.facts;
    const std::string bounds = Rounded(facts.lower) + " to " + Rounded(facts.upper);
    text += "| " +
            Joined({std::string(facts.name), std::string(facts.symbol), std::string(facts.unit),
                    Rounded(facts.nominal), bounds, std::string(facts.meaning),
                    std::string(facts.when_to_free)},
                   " | ") +
            " |\n";
  }
  return text;
}

namespace {

std::vector<std::string> NonEmptyParts(const std::string& text, char separator) {
  std::vector<std::string> parts = SplitList(text, separator);
  parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
  return parts;
}

Error UnknownName(const std::string& name, const std::string& flag, const ParameterTable& table) {
  std::vector<std::string> names;
  for (const ParameterSpec& spec : table.specs) names.push_back(spec.name);
  const std::string meant = Suggestion(name, names);
  return Error{flag + " names '" + name + "', which is not a parameter" +
               (meant.empty() ? "; there are " + Listed(names, ",") : meant)};
}

// Items "name" and "name=value", comma-separated; of the first the value is NaN. A name stands
// once, as nobody knows which of two values is meant.
Result<std::vector<NamedValue>> ParseItems(const std::string& list, const std::string& flag) {
  std::vector<NamedValue> items;
  std::set<std::string> names;
  for (const std::string& text : NonEmptyParts(list, ',')) {
    const size_t equals = text.find('=');
    NamedValue item{text.substr(0, equals), NAN};
    if (equals != std::string::npos && !ParseDouble(text.substr(equals + 1), &item.value)) {
      return Error{flag + ": '" + text + "' has no number after '='"};
    }
    if (!names.insert(item.name).second) return Error{flag + " names " + item.name + " twice"};
    items.push_back(item);
  }
  return items;
}

MaybeError CheckInBounds(const ParameterSpec& spec, double value, const std::string& flag) {
  if (value >= spec.lower && value <= spec.upper) return std::nullopt;
  std::ostringstream text;
  text << flag << ": " << spec.name << " = " << value << " lies outside its bounds [" << spec.lower
       << ", " << spec.upper << "] " << spec.unit;
  return Error{text.str()};
}

MaybeError Assign(const std::string& list, const std::string& flag, std::optional<bool> make_free,
                  bool value_needed, ParameterTable* table) {
  const Result<std::vector<NamedValue>> items = ParseItems(list, flag);
  if (!items.ok()) return items.error();
  for (const NamedValue& item : items.value()) {
    const bool has_value = !std::isnan(item.value);
    ParameterSpec* spec = table->Find(item.name);
    if (spec == nullptr) return UnknownName(item.name, flag, *table);
    if (value_needed && !has_value) {
      return Error{flag + ": '" + item.name + "' needs a value, as in " + item.name + "=1"};
    }
    if (has_value) {
      // A fixed parameter may sit on zero, where a log scale has no place for a free one; not
      // those that divide: the tail's time, and those of feet that stand.
      const bool free_after = make_free.value_or(spec->free);
      const bool may_be_zero =
          !free_after && spec->transform == Transform::kLog && spec->id != kTailTime &&
          !(spec->id >= kSupportFront && spec->id <= kStepSwing && spec->id != kStepGain);
      if (!may_be_zero || item.value != 0.0) {
        if (MaybeError error = CheckInBounds(*spec, item.value, flag)) return error;
      }
      spec->nominal = item.value;
    }
    if (make_free.has_value()) spec->free = *make_free;
    spec->named = true;
    spec->tied_to.reset();
  }
  return std::nullopt;
}

MaybeError AddPriors(const std::string& list, ParameterTable* table) {
  std::set<std::string> names;
  for (const std::string& text : NonEmptyParts(list, ',')) {
    const std::vector<std::string> parts = NonEmptyParts(text, ':');
    Prior prior{};
    if (parts.size() != 3 || !ParseDouble(parts[1], &prior.mean) ||
        !ParseDouble(parts[2], &prior.sigma) || prior.sigma <= 0.0) {
      return Error{"--prior: '" + text +
                   "' is not name:mean:sigma with sigma > 0, as in mu:100:30"};
    }
    ParameterSpec* spec = table->Find(parts[0]);
    if (spec == nullptr) return UnknownName(parts[0], "--prior", *table);
    if (!names.insert(parts[0]).second) return Error{"--prior names " + parts[0] + " twice"};
    if (MaybeError error = CheckInBounds(*spec, prior.mean, "--prior")) return error;
    spec->prior = prior;
    spec->named = true;
    spec->tied_to.reset();
  }
  return std::nullopt;
}

Error Misspelt(const std::string& part) {
  return Error{"--covariate: " + Quoted(part) +
               " is not PARAMETER ~ KEY + KEY, as in 'Kp_theta ~ age + height; Kd_theta ~ age'"};
}

}  // namespace

Result<std::vector<CovariatesOfParameter>> ParseCovariates(const std::string& text) {
  std::vector<CovariatesOfParameter> all;
  std::set<std::string> seen;
  for (const std::string& entry : SplitList(text, ';')) {
    const std::string part = std::string(Trimmed(entry));
    if (part.empty()) continue;
    const size_t tilde = part.find('~');
    if (tilde == std::string::npos || part.find('~', tilde + 1) != std::string::npos) {
      return Misspelt(part);
    }
    CovariatesOfParameter one{std::string(Trimmed(part.substr(0, tilde))), {}};
    const std::string keys = std::string(Trimmed(part.substr(tilde + 1)));
    if (one.parameter.empty() || keys.empty() || keys.back() == '+') return Misspelt(part);
    for (const std::string& word : SplitList(keys, '+')) {
      one.keys.push_back(std::string(Trimmed(word)));
      if (one.keys.back().empty()) return Misspelt(part);
      if (!seen.insert(one.parameter + "~" + one.keys.back()).second) {
        return Error{"--covariate names " + one.keys.back() + " of " + one.parameter + " twice"};
      }
    }
    all.push_back(std::move(one));
  }
  return all;
}

Result<std::vector<NamedValue>> ParseAssignments(const std::string& text, const std::string& flag) {
  Result<std::vector<NamedValue>> items = ParseItems(text, flag);
  if (!items.ok()) return items;
  for (const NamedValue& item : items.value()) {
    if (std::isnan(item.value)) return Error{flag + ": '" + item.name + "' is not name=value"};
  }
  return items;
}

MaybeError CheckTouching(const std::string& assignments, const std::string& flag,
                         const ParameterTable& table, const ModelOptions& model) {
  for (const std::string& part : NonEmptyParts(assignments, ',')) {
    const ParameterSpec* spec = table.Find(part.substr(0, part.find('=')));
    if (spec == nullptr || !IsPairParameter(spec->id) || Acts(spec->id, model)) continue;
    return Error{flag + " names " + spec->name +
                 ", which acts only between people who touch, and this model has no contact; leave "
                 "it out, or fit with --preset=group or --interaction=spring,damping"};
  }
  return std::nullopt;
}

bool PoolsAllOrNone(const std::string& pool) {
  return pool == "none" || pool.substr(0, pool.find(',')) == "all";
}

MaybeError EditTable(const TableEdits& edits, ParameterTable* table) {
  if (MaybeError error = Assign(edits.set, "--set", std::nullopt, true, table)) return error;
  if (MaybeError error = Assign(edits.free, "--free", true, false, table)) return error;
  if (MaybeError error = Assign(edits.fix, "--fix", false, false, table)) return error;
  if (MaybeError error = AddPriors(edits.prior, table)) return error;
  const auto may_differ = [&edits](const ParameterSpec& spec) {
    return HoldsForRecording(edits.pool_by) || !IsPairParameter(spec.id);
  };
  for (const std::string& entry : NonEmptyParts(edits.pool, ',')) {
    if (entry == "none") continue;
    const bool left_out = entry[0] == '-';
    const std::string name = entry.substr(left_out ? 1 : 0);
    if (name == "all") {
      for (ParameterSpec& spec : table->specs) spec.pooled = spec.free && may_differ(spec);
      continue;
    }
    ParameterSpec* spec = table->Find(name);
    if (spec == nullptr) return UnknownName(name, "--pool", *table);
    if (left_out) {
      spec->pooled = false;
      continue;
    }
    if (!spec->free) return Error{"--pool names " + name + ", which is fixed; free it first"};
    if (!may_differ(*spec)) {
      return Error{"--pool names " + spec->name +
                   ", which two people share: it may differ by setting (--pool_by=setting), not by "
                   "subject"};
    }
    spec->pooled = true;
  }
  return std::nullopt;
}

MaybeError AddForceLaw(std::shared_ptr<const ForceLaw> law, ModelOptions* model,
                       ParameterTable* table) {
  const std::string who = "force law '" + law->name() + "'";
  for (const std::string& name : LawNames(*model)) {
    if (name == law->name()) return Error{who + ": the model has one of that name; rename it"};
  }
  if (std::any_of(table->specs.begin(), table->specs.end(),
                  [](const ParameterSpec& spec) { return spec.slope_of.has_value(); })) {
    return Error{who + ": add force laws before the fit is prepared, which adds covariates"};
  }
  const int free_slots = kNumOwnParameters - NumOwnParameters(*model);
  const int wanted = static_cast<int>(law->parameters().size());
  if (wanted > free_slots) {
    return Error{
        who + " has " + std::to_string(wanted) + " parameters; there is room for " +
        std::to_string(free_slots) +
        " (kNumOwnParameters in models/parameters.h is the room for all laws and covariates)"};
  }
  ParameterTable with = *table;
  for (const ParameterFacts& facts : law->parameters()) {
    if (with.Find(std::string(facts.name)) != nullptr) {
      return Error{who + ": there is a parameter '" + std::string(facts.name) +
                   "' already; rename the law's"};
    }
    if (const std::string violated = Violation(facts); !violated.empty()) {
      return Error{who + ": its parameter '" + std::string(facts.name) + "' " + violated};
    }
    with.Add(facts).free = true;
  }
  *table = std::move(with);
  model->own_laws.push_back(std::move(law));
  return {};
}

MaybeError AddNamedLaws(const std::vector<std::string>& names, const ForceLaws& laws,
                        ModelOptions* model, ParameterTable* table) {
  for (const std::string& name : names) {
    const auto found = std::find_if(laws.begin(), laws.end(),
                                    [&name](const auto& law) { return law->name() == name; });
    if (found == laws.end()) {
      return Error{"the model was fitted with the force law '" + name +
                   "', which is not part of pushid; read it with a program that has that law and "
                   "gives it to ReadFittedModel"};
    }
    if (MaybeError error = AddForceLaw(*found, model, table)) return error;
  }
  return {};
}

std::vector<std::string> LawNames(const ModelOptions& model) {
  std::vector<std::string> names;
  for (const auto& law : model.own_laws) names.push_back(law->name());
  return names;
}

}  // namespace pushid
