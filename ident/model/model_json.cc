// ident: a fitted model to JSON and back.
#include "ident/model/model_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "ident/model/confidence_fields.h"
#include "ident/model/model_fields.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/network_json.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

Json ValuesJson(const ParameterTable& table, const ParameterSet<double>& set) {
  Json values = Json::object();
  for (const ParameterSpec& spec : table.specs) values[spec.name] = set[spec.id];
  return values;
}

Json EnsembleJson(const FitResult& fit) {
  Json members = Json::array();
  for (const EnsembleMember& member : fit.others) {
    members.push_back({{"values", ValuesJson(fit.options.table, member.parameters)},
                       {"self_network", ToJson(*member.network)}});
  }
  return members;
}

// The file from top to bottom. Entries that are only written are read by ModelReader first: the
// others are of a model whose options and parameters are known.
template <class Archive>
void ModelFields(Archive& a, FittedModel& model, const RunInfo& run) {
  FitResult& fit = model.fit;
  Provenance& from = model.provenance;
  const ModelOptions& options = fit.options.model;
  a("version", from.version);
  a.Written("model", [&] { return OptionsJson(fit.options); });
  a("parameters", fit.estimates);
  a("derived", fit.derived);
  a("nuisance", fit.nuisance);
  a("subjects", fit.subjects);
  a("settings", fit.settings);
  a.Written("values", [&] { return ValuesJson(fit.options.table, fit.parameters); });
  a("behaviour", fit.behaviour);
  a("uncertainty", fit.uncertainty);
  if (a.Has("verdict")) a("verdict", fit.verdict);
  if (a.Has("diagnostics")) {
    a.Group("diagnostics", [&](auto& g) {
      Fields(g, fit.diagnostics);
      g("advice", model.advice);
    });
  }
  WarningFields(a, "warnings", fit.warnings);
  a.Group("fit", [&](auto& g) {
    g("converged", fit.converged);
    g("cost", fit.cost);
    g("message", fit.message);
    g("best_start", fit.best_start);
    g("starts", fit.starts);
  });
  a.Written("table", [&] { return TableJson(fit.options.table); });
  a.Group("data", [&](auto& g) {
    g("manifest_hash", from.manifest_hash);
    g("setting", from.setting);
    g("recordings", fit.recordings);
  });
  a("configuration", from.configuration);
  if (a.Has("changed_flags")) a("changed_flags", from.changed_flags);
  a.Group("run", [&](auto& g) {
    g.Written("date", [&] { return run.date; });
    g.Written("host", [&] { return run.host; });
    g("manifest", from.manifest);
    g.Written("model_out", [&] { return run.model_path; });
    g("solve_seconds", fit.solve_seconds);
    g.Written("total_seconds", [&] { return run.total_seconds; });
    g.Written("num_threads", [&] { return run.num_threads; });
  });
  a.Optional("contrast", fit.contrast);
  a.Optional("feet", fit.feet);
  a.Optional("push_range", fit.push_range);
  a.Optional("step_probability", fit.step_probability);
  a.Optional("likelihood", fit.likelihood);
  a.Optional("recording_effect", fit.recording_effect);
  a.Optional("forecasts", fit.forecasts);
  if (options.learned != nullptr) {
    a.Written("self_network", [&] { return ToJson(*options.learned); });
  }
  a.Optional("network_takeover", fit.takeover);
  a.Optional("contact_takeover", fit.contact_takeover);
  if (!fit.others.empty()) a.Written("ensemble", [&] { return EnsembleJson(fit); });
  if (const auto laws = LawNames(options); !laws.empty()) {
    a.Written("force_laws", [&] { return laws; });
  }
  if (options.interaction_network != nullptr) {
    a.Written("interaction_network", [&] { return ToJson(*options.interaction_network); });
  }
  if (a.Has("profiles", !model.profiles.empty())) a("profiles", model.profiles);
  a.Optional("bootstrap", model.bootstrap);
  a.Optional("push_check", model.push_check);
  a.Optional("prior_check", model.prior_check);
  a.Optional("horizon_check", model.horizon_check);
}

// What the types alone do not ensure and readers of a result rely on.
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

// Reads a model part by part, and knows which one it is at.
class ModelReader {
 public:
  explicit ModelReader(const Json& json) : json_(json), reader_(json) {}

  // Errors: a law that is not here. Everything else that is wrong is thrown, and part() says where.
  MaybeError Read(const ForceLaws& laws) {
    if (MaybeError error = ReadOptions(laws)) return error;
    ReadLearned();
    ReadValues();
    ModelFields(reader_, model_, RunInfo{});
    Uncertainty& u = result_.uncertainty;
    for (const Estimate& e : result_.estimates) {
      if (e.status != EstimateStatus::kFixed) u.estimates.push_back(e);
    }
    u.estimates.insert(u.estimates.end(), result_.nuisance.begin(), result_.nuisance.end());
    CheckConsistent(result_);
    return std::nullopt;
  }

  const std::string& part() const { return reader_.part(); }
  FittedModel& model() { return model_; }

 private:
  const Json& At(const char* key) { return reader_.At(key); }

  MaybeError ReadOptions(const ForceLaws& laws) {
    ParameterTable known = BaseTable();
    result_.options = OptionsFrom(At("model"));
    if (json_.contains("force_laws")) {
      const auto names = At("force_laws").get<std::vector<std::string>>();
      if (MaybeError error = AddNamedLaws(names, laws, &result_.options.model, &known)) {
        return error;
      }
    }
    result_.options.table = TableFrom(At("table"), known);
    return std::nullopt;
  }

  void ReadLearned() {
    ModelOptions& options = result_.options.model;
    if (json_.contains("self_network")) {
      options.learned = LearnedFromJson(At("self_network"));
      result_.options.hold_network = true;  // what is read is not fitted on
    }
    const std::string learned = At("model").at("self_force");
    if (SelfForceText(result_.options.self_force, options.learned.get()) != learned) {
      throw WrongEntry("model/self_force",
                       "self_force is " + learned + ", which self_network is not");
    }
    const std::string interaction = At("model").at("interaction");
    const auto named = ParseInteraction("interaction", interaction);
    const PairShape pair = options.learned != nullptr ? options.learned->pair : PairShape{};
    if (!named.ok() || named.value().pair.hidden != pair.hidden ||
        named.value().pair.ldp != pair.ldp) {
      throw WrongEntry("model/interaction",
                       "interaction is " + interaction + ", which self_network is not");
    }
    if (json_.contains("interaction_network")) {
      options.interaction_network = InteractionNetworkFromJson(At("interaction_network"));
    }
  }

  // A model written before there was such a parameter, which its table does not name then, has its
  // nominal value: nothing it did used it.
  ParameterSet<double> ValuesFrom(const Json& values, const std::string& path) {
    const Json& rows = json_.at("table");
    ParameterSet<double> set{};
    for (const ParameterSpec& spec : result_.options.table.specs) {
      const bool known = std::any_of(rows.begin(), rows.end(), [&spec](const Json& row) {
        return row.at("name") == spec.name;
      });
      set[spec.id] =
          known ? ReadAt(path + "/" + spec.name, [&] { return values.at(spec.name).get<double>(); })
                : spec.nominal;
    }
    return set;
  }

  EnsembleMember MemberFrom(const Json& json, const std::string& path) {
    EnsembleMember member;
    const Json& values = ReadAt(path, [&]() -> const Json& { return json.at("values"); });
    member.parameters = ValuesFrom(values, path + "/values");
    const std::string at = path + "/self_network";
    member.network = ReadAt(at, [&] { return LearnedFromJson(json.at("self_network")); });
    const auto& network = result_.options.model.learned;
    if (network == nullptr || LearnedName(*member.network) != LearnedName(*network)) {
      throw WrongEntry(at, "a member's network is not that of self_network");
    }
    return member;
  }

  void ReadValues() {
    result_.parameters = ValuesFrom(At("values"), "values");
    if (!json_.contains("ensemble")) return;
    const Json& members = At("ensemble");
    for (size_t i = 0; i < members.size(); ++i) {
      result_.others.push_back(MemberFrom(members.at(i), "ensemble/" + std::to_string(i)));
    }
  }

  const Json& json_;
  JsonReader reader_;
  FittedModel model_;
  FitResult& result_ = model_.fit;
};

}  // namespace

nlohmann::ordered_json ToJson(const FittedModel& model, const RunInfo& run) {
  Json json = {{"format", "pushid model"}, {"format_version", kModelFormat}};
  JsonWriter writer(&json);
  ModelFields(writer, const_cast<FittedModel&>(model), run);
  return json;
}

nlohmann::ordered_json ToJson(const Behaviour& behaviour) { return JsonOf(behaviour); }

Result<FittedModel> FittedModelFromJson(const nlohmann::ordered_json& json, const std::string& file,
                                        const ForceLaws& laws) {
  if (!json.is_object() || !json.contains("format") || json["format"] != "pushid model" ||
      !json.contains("format_version") || !json["format_version"].is_number()) {
    return Error{"this is not a pushid model (pushid-fit --model_out writes one)", file};
  }
  if (json["format_version"] > kModelFormat) {
    return Error{"written by a newer pushid; update pushid to read it", file};
  }
  const auto damaged = [&file](const std::string& part, const std::exception& exception) {
    return Error{"incomplete or damaged model, at '" + part + "': " + ReasonOf(exception) +
                     "; use another copy or fit again",
                 file};
  };
  ModelReader reader(json);
  try {
    if (MaybeError error = reader.Read(laws)) {
      error->file = file;
      return *error;
    }
    return std::move(reader.model());
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
