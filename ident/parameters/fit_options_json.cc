// ident: options and parameter tables to and from JSON.
#include "ident/parameters/fit_options_json.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "ident/parameters/option_table.h"
#include "ident/parameters/own_laws.h"

namespace pushid {

namespace {

using Json = nlohmann::ordered_json;

// Of earlier versions. A model that did without them is as good as ever.
constexpr const char* kRetiredWeights[] = {"stability_weight", "takeover_weight"};
// The parameters of the interaction term `drive`, which `interaction` would name.
constexpr const char* kRetiredParameters[] = {"drive_gain", "drive_torque", "drive_time"};

}  // namespace

Json TableJson(const ParameterTable& table) {
  Json rows = Json::array();
  for (const ParameterSpec& spec : table.specs) {
    Json row = {{"name", spec.name},       {"unit", spec.unit},
                {"nominal", spec.nominal}, {"bounds", {spec.lower, spec.upper}},
                {"scale", spec.scale},     {"transform", NameOf(spec.transform)},
                {"free", spec.free},       {"pooled", spec.pooled},
                {"meaning", spec.meaning}};
    if (spec.prior) row["prior"] = {{"mean", spec.prior->mean}, {"sigma", spec.prior->sigma}};
    if (spec.pooled) row["pooling_sigma"] = spec.pooling_sigma;
    rows.push_back(row);
  }
  return rows;
}

Json OptionsJson(const FitOptions& options) {
  Json json;
  for (const FitOptionRow& row : FitOptionRows()) {
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
    if (spec == nullptr) throw std::runtime_error("unknown parameter '" + name + "'");
    spec->unit = row.at("unit");
    spec->nominal = row.at("nominal");
    spec->lower = row.at("bounds").at(0);
    spec->upper = row.at("bounds").at(1);
    spec->scale = row.at("scale");
    spec->transform = EnumFrom<Transform>(row, "transform");
    spec->free = row.at("free");
    spec->pooled = row.at("pooled");
    spec->pooling_sigma = row.value("pooling_sigma", kFirstPoolingSigma);
    spec->meaning = row.at("meaning");
    spec->prior.reset();
    if (row.contains("prior")) {
      spec->prior = Prior{row.at("prior").at("mean"), row.at("prior").at("sigma")};
    }
  }
  return table;
}

FitOptions OptionsFrom(const Json& json) {
  FitOptions options;
  for (const char* retired : kRetiredWeights) {
    if (json.value(retired, 0.0) == 0.0) continue;
    throw std::runtime_error(std::string(retired) +
                             " was an option of earlier versions; models fitted with it cannot be "
                             "read any more");
  }
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.json.empty()) continue;
    const Json::json_pointer place(row.json);
    if (row.may_be_absent && !json.contains(place)) continue;
    row.read(json.at(place), &options);
  }
  return options;
}

}  // namespace pushid
