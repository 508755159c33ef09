// ident: FitResult to and from JSON.
#include "ident/result_json.h"

#include <cmath>
#include <limits>

#include "datasets/json_file.h"
#include "ident/option_names.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormat = 1;

// JSON knows no infinity.
Json Number(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return "nan";
  return value > 0 ? "infinity" : "-infinity";
}
double ToDouble(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string text = json.get<std::string>();
  if (text == "infinity") return std::numeric_limits<double>::infinity();
  if (text == "-infinity") return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}
double ToDouble(const Json& json, const char* key) { return ToDouble(json.at(key)); }

Json EstimateJson(const Estimate& e) {
  return {{"name", e.name},
          {"value", e.value},
          {"standard_error", Number(e.standard_error)},
          {"standard_error_naive", Number(e.standard_error_naive)},
          {"interval_95", {Number(e.lower95), Number(e.upper95)}},
          {"unit", e.unit},
          {"status", NameOf(e.status)}};
}

template <typename E>
E EnumFrom(const Json& json, const char* key) {
  E value{};
  if (MaybeError error = ParseName(key, json.at(key).get<std::string>(), &value)) {
    throw std::runtime_error(error->ToString());
  }
  return value;
}

Estimate EstimateFrom(const Json& json) {
  Estimate e;
  e.name = json.at("name");
  e.value = json.at("value");
  e.standard_error = ToDouble(json, "standard_error");
  e.standard_error_naive = ToDouble(json, "standard_error_naive");
  e.lower95 = ToDouble(json.at("interval_95").at(0));
  e.upper95 = ToDouble(json.at("interval_95").at(1));
  e.unit = json.at("unit");
  e.status = EnumFrom<EstimateStatus>(json, "status");
  return e;
}

Json CombinationJson(const Combination& c) {
  return {{"name", c.name},
          {"value", c.value},
          {"standard_error", c.standard_error},
          {"interval_95", {c.lower95, c.upper95}},
          {"unit", c.unit}};
}

Combination CombinationFrom(const Json& json) {
  const auto& interval = json.at("interval_95");
  return {json.at("name"),           json.at("unit"), json.at("value"),
          json.at("standard_error"), interval.at(0),  interval.at(1)};
}

Json MatrixJson(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (int i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (int j = 0; j < matrix.cols(); ++j) row.push_back(Number(matrix(i, j)));
    rows.push_back(row);
  }
  return rows;
}

Eigen::MatrixXd MatrixFrom(const Json& json) {
  Eigen::MatrixXd matrix(json.size(), json.empty() ? 0 : json[0].size());
  for (int i = 0; i < matrix.rows(); ++i) {
    for (int j = 0; j < matrix.cols(); ++j) matrix(i, j) = ToDouble(json.at(i).at(j));
  }
  return matrix;
}

Json TableJson(const ParameterTable& table) {
  Json rows = Json::array();
  for (const ParameterSpec& spec : table.specs) {
    Json row = {{"name", spec.name},       {"unit", spec.unit},
                {"nominal", spec.nominal}, {"bounds", {spec.lower, spec.upper}},
                {"scale", spec.scale},     {"transform", NameOf(spec.transform)},
                {"free", spec.free},       {"pooled", spec.pooled},
                {"meaning", spec.meaning}};
    if (spec.prior) row["prior"] = {{"mean", spec.prior->mean}, {"sigma", spec.prior->sigma}};
    rows.push_back(row);
  }
  return rows;
}

ParameterTable TableFrom(const Json& json, const ParameterTable& known) {
  ParameterTable table = known;
  for (const Json& row : json) {
    ParameterSpec* spec = table.Find(row.at("name").get<std::string>());
    if (spec == nullptr) {
      throw std::runtime_error("unknown parameter '" + row.at("name").get<std::string>() + "'");
    }
    spec->unit = row.at("unit");
    spec->nominal = row.at("nominal");
    spec->lower = row.at("bounds").at(0);
    spec->upper = row.at("bounds").at(1);
    spec->scale = row.at("scale");
    spec->transform = EnumFrom<Transform>(row, "transform");
    spec->free = row.at("free");
    spec->pooled = row.at("pooled");
    spec->meaning = row.at("meaning");
    spec->prior.reset();
    if (row.contains("prior")) {
      spec->prior = Prior{row.at("prior").at("mean"), row.at("prior").at("sigma")};
    }
  }
  return table;
}

Json OptionsJson(const FitOptions& o) {
  return {{"preset", o.preset},
          {"self_force", NameOf(o.self_force)},
          {"mapping", NameOf(o.mapping)},
          {"posture", NameOf(o.model.posture)},
          {"gain_scaling", NameOf(o.model.gain_scaling)},
          {"friction", NameOf(o.model.friction)},
          {"push", NameOf(o.model.push)},
          {"push_tail", NameOf(o.model.push_tail)},
          {"cart_derivative", NameOf(o.model.cart_derivative)},
          {"sigmas",
           {{"hip_m", o.sigmas.hip},
            {"velocity_m_s", o.sigmas.velocity},
            {"angle_rad", o.sigmas.angle},
            {"rate_rad_s", o.sigmas.rate},
            {"robust", o.sigmas.robust}}},
          {"recording_weight", NameOf(o.recording_weight)},
          {"settling_weight", o.settling_weight},
          {"stability_weight", o.stability_weight},
          {"pooling_sigma", o.pooling_sigma},
          {"horizons", o.horizons},
          {"start", NameOf(o.start)},
          {"num_starts", o.num_starts},
          {"start_spread", o.start_spread},
          {"seed", o.seed},
          {"max_iterations", o.max_iterations},
          {"function_tolerance", o.function_tolerance},
          {"gradient_tolerance", o.gradient_tolerance},
          {"parameter_tolerance", o.parameter_tolerance}};
}

FitOptions OptionsFrom(const Json& json) {
  FitOptions o;
  o.preset = json.at("preset");
  o.self_force = EnumFrom<SelfForceKind>(json, "self_force");
  o.mapping = EnumFrom<SkeletonMapping>(json, "mapping");
  o.model.posture = EnumFrom<Posture>(json, "posture");
  o.model.gain_scaling = EnumFrom<GainScaling>(json, "gain_scaling");
  o.model.friction = EnumFrom<FrictionKind>(json, "friction");
  o.model.push = EnumFrom<PushUse>(json, "push");
  o.model.push_tail = EnumFrom<PushTail>(json, "push_tail");
  o.model.cart_derivative = EnumFrom<CartDerivative>(json, "cart_derivative");
  const Json& sigmas = json.at("sigmas");
  o.sigmas = {sigmas.at("hip_m"), sigmas.at("velocity_m_s"), sigmas.at("angle_rad"),
              sigmas.at("rate_rad_s"), sigmas.at("robust")};
  o.recording_weight = EnumFrom<RecordingWeight>(json, "recording_weight");
  o.settling_weight = json.at("settling_weight");
  o.stability_weight = json.at("stability_weight");
  o.pooling_sigma = json.at("pooling_sigma");
  o.horizons = json.at("horizons").get<std::vector<int>>();
  o.start = EnumFrom<FitStart>(json, "start");
  o.num_starts = json.at("num_starts");
  o.start_spread = json.at("start_spread");
  o.seed = json.at("seed");
  o.max_iterations = json.at("max_iterations");
  o.function_tolerance = json.at("function_tolerance");
  o.gradient_tolerance = json.at("gradient_tolerance");
  o.parameter_tolerance = json.at("parameter_tolerance");
  return o;
}

Json BehaviourJson(const Behaviour& b) {
  Json demonstrations = Json::array();
  for (const Demonstration& d : b.demonstrations) {
    demonstrations.push_back({{"mass_kg", d.mass},
                              {"impulse_Ns", d.impulse},
                              {"speed_m_s", d.speed},
                              {"lean_rad", d.lean},
                              {"distance_m", d.distance},
                              {"fell", d.fell},
                              {"settled", d.settled}});
  }
  return {{"settles", b.settles},
          {"self_propelling", b.self_propelling},
          {"fastest_growth_per_s", b.fastest_growth},
          {"demonstrations", demonstrations}};
}

Behaviour BehaviourFrom(const Json& json) {
  Behaviour b;
  b.settles = json.at("settles");
  b.self_propelling = json.at("self_propelling");
  b.fastest_growth = json.at("fastest_growth_per_s");
  for (const Json& d : json.at("demonstrations")) {
    b.demonstrations.push_back({d.at("mass_kg"), d.at("impulse_Ns"), d.at("speed_m_s"),
                                d.at("lean_rad"), d.at("distance_m"), d.at("fell"),
                                d.at("settled")});
  }
  return b;
}

Json UncertaintyJson(const Uncertainty& u) {
  Json names = Json::array(), nulls = Json::array();
  for (const Estimate& e : u.estimates) names.push_back(e.name);
  for (const NullDirection& n : u.null_directions) {
    Json identified = Json::array();
    for (const Combination& c : n.identified) identified.push_back(CombinationJson(c));
    nulls.push_back({{"parameters", n.parameters},
                     {"coefficients", n.coefficients},
                     {"identified", identified},
                     {"sentence", n.sentence}});
  }
  return {{"clustered_by", u.clustered ? "recording" : "none"},
          {"clusters", u.num_clusters},
          {"residuals", u.num_residuals},
          {"sigma", u.sigma},
          {"t_quantile", u.t_quantile},
          {"condition_number", Number(u.condition_number)},
          {"fitted", names},
          {"covariance_fitted_scale", MatrixJson(u.covariance)},
          {"correlation", MatrixJson(u.correlation)},
          {"null_directions", nulls}};
}

Uncertainty UncertaintyFrom(const Json& json) {
  Uncertainty u;
  u.clustered = json.at("clustered_by") == "recording";
  u.num_clusters = json.at("clusters");
  u.num_residuals = json.at("residuals");
  u.sigma = json.at("sigma");
  u.t_quantile = json.at("t_quantile");
  u.condition_number = ToDouble(json, "condition_number");
  u.covariance = MatrixFrom(json.at("covariance_fitted_scale"));
  u.correlation = MatrixFrom(json.at("correlation"));
  for (const Json& n : json.at("null_directions")) {
    NullDirection direction;
    direction.parameters = n.at("parameters").get<std::vector<std::string>>();
    direction.coefficients = n.at("coefficients").get<std::vector<double>>();
    for (const Json& c : n.at("identified")) direction.identified.push_back(CombinationFrom(c));
    direction.sentence = n.at("sentence");
    u.null_directions.push_back(direction);
  }
  return u;
}

Json StartsJson(const FitResult& result) {
  Json starts = Json::array();
  for (const SolveStart& s : result.starts) {
    Json stages = Json::array();
    for (const SolveStage& stage : s.stages) {
      stages.push_back({{"horizon", stage.horizon},
                        {"iterations", stage.iterations},
                        {"initial_cost", stage.initial_cost},
                        {"final_cost", stage.final_cost},
                        {"converged", stage.converged}});
    }
    starts.push_back({{"kind", s.kind},
                      {"usable", s.usable},
                      {"converged", s.converged},
                      {"cost", s.cost},
                      {"iterations", s.iterations},
                      {"failed_rollouts", s.failed.size()},
                      {"from_fitted_scale", s.from.Flat()},
                      {"to_fitted_scale", s.to.Flat()},
                      {"stages", stages},
                      {"message", s.message}});
  }
  return starts;
}

std::vector<SolveStart> StartsFrom(const Json& json) {
  std::vector<SolveStart> starts;
  for (const Json& s : json) {
    SolveStart start;
    start.kind = s.at("kind");
    start.usable = s.at("usable");
    start.converged = s.at("converged");
    start.cost = s.at("cost");
    start.iterations = s.at("iterations");
    start.failed.resize(s.at("failed_rollouts"));
    // One flat row: the result knows no longer which block each number came from.
    start.from.shared = s.at("from_fitted_scale").get<std::vector<double>>();
    start.to.shared = s.at("to_fitted_scale").get<std::vector<double>>();
    for (const Json& stage : s.at("stages")) {
      start.stages.push_back({stage.at("horizon"), stage.at("iterations"), stage.at("initial_cost"),
                              stage.at("final_cost"), stage.at("converged")});
    }
    start.message = s.at("message");
    starts.push_back(start);
  }
  return starts;
}

Json EstimatesJson(const std::vector<Estimate>& estimates) {
  Json rows = Json::array();
  for (const Estimate& e : estimates) rows.push_back(EstimateJson(e));
  return rows;
}

}  // namespace

Json ToJson(const FitResult& result, const RunInfo& run) {
  Json derived = Json::array(), recordings = Json::array();
  Json subjects = Json::object(), values = Json::object();
  for (const Combination& c : result.derived) derived.push_back(CombinationJson(c));
  for (const ParameterSpec& spec : result.options.table.specs) {
    values[spec.name] = result.parameters[spec.id];
  }
  for (const auto& [id, subject] : result.subjects) {
    Json pooled = Json::object();
    for (const auto& [name, estimate] : subject.pooled) pooled[name] = EstimateJson(estimate);
    subjects[id] = {{"mass_kg", subject.mass_kg}, {"pooled", pooled}};
  }
  for (const FittedRecording& r : result.recordings) {
    recordings.push_back({{"id", r.id},
                          {"frames", r.frames},
                          {"cost", r.cost},
                          {"failure", r.failure},
                          {"content_hash", r.content_hash}});
  }
  return {{"format", "pushid model"},
          {"format_version", kFormat},
          {"version", result.version},
          {"model", OptionsJson(result.options)},
          {"parameters", EstimatesJson(result.estimates)},
          {"derived", derived},
          {"nuisance", EstimatesJson(result.nuisance)},
          {"subjects", subjects},
          {"values", values},
          {"behaviour", BehaviourJson(result.behaviour)},
          {"uncertainty", UncertaintyJson(result.uncertainty)},
          {"warnings", result.warnings},
          {"fit",
           {{"converged", result.converged},
            {"cost", result.cost},
            {"message", result.message},
            {"best_start", result.best_start},
            {"starts", StartsJson(result)}}},
          {"table", TableJson(result.options.table)},
          {"data",
           {{"manifest_hash", result.manifest_hash},
            {"setting", result.setting},
            {"recordings", recordings}}},
          {"configuration", result.configuration},
          {"run",
           {{"date", run.date},
            {"host", run.host},
            {"manifest", result.manifest},
            {"model_out", run.model_path},
            {"solve_seconds", result.solve_seconds},
            {"total_seconds", run.total_seconds},
            {"num_threads", run.num_threads}}}};
}

Result<FitResult> FitResultFromJson(const Json& json, const std::string& file) {
  if (!json.is_object() || json.value("format", "") != "pushid model") {
    return Error{"this is no pushid model (pushid-fit --model_out writes one)", file};
  }
  if (json.value("format_version", 0) > kFormat) {
    return Error{"written by a newer pushid; update pushid to read it", file};
  }
  try {
    FitResult result;
    const Preset known = MakePreset("tail").value();
    result.options = OptionsFrom(json.at("model"));
    result.options.table = TableFrom(json.at("table"), known.table);
    result.version = json.at("version");
    for (const Json& e : json.at("parameters")) result.estimates.push_back(EstimateFrom(e));
    for (const Json& e : json.at("nuisance")) result.nuisance.push_back(EstimateFrom(e));
    for (const Json& c : json.at("derived")) result.derived.push_back(CombinationFrom(c));
    for (const auto& [id, subject] : json.at("subjects").items()) {
      result.subjects[id].mass_kg = subject.at("mass_kg");
      for (const auto& [name, estimate] : subject.at("pooled").items()) {
        result.subjects[id].pooled[name] = EstimateFrom(estimate);
      }
    }
    for (const ParameterSpec& spec : result.options.table.specs) {
      result.parameters[spec.id] = json.at("values").at(spec.name);
    }
    result.behaviour = BehaviourFrom(json.at("behaviour"));
    result.uncertainty = UncertaintyFrom(json.at("uncertainty"));
    for (const Estimate& e : result.estimates) {
      if (e.status == EstimateStatus::kFixed) continue;
      result.uncertainty.estimates.push_back(e);
    }
    result.uncertainty.estimates.insert(result.uncertainty.estimates.end(), result.nuisance.begin(),
                                        result.nuisance.end());
    result.warnings = json.at("warnings").get<std::vector<std::string>>();
    const Json& fit = json.at("fit");
    result.converged = fit.at("converged");
    result.cost = fit.at("cost");
    result.message = fit.at("message");
    result.best_start = fit.at("best_start");
    result.starts = StartsFrom(fit.at("starts"));
    result.manifest_hash = json.at("data").at("manifest_hash");
    result.setting = json.at("data").at("setting");
    for (const Json& r : json.at("data").at("recordings")) {
      result.recordings.push_back(
          {r.at("id"), r.at("content_hash"), r.at("frames"), r.at("cost"), r.at("failure")});
    }
    result.configuration = json.at("configuration").get<std::map<std::string, std::string>>();
    result.manifest = json.at("run").at("manifest");
    result.solve_seconds = json.at("run").at("solve_seconds");
    return result;
  } catch (const std::exception& exception) {
    return Error{std::string("incomplete or damaged model: ") + exception.what(), file};
  }
}

Result<FitResult> ReadFitResult(const std::string& path) {
  Result<JsonDocument> document = ReadJsonDocument(path);
  if (!document.ok()) return document.error();
  return FitResultFromJson(document.value().content, path);
}

}  // namespace pushid
