// ident: whether options can be used.
#include "ident/parameters/fit_options.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "ident/parameters/json_archive.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/option_table.h"
#include "ident/parameters/parameter_table.h"
#include "models/learned_terms.h"

namespace pushid {
namespace {

// What options of networks ask for that there is not; empty: nothing.
std::string MissingNetwork(const FitOptions& o) {
  const auto& network = o.model.learned;
  const bool pair = network != nullptr && network->pair.any();
  if (o.model.interaction.learned_in_range != (pair && network->pair.ldp)) {
    return "--interaction names another network between people than there is";
  }
  if (o.model.interaction.learned != pair) {
    return pair ? "a network between people is there, but --interaction does not name network:SIZES"
                : "--interaction names a network to be fitted, but there is none; name its layers, "
                  "as in --interaction=spring,damping,network:4";
  }
  return "";
}

// What feet that hold cannot do together with the rest; empty: nothing.
std::string StanceViolation(const FitOptions& o) {
  if (o.model.stance == Stance::kSlide) return "";
  const char* sliding = RodMoves(o.model)          ? "--rod"
                        : NeedsGradientTraining(o) ? "a network that is trained by its gradient"
                        : o.model.push != PushUse::kAsRecorded             ? "a push that is added"
                        : o.model.cart_derivative != CartDerivative::kNone ? "the cart's derivative"
                                                                           : nullptr;
  if (sliding == nullptr) return "";
  return std::string(sliding) + " is for feet that slide and does not go together with --stance=" +
         NameOf(o.model.stance) + "; drop one of the two";
}

}  // namespace

bool FitOptions::IsValid(std::string* error) const {
  for (const FitOptionRow& row : AllOptionRows()) {
    const std::string violated = row.violation ? row.violation(*this) : "";
    if (violated.empty()) continue;
    *error = (row.is_flag ? "--" : "") + row.name + " is " + row.text(*this) + "; it " + violated;
    return false;
  }
  *error = MissingNetwork(*this);
  if (error->empty()) *error = StanceViolation(*this);
  if (error->empty() && table.Free().empty()) {
    *error = "every parameter is fixed: nothing is left to fit";
  }
  return error->empty();
}

bool IsLarge(const FitOptions& options) {
  const auto& network = options.model.learned;
  return network != nullptr && static_cast<int>(network->weights.size()) > kMostGaussNewtonWeights;
}

template <class Archive>
void Fields(Archive& a, Prior& prior) {
  PUSHID_FIELDS(a, prior, mean, sigma);
}

namespace {

using Json = nlohmann::ordered_json;

// Options of earlier versions, and their values that did nothing or are those of now. A model that
// has these can still be read.
constexpr std::pair<const char*, double> kRetiredOptions[] = {{"stability_weight", 0.0},
                                                              {"takeover_weight", 0.0},
                                                              {"ensemble", 1.0},
                                                              {"body_weight", 0.0},
                                                              {"mode_margin_per_s", 0.2}};
// Parameters of earlier versions, of terms that `interaction` or `process_noise` would name.
constexpr const char* kRetiredParameters[] = {"drive_gain",  "drive_torque",  "drive_time",
                                              "noise_y_x",   "noise_theta_x", "noise_theta_y",
                                              "noise_phi_x", "noise_phi_y",   "noise_phi_theta",
                                              "noise_speed", "noise_push"};

// One row of the table, which names other rows.
template <class Archive>
void RowFields(Archive& a, ParameterSpec& spec, const ParameterTable& table) {
  const auto find = [&table](const std::string& name, const std::string& otherwise) {
    const ParameterSpec* found = table.Find(name);
    if (found == nullptr) throw std::runtime_error(otherwise);
    return found->id;
  };
  PUSHID_FIELDS(a, spec, name, unit, nominal);
  a.Pair("bounds", spec.lower, spec.upper);
  PUSHID_FIELDS(a, spec, scale, transform, free, pooled, meaning);
  a.Optional("prior", spec.prior);
  if (a.Has("tied_to", spec.tied_to.has_value())) {
    a.Via(
        "tied_to", [&] { return table[*spec.tied_to].name; },
        [&](const std::string& to) {
          spec.tied_to = find(to, spec.name + " is tied to an unknown parameter");
        });
  }
  if (a.Has("slope_of", spec.slope_of.has_value())) {
    ParameterSpec::SlopeOf& slope = spec.slope_of ? *spec.slope_of : spec.slope_of.emplace();
    Covariate& covariate = slope.covariate;
    a.Group("slope_of", [&](auto& g) {
      g.Via(
          "parameter", [&] { return table[slope.target].name; },
          [&](const std::string& of) {
            slope.target = find(of, "a slope of an unknown parameter");
          });
      g("covariate", covariate.key);
      if (g.Has("values", covariate.is_contrast())) {
        g.Pair("values", covariate.first, covariate.second);
      } else {
        g("centre", covariate.centre);
      }
    });
  }
  if (a.Has("pooling_sigma", spec.pooled)) a("pooling_sigma", spec.pooling_sigma);
}

}  // namespace

Json TableJson(const ParameterTable& table) {
  Json rows = Json::array();
  for (ParameterSpec spec : table.specs) {
    JsonWriter writer(&rows.emplace_back(Json::object()));
    RowFields(writer, spec, table);
  }
  return rows;
}

Json OptionsJson(const FitOptions& options) {
  Json json;
  for (const FitOptionRow& row : AllOptionRows()) {
    if (!row.json.empty()) json[Json::json_pointer(row.json)] = row.write(options);
  }
  return json;
}

void AddLawNames(const ModelOptions& model, Json* json) {
  const std::vector<std::string> laws = LawNames(model);
  if (!laws.empty()) (*json)["force_laws"] = laws;
}

Json SettingsJson(const FitOptions& options) {
  Json json = {{"model", OptionsJson(options)}, {"table", TableJson(options.table)}};
  AddLawNames(options.model, &json);
  return json;
}

ParameterTable TableFrom(const Json& json, const ParameterTable& known) {
  ParameterTable table = known;
  for (const Json& row : json) {
    const std::string name = row.at("name");
    if (std::count(std::begin(kRetiredParameters), std::end(kRetiredParameters), name) > 0) {
      continue;
    }
    ParameterSpec* spec = table.Find(name);
    if (spec == nullptr && row.contains("slope_of")) {
      if (table.specs.size() >= static_cast<size_t>(kNumParameters)) {
        throw std::runtime_error("there is no room for '" + name + "'");
      }
      ParameterFacts facts;
      facts.name = name;
      spec = &table.Add(facts);
    }
    if (spec == nullptr) throw std::runtime_error("unknown parameter '" + name + "'");
    spec->pooling_sigma = kFirstPoolingSigma;
    spec->tied_to.reset();
    spec->prior.reset();
    JsonReader reader(row);
    RowFields(reader, *spec, table);
  }
  return table;
}

FitOptions OptionsFrom(const Json& json) {
  FitOptions options;
  for (const auto& [retired, unused] : kRetiredOptions) {
    if (json.value(retired, unused) == unused) continue;
    throw std::runtime_error(std::string(retired) +
                             " was an option of earlier versions; models fitted with it cannot be "
                             "read any more");
  }
  for (const FitOptionRow& row : AllOptionRows()) {
    if (row.json.empty()) continue;
    const Json::json_pointer place(row.json);
    if (row.may_be_absent && !json.contains(place)) continue;
    row.read(json.at(place), &options);
  }
  return options;
}

}  // namespace pushid
