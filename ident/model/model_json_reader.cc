// ident: a fitted model from JSON. model_json_writer.cc is the inverse.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "datasets/files/json_file.h"
#include "ident/model/confidence_json.h"
#include "ident/model/json_pieces.h"
#include "ident/model/model_json.h"
#include "ident/model/recording_effect_json.h"
#include "ident/model/refit_json.h"
#include "ident/model/step_probability_json.h"
#include "ident/model/takeover_json.h"
#include "ident/parameters/fit_options_json.h"
#include "ident/parameters/learned_terms_io.h"
#include "ident/parameters/network_json.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

// A model written before there was such a parameter, which its table does not name then, has its
// nominal value: nothing it did used it.
double ValueFrom(const Json& values, const Json& table, const ParameterSpec& spec) {
  const bool known = std::any_of(table.begin(), table.end(),
                                 [&spec](const Json& row) { return row.at("name") == spec.name; });
  return known ? values.at(spec.name).get<double>() : spec.nominal;
}

EnsembleMember MemberFrom(const Json& json, const Json& rows, const ParameterTable& table) {
  EnsembleMember member;
  for (const ParameterSpec& spec : table.specs) {
    member.parameters[spec.id] = ValueFrom(json.at("values"), rows, spec);
  }
  member.network = LearnedFromJson(json.at("self_network"));
  return member;
}

Behaviour BehaviourFrom(const Json& json) {
  Behaviour b;
  b.settles = json.at("settles");
  b.self_propelling = json.at("self_propelling");
  b.fastest_growth = NumberFrom(json.at("fastest_growth_per_s"));
  b.harder_moves_farther = json.at("harder_moves_farther");
  for (const Json& from : json.at("demonstrations")) {
    SettlingSimulation d;
    d.setting = from.at("setting");
    d.people = from.at("people");
    d.mass = from.at("mass_kg");
    d.impulse = from.at("impulse_Ns");
    d.speed = NumberFrom(from.at("speed_m_s"));
    d.lean = NumberFrom(from.at("lean_rad"));
    d.distance = NumberFrom(from.at("distance_m"));
    // Models written before these were kept.
    d.advance = NumberFrom(from.value("advance_m", Json(0.0)));
    d.pushed_advance = NumberFrom(from.value("pushed_advance_m", Json(0.0)));
    d.fell = from.at("fell");
    d.settled = from.at("settled");
    b.simulations.push_back(d);
  }
  return b;
}

Uncertainty UncertaintyFrom(const Json& json) {
  Uncertainty u;
  u.clustered = json.at("clustered_by") != "none";
  if (u.clustered) u.clustered_by = EnumFrom<ClusterBy>(json, "clustered_by");
  u.two_way = json.value("two_way", false);
  u.num_clusters = json.at("clusters");
  u.num_residuals = json.at("residuals");
  u.full_hessian = json.value("full_hessian", false);
  u.sigma = NumberFrom(json.at("sigma"));
  u.freedom = json.at("freedom");
  u.too_few_clusters = json.at("too_few_clusters");
  u.condition_number = NumberFrom(json.at("condition_number"));
  u.covariance = MatrixFrom(json.at("covariance_fitted_scale"));
  u.correlation = MatrixFrom(json.at("correlation"));
  u.null_directions = NullDirectionsFrom(json.at("null_directions"));
  if (json.contains("held_directions"))
    u.held_directions = json.at("held_directions").get<std::vector<std::string>>();
  if (json.contains("settling")) {
    const Json& s = json.at("settling");
    u.settling = {s.at("binds"), s.at("contradicted"), s.value("unmet", false),
                  NumberFrom(s.at("rise")), NumberFrom(s.at("free_seconds"))};
  }
  return u;
}

std::vector<SolveStart> StartsFrom(const Json& json) {
  std::vector<SolveStart> starts;
  for (const Json& s : json) {
    SolveStart start;
    start.kind = s.at("kind");
    start.usable = s.at("usable");
    start.converged = s.at("converged");
    start.cost = NumberFrom(s.at("cost"));
    start.iterations = s.at("iterations");
    start.failed.resize(s.at("failed_rollouts"));
    // One flat row: the result knows no longer which block each number came from.
    start.from.shared = NumbersFrom(s.at("from_fitted_scale"));
    start.to.shared = NumbersFrom(s.at("to_fitted_scale"));
    for (const Json& stage : s.at("stages")) {
      start.stages.push_back({stage.at("horizon"),
                              stage.at("iterations"),
                              NumberFrom(stage.at("initial_cost")),
                              NumberFrom(stage.at("final_cost")),
                              stage.at("converged"),
                              {}});
    }
    start.message = s.at("message");
    starts.push_back(start);
  }
  return starts;
}

// What the types alone do not ensure and readers of a result rely on.
void CheckConsistent(const FitResult& result) {
  if (result.best_start < 0 || result.best_start >= static_cast<int>(result.starts.size())) {
    throw std::runtime_error("best_start is not one of the starts");
  }
  const Uncertainty& u = result.uncertainty;
  const auto fits = [&u](const Eigen::MatrixXd& matrix) {
    const int size = static_cast<int>(u.estimates.size());
    return matrix.rows() == size && matrix.cols() == size;
  };
  if (!fits(u.covariance) || !fits(u.correlation)) {
    throw std::runtime_error("sizes of covariance, correlation and parameters do not match");
  }
  if (!(result.parameters[kTailTime] > 0.0)) {
    throw std::runtime_error("tail_time must be positive");
  }
  const auto check = [&result](const std::string& unit, const auto& pooled) {
    for (const auto& [name, estimate] : pooled) {
      if (result.options.table.Find(name) == nullptr) {
        throw std::runtime_error(unit + " has an unknown parameter '" + name + "'");
      }
    }
  };
  for (const auto& [id, subject] : result.subjects) check("subject " + id, subject.pooled);
  for (const auto& [setting, pooled] : result.settings) check("setting " + setting, pooled);
}

// "[json.exception.type_error.302] type must be number, but is string": the end is for people.
std::string Reason(const std::exception& exception) {
  const std::string text = exception.what();
  const size_t end = text.rfind("[json.exception", 0) == 0 ? text.find("] ") : std::string::npos;
  return end == std::string::npos ? text : text.substr(end + 2);
}

// Reads a model part by part, and knows which one it is at.
class ModelReader {
 public:
  explicit ModelReader(const Json& json) : json_(json) {}

  // Errors: a law that is not here. Everything else that is wrong is thrown, and part() says where.
  MaybeError Read(const ForceLaws& laws) {
    if (MaybeError error = ReadOptions(laws)) return error;
    ReadLearned();
    ReadEstimates();
    ReadPooled();
    ReadStepProbability();
    ReadLikelihood();
    ReadRecordingEffect();
    ReadPushRange();
    ReadValues();
    ReadJudgement();
    ReadSolve();
    ReadProvenance();
    CheckConsistent(result_);
    return std::nullopt;
  }

  const std::string& part() const { return part_; }
  FittedModel& model() { return model_; }

 private:
  const Json& At(const char* key) {
    part_ = key;
    return json_.at(key);
  }

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
      throw std::runtime_error("self_force is " + learned + ", which self_network is not");
    }
    const std::string interaction = At("model").at("interaction");
    const auto named = ParseInteraction("interaction", interaction);
    const PairShape pair = options.learned != nullptr ? options.learned->pair : PairShape{};
    if (!named.ok() || named.value().pair.hidden != pair.hidden) {
      throw std::runtime_error("interaction is " + interaction + ", which self_network is not");
    }
    if (json_.contains("network_takeover")) {
      result_.takeover = TakeoverFromJson(At("network_takeover"));
    }
    if (json_.contains("contact_takeover")) {
      result_.contact_takeover = ContactTakeoverFromJson(At("contact_takeover"));
    }
    if (json_.contains("interaction_network")) {
      options.interaction_network = InteractionNetworkFromJson(At("interaction_network"));
    }
  }

  void ReadEstimates() {
    for (const Json& e : At("parameters")) result_.estimates.push_back(EstimateFrom(e));
    for (const Json& e : At("nuisance")) result_.nuisance.push_back(EstimateFrom(e));
    for (const Json& c : At("derived")) result_.derived.push_back(CombinationFrom(c));
    Uncertainty& u = result_.uncertainty;
    u = UncertaintyFrom(At("uncertainty"));
    for (const Estimate& e : result_.estimates) {
      if (e.status != EstimateStatus::kFixed) u.estimates.push_back(e);
    }
    u.estimates.insert(u.estimates.end(), result_.nuisance.begin(), result_.nuisance.end());
  }

  void ReadPooled() {
    for (const auto& [setting, pooled] : At("settings").items()) {
      for (const auto& [name, estimate] : pooled.items()) {
        result_.settings[setting][name] = EstimateFrom(estimate);
      }
    }
    for (const auto& [id, subject] : At("subjects").items()) {
      result_.subjects[id].mass_kg = subject.at("mass_kg");
      for (const auto& [name, estimate] : subject.at("pooled").items()) {
        result_.subjects[id].pooled[name] = EstimateFrom(estimate);
      }
    }
  }

  void ReadStepProbability() {
    if (!json_.contains("step_probability")) return;
    result_.step_probability = StepProbabilityFromJson(At("step_probability"));
  }

  void ReadLikelihood() {
    if (!json_.contains("likelihood")) return;
    const Json& json = At("likelihood");
    result_.likelihood =
        LikelihoodScore{NumberFrom(json.at("deviance")), json.at("measured").get<int>(),
                        json.at("parameters").get<int>()};
  }

  void ReadRecordingEffect() {
    if (!json_.contains("recording_effect")) return;
    result_.recording_effect = RecordingEffectFromJson(At("recording_effect"));
  }

  void ReadPushRange() {
    if (!json_.contains("push_range")) return;
    const Json& json = At("push_range");
    PushRange& range = result_.push_range.emplace();
    for (const PushRangeRow& row : kPushRangeRows) {
      if (!json.contains(row.key)) continue;
      range.*row.range = {json.at(row.key).at(0), json.at(row.key).at(1)};
    }
  }

  void ReadValues() {
    const ParameterTable& table = result_.options.table;
    for (const ParameterSpec& spec : table.specs) {
      const Json& values = At("values");
      part_ = "values/" + spec.name;
      result_.parameters[spec.id] = ValueFrom(values, json_.at("table"), spec);
    }
    if (!json_.contains("ensemble")) return;
    const auto& network = result_.options.model.learned;
    for (const Json& one : At("ensemble")) {
      result_.others.push_back(MemberFrom(one, json_.at("table"), table));
      if (network == nullptr ||
          LearnedName(*result_.others.back().network) != LearnedName(*network)) {
        throw std::runtime_error("a member's network is not that of self_network");
      }
    }
  }

  // Not all of it is in every model: asked for, or written before there was any.
  void ReadJudgement() {
    result_.behaviour = BehaviourFrom(At("behaviour"));
    if (json_.contains("profiles")) model_.profiles = ProfilesFromJson(At("profiles"));
    if (json_.contains("bootstrap")) model_.bootstrap = BootstrapFromJson(At("bootstrap"));
    if (json_.contains("push_check")) model_.push_check = RefitTableFromJson(At("push_check"));
    if (json_.contains("prior_check")) {
      model_.prior_check = RefitTableFromJson(At("prior_check"));
    }
    if (json_.contains("horizon_check")) {
      model_.horizon_check = RefitTableFromJson(At("horizon_check"));
    }
    if (json_.contains("diagnostics")) {
      result_.diagnostics = DiagnosticsFromJson(At("diagnostics"));
      model_.advice = AdviceFrom(At("diagnostics").at("advice"));
    }
    result_.warnings = At("warnings").get<std::vector<std::string>>();
  }

  void ReadSolve() {
    const Json& fit = At("fit");
    result_.converged = fit.at("converged");
    result_.cost = NumberFrom(fit.at("cost"));
    result_.message = fit.at("message");
    result_.best_start = fit.at("best_start");
    result_.starts = StartsFrom(fit.at("starts"));
    for (const Json& r : At("data").at("recordings")) {
      result_.recordings.push_back({r.at("id"), r.at("content_hash"), r.at("frames"),
                                    r.value("people", 1), NumberFrom(r.at("cost")),
                                    r.at("failure")});
    }
    result_.solve_seconds = At("run").at("solve_seconds");
  }

  void ReadProvenance() {
    Provenance& from = model_.provenance;
    from.version = At("version");
    from.manifest_hash = At("data").at("manifest_hash");
    from.setting = At("data").at("setting");
    from.configuration = At("configuration").get<std::map<std::string, std::string>>();
    if (json_.contains("changed_flags")) {
      from.changed_flags = At("changed_flags").get<std::vector<std::string>>();
    }
    from.manifest = At("run").at("manifest");
  }

  const Json& json_;
  std::string part_;
  FittedModel model_;
  FitResult& result_ = model_.fit;
};

}  // namespace

Result<FittedModel> FittedModelFromJson(const nlohmann::ordered_json& json, const std::string& file,
                                        const ForceLaws& laws) {
  if (!json.is_object() || !json.contains("format") || json["format"] != "pushid model" ||
      !json.contains("format_version") || !json["format_version"].is_number()) {
    return Error{"this is not a pushid model (pushid-fit --model_out writes one)", file};
  }
  if (json["format_version"] > kModelFormat) {
    return Error{"written by a newer pushid; update pushid to read it", file};
  }
  ModelReader reader(json);
  try {
    if (MaybeError error = reader.Read(laws)) {
      error->file = file;
      return *error;
    }
    return std::move(reader.model());
  } catch (const std::exception& exception) {
    return Error{"incomplete or damaged model, at '" + reader.part() + "': " + Reason(exception) +
                     "; use another copy or fit again",
                 file};
  }
}

Result<FittedModel> ReadFittedModel(const std::string& path, const ForceLaws& laws) {
  Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  return FittedModelFromJson(document.value().content, path, laws);
}

}  // namespace pushid
