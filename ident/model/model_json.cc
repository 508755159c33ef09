// ident: a fitted model to JSON and back.
#include "ident/model/model_json.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "datasets/files/json_file.h"
#include "ident/model/model_fields.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kSchema[] = "pushid-model/1";
constexpr double kRounding = 1e-6;  // of values that are written in other digits

// Checks what readers of a result rely on and types alone do not ensure.
void CheckConsistent(const FitResult& result) {
  if (result.best_start < 0 || result.best_start >= static_cast<int>(result.starts.size())) {
    throw WrongEntry("fit/best_start", "best_start is not one of the starts");
  }
  const Uncertainty& u = result.uncertainty;
  for (const auto& [key, matrix] :
       {std::pair("covariance_fitted_scale", &u.covariance), {"correlation", &u.correlation}}) {
    const int size = static_cast<int>(u.estimates.size());
    if (matrix->rows() == size && matrix->cols() == size) continue;
    throw WrongEntry(std::string("uncertainty/") + key,
                     "sizes of covariance, correlation and parameters do not match");
  }
  if (!(result.parameters[kTailTime] > 0.0)) {
    throw WrongEntry("values/tail_time", "tail_time must be positive");
  }
  for (const Estimate& e : result.estimates) {
    const ParameterSpec* spec = result.options.table.Find(e.name);
    const double used = spec != nullptr ? result.parameters[spec->id] : e.value;
    const double off = std::fabs(e.value - used);
    if (!std::isfinite(off) || off <= kRounding * std::fabs(used)) continue;
    throw WrongEntry("parameters/" + e.name,
                     e.name + " is " + Rounded(e.value) + " here and " + Rounded(used) +
                         " under 'values', by which people are predicted; give both one value");
  }
  const auto check = [&result](const std::string& path, const std::string& unit,
                               const std::map<std::string, Estimate>& pooled) {
    for (const auto& [name, estimate] : pooled) {
      if (result.options.table.Find(name) != nullptr) continue;
      throw WrongEntry(path + "/" + name, unit + " has an unknown parameter '" + name + "'");
    }
  };
  for (const auto& [id, subject] : result.subjects) {
    check("subjects/" + id + "/pooled", "subject " + id, subject.pooled);
  }
  for (const auto& [setting, pooled] : result.settings) {
    check("settings/" + setting, "setting " + setting, pooled);
  }
}

ParameterSet<double> ValuesFrom(const Json& values, const ParameterTable& table) {
  ParameterSet<double> set{};
  for (const ParameterSpec& spec : table.specs) {
    set[spec.id] =
        ReadAt("values/" + spec.name, [&] { return values.at(spec.name).get<double>(); });
  }
  return set;
}

// Throws where the options name other networks than the one that was read.
void CheckNamedNetworks(const FitOptions& options, const LearnedTerms& read) {
  const LearnedTerms named = options.model.learned ? *options.model.learned : LearnedTerms{};
  const auto check = [](const std::string& option, const std::string& text, bool same) {
    if (same) return;
    throw WrongEntry("model/" + option, option + " is " + text + ", which self_network is not");
  };
  check("self_force", SelfForceText(options.self_force, &named),
        NetworkName(named.shape) == NetworkName(read.shape));
  check("interaction", InteractionText(options.model), PairName(named.pair) == PairName(read.pair));
}

// Errors: a law that is not among `laws`. Everything else that is wrong is thrown, and the reader's
// part() says where.
Result<FittedModel> ReadModel(const Json& json, const ForceLaws& laws, JsonArchive* reader) {
  FittedModel model;
  FitResult& fit = model.fit;
  FitOptions& options = fit.options;
  options = OptionsFrom(reader->At("model"));
  ParameterTable known = BaseTable();
  if (json.contains("force_laws")) {
    const auto names = reader->At("force_laws").get<std::vector<std::string>>();
    if (MaybeError error = AddNamedLaws(names, laws, &options.model, &known)) return *error;
  }
  options.table = TableFrom(reader->At("table"), known);
  std::shared_ptr<const LearnedTerms> learned;
  if (json.contains("self_network")) learned = LearnedFromJson(reader->At("self_network"));
  CheckNamedNetworks(options, learned ? *learned : LearnedTerms{});
  options.model.learned = std::move(learned);
  options.hold_network =
      options.model.learned != nullptr;  // a model that was read is not fitted on
  fit.parameters = ValuesFrom(reader->At("values"), options.table);
  ModelFields(*reader, model, RunInfo{});
  std::vector<Estimate>& fitted = fit.uncertainty.estimates;
  std::copy_if(fit.estimates.begin(), fit.estimates.end(), std::back_inserter(fitted),
               [](const Estimate& e) { return e.status != EstimateStatus::kFixed; });
  fitted.insert(fitted.end(), fit.nuisance.begin(), fit.nuisance.end());
  CheckConsistent(fit);
  return model;
}

}  // namespace

nlohmann::ordered_json ToJson(const FittedModel& model, const RunInfo& run) {
  Json json = {{"schema", kSchema}, {"format", "pushid model"}, {"format_version", kModelFormat}};
  json.get_ref<Json::object_t&>().reserve(64);  // it would copy all of itself where it grows
  JsonArchive archive(&json);
  ModelFields(archive, const_cast<FittedModel&>(model), run);
  return json;
}

MaybeError WriteFittedModel(const std::string& path, const FittedModel& model, int num_threads,
                            double total_seconds) {
  RunInfo run;
  char date[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  run.date = date;
  char host[256] = "";
  if (gethostname(host, sizeof host - 1) == 0) run.host = host;
  run.model_path = path;
  run.num_threads = num_threads;
  run.total_seconds = total_seconds;
  return WriteJson(path, ToJson(model, run));
}

nlohmann::ordered_json ToJson(const Behaviour& behaviour) { return JsonOf(behaviour); }

Result<FittedModel> FittedModelFromJson(const nlohmann::ordered_json& json, const std::string& file,
                                        const ForceLaws& laws) {
  if (!json.is_object() || !json.contains("format") || json["format"] != "pushid model" ||
      !json.contains("format_version") || !json["format_version"].is_number()) {
    const bool named = json.is_object() && json.contains("schema") && json["schema"].is_string();
    return Error{"this is not a pushid model (pushid-fit --model_out writes one)" +
                     (named ? "; its schema is " + json["schema"].get<std::string>() : ""),
                 file};
  }
  const bool other = json.contains("schema") && json["schema"] != kSchema;
  if (other || json["format_version"] > kModelFormat) {
    return Error{"written by a newer pushid; update pushid to read it", file};
  }
  const auto damaged = [&](const std::string& part, const std::exception& exception) {
    std::string remedy = "; use another copy or fit again";
    const bool has_version = json.contains("version") && json["version"].is_string();
    if (has_version && json["version"] != std::string(PUSHID_VERSION)) {
      remedy += " (pushid " + json["version"].get<std::string>() + " wrote it, this is " +
                PUSHID_VERSION + "; to convert it, run pushid-fit on the manifest under 'run' " +
                "with the flags under 'configuration')";
    }
    return Error{"incomplete or damaged model, at '" + part + "': " + ReasonOf(exception) + remedy,
                 file};
  };
  JsonArchive reader(json);
  try {
    Result<FittedModel> model = ReadModel(json, laws, &reader);
    if (model.ok()) return model;
    Error error = model.error();
    error.file = file;
    return error;
  } catch (const WrongEntry& wrong) {
    return damaged(wrong.path(), wrong);
  } catch (const std::exception& exception) {
    return damaged(reader.part(), exception);
  }
}

Result<FittedModel> ReadFittedModel(const std::string& path, const ForceLaws& laws) {
  Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  Result<FittedModel> model = FittedModelFromJson(document.value().content, path, laws);
  if (model.ok()) model.value().provenance.model_file = path;
  return model;
}

}  // namespace pushid
