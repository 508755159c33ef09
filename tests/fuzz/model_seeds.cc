// A model as a fit of two subjects might have found it, filled in by hand: numbers that are none
// where a model may have them.
#include "tests/fuzz/model_seeds.h"

#include <limits>
#include <optional>

#include "datasets/files/json_file.h"
#include "ident/model/model_json.h"
#include "ident/parameters/fit_options.h"
#include "ident/parameters/presets.h"

namespace pushid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

FittedModel OfPreset(const std::string& name) {
  const FitOptions preset = MakePreset(name).value();
  FittedModel model;
  FitResult& result = model.fit;
  result.options = preset;
  result.parameters = preset.table.Values();
  for (const ParameterSpec& spec : preset.table.specs) {
    const EstimateStatus status = spec.free ? EstimateStatus::kIdentified : EstimateStatus::kFixed;
    result.estimates.push_back({spec.name,
                                spec.unit,
                                result.parameters[spec.id],
                                0.1,
                                0.02,
                                spec.lower,
                                spec.upper,
                                3.0,
                                3.18,
                                Interval{0.1, spec.lower, spec.upper},
                                Interval{0.2, spec.lower, spec.upper},
                                {},
                                status});
    if (spec.free) result.uncertainty.estimates.push_back(result.estimates.back());
  }
  const int free = static_cast<int>(result.uncertainty.estimates.size());
  result.uncertainty.covariance = Eigen::MatrixXd::Identity(free, free);
  result.uncertainty.correlation = Eigen::MatrixXd::Identity(free, free);
  result.derived = {{"c_x", "N s/m", 23.1, 0.7, 21.7, 24.5}};
  result.behaviour.simulations = {{"", 1, 80.0, 25.0, 0.01, 0.002, 0.4, 0.4, 0.4, false, true}};
  result.recordings = {{"one", "00ff", 45, 1, 1.5, ""}, {"two", "0f0f", 40, 5, kInfinity, "fell"}};
  SolveStart start;
  start.kind = "nominal";
  start.from.shared = start.to.shared = std::vector<double>(free, 0.5);
  start.stages = {{8, 12, 9.0, 1.5, true, {}, {}}};
  result.starts = {start};
  result.best_start = 0;
  result.warnings = {Warning("a warning")};
  result.step_probability = StepProbability{{0.5, 30.0}, Eigen::Matrix2d::Identity(), 20, 12, 5};
  result.forecasts = ForecastRule{};
  model.provenance.version = "0.1.0";
  model.provenance.configuration = {{"seed", "1"}, {"preset", name}};
  model.provenance.changed_flags = {"preset"};
  return model;
}

void AddConfidence(FittedModel* model) {
  FitResult* const result = &model->fit;
  result->subjects["anna"].mass_kg = 62.0;
  result->subjects["anna"].pooled["mu"] = result->estimates.front();
  result->settings["single"]["mu"] = result->estimates.front();
  result->nuisance = {};
  result->likelihood = LikelihoodScore{-7.5, 40, 6};
  model->profiles = {{"mu",
                      "N s/m",
                      20.0,
                      ProfileClass::kPracticallyNot,
                      std::nullopt,
                      -kInfinity,
                      30.0,
                      1.0,
                      0.3,
                      "bound",
                      "threshold",
                      {{10.0, 1.3, {{"a_x", -0.1}}}}}};
  model->bootstrap = Bootstrap{2, 7, 1, {"mu"}, {"N s/m"}, {{0.1}, {0.7}}, {0.3}, {0.1}, {0.7}};
  result->verdict.not_checked.clear();
  result->verdict.assumptions = {{"masses", "", 0.03, 0.1, 0.05, 1.7, 0.1, {0.3}}};
  result->verdict.parts = {{"mu", "the first 8 frames", 2.0, 0.05}};
  result->verdict.motion.tests = {{"travel of the feet", "m", 0.01, 0.02, 0.5, 0.6}};
  Diagnostics& d = result->diagnostics;
  d.start = {kInfinity, {}, {"t_v"}, {"moved"}, {{FindingKind::kMass, "one", "S0", 62000.0}}};
  d.start.null_directions = {{{"mu", "Kp_x"}, {1.0, -1.0}, result->derived, "cannot be told"}};
  result->uncertainty.null_directions = d.start.null_directions;
  d.recordings = {{"one", 97.0, true, 0.2, 0.9, 31.0, 1e-7, {{3, 0, 2.3, 0.1}}}};
  d.whiteness = {{"hip x", {0.9, 0.8}, {0.1, 0.1}, {0.2}, {0.3}, 0.2, 0.04, 99.0, 0.0}};
  d.leverage = {{"one"}, {"mu"}, {"N s/m"}, {{-0.7}}, {{0.1}}};
  d.trace = {{8, 0, 5.3, 1.7}, {0, 1, 1.1, 1e-9}};
  model->advice = {{"free less", "pushid-fit --fix=mu"}};
}

void AddNetworks(FitResult* result) {
  result->options.model.learned = InitialNetwork({NetworkKind::kMlp, 2}, 1, {RodKind::kLdp, {2}});
}

}  // namespace

MaybeError WriteModelSeeds(const std::string& folder) {
  FittedModel judged = OfPreset("tail"), learned = OfPreset("ldp"), group = OfPreset("group");
  AddConfidence(&judged);
  AddNetworks(&learned.fit);
  for (const auto& [name, result] :
       {std::pair{"tail", judged}, std::pair{"learned", learned}, std::pair{"group", group}}) {
    const std::string path = folder + "/" + name + ".json";
    if (const MaybeError failed = WriteJson(path, ToJson(result, RunInfo{}))) return failed;
    const Result<FittedModel> readable = ReadFittedModel(path);
    if (!readable.ok()) return readable.error();
  }
  return std::nullopt;
}

}  // namespace pushid
