// ident: a fitted model to JSON. model_json_reader.cc is the inverse.
#include <nlohmann/json.hpp>

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
#include "ident/parameters/option_names.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

Json UncertaintyJson(const Uncertainty& u) {
  Json names = Json::array();
  for (const Estimate& e : u.estimates) names.push_back(e.name);
  return {{"clustered_by", u.clustered ? NameOf(u.clustered_by) : "none"},
          {"two_way", u.two_way},
          {"clusters", u.num_clusters},
          {"residuals", u.num_residuals},
          {"full_hessian", u.full_hessian},
          {"sigma", NumberJson(u.sigma)},
          {"freedom", u.freedom},
          {"too_few_clusters", u.too_few_clusters},
          {"condition_number", NumberJson(u.condition_number)},
          {"fitted", names},
          {"covariance_fitted_scale", MatrixJson(u.covariance)},
          {"correlation", MatrixJson(u.correlation)},
          {"null_directions", NullDirectionsJson(u.null_directions)},
          {"held_directions", u.held_directions},
          {"settling",
           {{"binds", u.settling.binds},
            {"contradicted", u.settling.contradicted},
            {"unmet", u.settling.unmet},
            {"rise", NumberJson(u.settling.rise)},
            {"free_seconds", NumberJson(u.settling.free_seconds)}}}};
}

// A network's weights stand once, in the network.
std::vector<double> WithoutWeights(FitPoint point) {
  point.weights.clear();
  return point.Flat();
}

Json StartsJson(const FitResult& result) {
  Json starts = Json::array();
  for (const SolveStart& s : result.starts) {
    Json stages = Json::array();
    for (const SolveStage& stage : s.stages) {
      stages.push_back({{"horizon", stage.horizon},
                        {"iterations", stage.iterations},
                        {"initial_cost", NumberJson(stage.initial_cost)},
                        {"final_cost", NumberJson(stage.final_cost)},
                        {"converged", stage.converged}});
    }
    starts.push_back({{"kind", s.kind},
                      {"usable", s.usable},
                      {"converged", s.converged},
                      {"cost", NumberJson(s.cost)},
                      {"iterations", s.iterations},
                      {"failed_rollouts", s.failed.size()},
                      {"from_fitted_scale", NumbersJson(WithoutWeights(s.from))},
                      {"to_fitted_scale", NumbersJson(WithoutWeights(s.to))},
                      {"stages", stages},
                      {"message", s.message}});
  }
  return starts;
}

Json EstimatesJson(const std::vector<Estimate>& estimates) {
  Json rows = Json::array();
  for (const Estimate& e : estimates) rows.push_back(EstimateJson(e));
  return rows;
}

}  // namespace

nlohmann::ordered_json ToJson(const Behaviour& b) {
  Json simulations = Json::array();
  for (const SettlingSimulation& d : b.simulations) {
    simulations.push_back({{"setting", d.setting},
                           {"people", d.people},
                           {"mass_kg", d.mass},
                           {"impulse_Ns", d.impulse},
                           {"speed_m_s", NumberJson(d.speed)},
                           {"lean_rad", NumberJson(d.lean)},
                           {"distance_m", NumberJson(d.distance)},
                           {"advance_m", NumberJson(d.advance)},
                           {"pushed_advance_m", NumberJson(d.pushed_advance)},
                           {"fell", d.fell},
                           {"settled", d.settled}});
  }
  return {{"settles", b.settles},
          {"self_propelling", b.self_propelling},
          {"fastest_growth_per_s", NumberJson(b.fastest_growth)},
          {"harder_moves_farther", b.harder_moves_farther},
          {"demonstrations", simulations}};
}

namespace {

Json ValuesJson(const ParameterTable& table, const ParameterSet<double>& set) {
  Json values = Json::object();
  for (const ParameterSpec& spec : table.specs) values[spec.name] = set[spec.id];
  return values;
}

Json DerivedJson(const FitResult& result) {
  Json derived = Json::array();
  for (const Combination& c : result.derived) derived.push_back(CombinationJson(c));
  return derived;
}

Json PooledJson(const std::map<std::string, Estimate>& estimates) {
  Json pooled = Json::object();
  for (const auto& [name, estimate] : estimates) pooled[name] = EstimateJson(estimate);
  return pooled;
}

Json SubjectsJson(const FitResult& result) {
  Json subjects = Json::object();
  for (const auto& [id, subject] : result.subjects) {
    subjects[id] = {{"mass_kg", subject.mass_kg}, {"pooled", PooledJson(subject.pooled)}};
  }
  return subjects;
}

Json SettingsPooledJson(const FitResult& result) {
  Json settings = Json::object();
  for (const auto& [setting, pooled] : result.settings) settings[setting] = PooledJson(pooled);
  return settings;
}

Json RecordingsJson(const FitResult& result) {
  Json recordings = Json::array();
  for (const FittedRecording& r : result.recordings) {
    recordings.push_back({{"id", r.id},
                          {"frames", r.frames},
                          {"people", r.people},
                          {"cost", NumberJson(r.cost)},
                          {"failure", r.failure},
                          {"content_hash", r.content_hash}});
  }
  return recordings;
}

Json PushRangeJson(const PushRange& range) {
  Json json = Json::object();
  for (const PushRangeRow& row : kPushRangeRows) {
    const ValueRange& values = range.*row.range;
    if (!values.empty()) json[row.key] = {values.lower, values.upper};
  }
  return json;
}

// What only some models have.
void AddLearned(const FitResult& result, Json* json) {
  if (const auto& network = result.options.model.learned) {
    (*json)["self_network"] = ToJson(*network);
    if (result.takeover) (*json)["network_takeover"] = ToJson(*result.takeover);
    if (result.contact_takeover) (*json)["contact_takeover"] = ToJson(*result.contact_takeover);
    for (const EnsembleMember& member : result.others) {
      (*json)["ensemble"].push_back(
          {{"values", ValuesJson(result.options.table, member.parameters)},
           {"self_network", ToJson(*member.network)}});
    }
  }
  AddLawNames(result.options.model, json);
  if (const auto& network = result.options.model.interaction_network) {
    (*json)["interaction_network"] = ToJson(*network);
  }
}

}  // namespace

nlohmann::ordered_json ToJson(const FittedModel& model, const RunInfo& run) {
  const FitResult& result = model.fit;
  const Provenance& from = model.provenance;
  Json diagnostics = ToJson(result.diagnostics);
  diagnostics["advice"] = AdviceJson(model.advice);
  Json json = {{"format", "pushid model"},
               {"format_version", kModelFormat},
               {"version", from.version},
               {"model", OptionsJson(result.options)},
               {"parameters", EstimatesJson(result.estimates)},
               {"derived", DerivedJson(result)},
               {"nuisance", EstimatesJson(result.nuisance)},
               {"subjects", SubjectsJson(result)},
               {"settings", SettingsPooledJson(result)},
               {"values", ValuesJson(result.options.table, result.parameters)},
               {"behaviour", ToJson(result.behaviour)},
               {"uncertainty", UncertaintyJson(result.uncertainty)},
               {"diagnostics", diagnostics},
               {"warnings", result.warnings},
               {"fit",
                {{"converged", result.converged},
                 {"cost", NumberJson(result.cost)},
                 {"message", result.message},
                 {"best_start", result.best_start},
                 {"starts", StartsJson(result)}}},
               {"table", TableJson(result.options.table)},
               {"data",
                {{"manifest_hash", from.manifest_hash},
                 {"setting", from.setting},
                 {"recordings", RecordingsJson(result)}}},
               {"configuration", from.configuration},
               {"changed_flags", from.changed_flags},
               {"run",
                {{"date", run.date},
                 {"host", run.host},
                 {"manifest", from.manifest},
                 {"model_out", run.model_path},
                 {"solve_seconds", result.solve_seconds},
                 {"total_seconds", run.total_seconds},
                 {"num_threads", run.num_threads}}}};
  if (result.push_range) json["push_range"] = PushRangeJson(*result.push_range);
  if (result.step_probability) {
    json["step_probability"] = ToJson(*result.step_probability);
  }
  if (result.likelihood) {
    const LikelihoodScore& score = *result.likelihood;
    json["likelihood"] = {{"deviance", NumberJson(score.deviance)},
                          {"measured", score.measured},
                          {"parameters", score.parameters},
                          {"aic", NumberJson(score.Aic())},
                          {"bic", NumberJson(score.Bic())}};
  }
  if (result.recording_effect) json["recording_effect"] = ToJson(*result.recording_effect);
  AddLearned(result, &json);
  if (!model.profiles.empty()) json["profiles"] = ToJson(model.profiles);
  if (model.bootstrap) json["bootstrap"] = ToJson(*model.bootstrap);
  if (model.push_check) json["push_check"] = ToJson(*model.push_check);
  if (model.prior_check) json["prior_check"] = ToJson(*model.prior_check);
  if (model.horizon_check) json["horizon_check"] = ToJson(*model.horizon_check);
  return json;
}

}  // namespace pushid
