// apps: fits in Python: options by the names of the flags, results with everything the programs
// say.
#include <ctime>

#include "apps/python/bindings.h"
#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "ident/parameters/option_names.h"
#include "ident/parameters/option_table.h"
#include "ident/report/advice.h"
#include "ident/report/page/build_report.h"
#include "ident/report/page/page.h"
#include "ident/validation/crossvalidation.h"
#include "ident/validation/predictors.h"
#include "ident/validation/scores_json.h"

namespace pushid {
namespace {

// A fitted model with what it was fitted to; without recordings where it was loaded.
struct Model {
  FittedModel fitted;
  std::vector<SharedRecording> recordings;
  std::vector<PendulumRecording> pendulums;
  std::string source;
};

std::string JsonText(const Model& model) { return ToJson(model.fitted, RunInfo()).dump(); }

void CheckFitted(const Model& model) {
  if (!model.pendulums.empty()) return;
  Raise(Fault::kUsage, Error{"this result was loaded, and its recordings are not with it; fit them "
                             "again, or give them as recordings=..."});
}

// Gives recordings to a model that was loaded.
void Attach(Model* model, const std::vector<SharedRecording>& recordings) {
  const std::vector<FittedRecording>& fitted = model->fitted.fit.recordings;
  bool same = fitted.size() == recordings.size();
  for (size_t i = 0; same && i < fitted.size(); ++i) same = fitted[i].id == recordings[i]->id;
  if (!same) {
    Raise(Fault::kUsage, Error{"these are not the " + std::to_string(fitted.size()) +
                               " recordings that were fitted, in their order"});
  }
  model->recordings = recordings;
  model->pendulums = Pendulums(recordings, model->fitted.fit.options.mapping);
}

FitOptions Options(const GivenOptions& given, const std::vector<PendulumRecording>& pendulums) {
  return Unwrapped(MakeFitOptions(given, &pendulums, given), Fault::kUsage);
}

Provenance From(const GivenOptions& given, const FitOptions& options) {
  Provenance from;
  from.version = PUSHID_VERSION;
  for (const FitOptionRow& row : FitOptionRows()) {
    if (row.text) from.configuration[row.name] = row.text(options);
  }
  for (const auto& [name, value] : given) {
    from.configuration[name] = value;
    from.changed_flags.push_back(name);
  }
  return from;
}

void CheckRecordings(const std::vector<SharedRecording>& recordings) {
  if (recordings.empty()) Raise(Fault::kUsage, Error{"there are no recordings"});
  for (const SharedRecording& one : recordings) {
    if (!one->pushes.empty()) continue;
    Raise(Fault::kData, Error{"recording " + one->id +
                              " has no push: give one, or estimate it by "
                              "pushid.estimate_push"});
  }
}

std::shared_ptr<Model> FitModel(const std::vector<SharedRecording>& recordings,
                                const GivenOptions& given, const py::object& progress) {
  CheckRecordings(recordings);
  const FitOptions roughly = Unwrapped(MakeFitOptions(given), Fault::kUsage);
  auto model = std::make_shared<Model>();
  model->recordings = recordings;
  model->pendulums = Pendulums(recordings, roughly.mapping);
  FitOptions options = Options(given, model->pendulums);
  std::vector<std::string> warnings = OptionWarnings(given, options);
  Check(PrepareFit(model->pendulums, &options, &warnings), Fault::kUsage);
  {
    const SolveProgress told = ProgressOf(progress);
    const py::gil_scoped_release no_gil;
    model->fitted.fit = Fit(model->pendulums, options, told);
  }
  FitResult& fit = model->fitted.fit;
  if (!fit.ok()) Raise(Fault::kFit, Error{"the fit failed: " + fit.message});
  fit.warnings.insert(fit.warnings.begin(), warnings.begin(), warnings.end());
  model->fitted.provenance = From(given, options);
  model->fitted.advice = Advise(model->fitted);
  return model;
}

std::shared_ptr<Model> Load(const std::string& path) {
  auto model = std::make_shared<Model>();
  model->fitted = Unwrapped(ReadFittedModel(path), Fault::kData);
  model->source = path;
  return model;
}

std::shared_ptr<Model> FromText(const std::string& text) {
  auto model = std::make_shared<Model>();
  model->fitted =
      Unwrapped(FittedModelFromJson(nlohmann::ordered_json::parse(text), "pickle"), Fault::kData);
  return model;
}

void Save(const Model& model, const std::string& path) {
  char date[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  RunInfo run;
  run.date = date;
  run.model_path = path;
  run.num_threads = model.fitted.fit.options.num_threads;
  run.total_seconds = model.fitted.fit.solve_seconds;
  Check(WriteJson(path, ToJson(model.fitted, run)), Fault::kData);
}

void WriteReport(const Model& model, const std::string& path) {
  std::string page;
  {
    const py::gil_scoped_release no_gil;
    BuildReportOptions options;
    page = ToPage(BuildReport(model.fitted, Copies(model.recordings), options));
  }
  Check(WriteFileAtomically(path, page), Fault::kData);
}

void AddProfilesOf(Model* model, const std::vector<std::string>& names) {
  CheckFitted(*model);
  MaybeError error;
  {
    const py::gil_scoped_release no_gil;
    error = AddProfiles(model->pendulums, names, 1, nullptr, &model->fitted);
  }
  Check(error, Fault::kUsage);
}

void AddReplicas(Model* model, int replicas, uint64_t seed, int num_threads) {
  CheckFitted(*model);
  BootstrapOptions options;
  options.replicas = replicas;
  options.seed = seed;
  options.num_threads = num_threads;
  MaybeError error;
  {
    const py::gil_scoped_release no_gil;
    error = AddBootstrap(model->pendulums, options, nullptr, &model->fitted);
  }
  Check(error, Fault::kUsage);
}

py::object EvaluateOn(const Model& model, const std::vector<SharedRecording>& recordings,
                      int observed) {
  const IdentifiedModel identified = ModelOf(model.fitted.fit);
  const auto pendulums = Pendulums(recordings, identified.mapping);
  if (observed > 0) Check(CheckObserved(pendulums, observed), Fault::kUsage);
  nlohmann::ordered_json json;
  {
    const py::gil_scoped_release no_gil;
    json = ToJson(Evaluate(identified, pendulums, observed));
  }
  return FromJson(json);
}

py::object CrossValidateAll(const std::vector<SharedRecording>& recordings,
                            const std::vector<std::pair<std::string, GivenOptions>>& candidates,
                            const std::string& scheme, int num_folds, int repeats, uint64_t seed,
                            int observed, bool baselines, int num_threads) {
  CheckRecordings(recordings);
  FoldScheme how = FoldScheme::kStratified;
  Check(ParseName("scheme", scheme, &how), Fault::kUsage);
  std::vector<std::unique_ptr<Predictor>> predictors;
  SkeletonMapping mapping = SkeletonMapping::kExact;
  for (const auto& [name, given] : candidates) {
    const FitOptions roughly = Unwrapped(MakeFitOptions(given), Fault::kUsage);
    mapping = roughly.mapping;
    const auto pendulums = Pendulums(recordings, mapping);
    predictors.push_back(
        std::make_unique<ModelPredictor>(name, Options(given, pendulums), observed));
  }
  if (baselines) {
    predictors.push_back(std::make_unique<BaselinePredictor>("static", StaticBaseline, observed));
    predictors.push_back(std::make_unique<BaselinePredictor>("constant velocity",
                                                             ConstantVelocityBaseline, observed));
  }
  const auto pendulums = Pendulums(recordings, mapping);
  const auto folds = Unwrapped(MakeFolds(pendulums, how, num_folds, repeats, seed), Fault::kUsage);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  {
    const py::gil_scoped_release no_gil;
    for (const auto& predictor : predictors) {
      json.push_back(ToJson(CrossValidate(pendulums, folds, *predictor, num_threads)));
    }
  }
  return FromJson(json);
}

// name, help, default: what the keyword arguments are made from.
py::list OptionList() {
  py::list list;
  const FitOptions defaults;
  for (const FitOptionRow& row : FitOptionRows()) {
    const bool known = row.text && !row.preset_decides;
    list.append(
        py::make_tuple(row.name, row.help,
                       known ? py::object(py::str(row.text(defaults))) : py::object(py::none())));
  }
  return list;
}

}  // namespace

// For the other parts of the module.
IdentifiedModel IdentifiedOf(const py::object& model) {
  return ModelOf(py::cast<std::shared_ptr<Model>>(model)->fitted.fit);
}

void BindFits(py::module_* module) {
  py::class_<Model, std::shared_ptr<Model>>(*module, "Model")
      .def("json", &JsonText)
      .def("text", [](const Model& m) { return ReportText(m.fitted); })
      .def_property_readonly("fitted_here", [](const Model& m) { return !m.pendulums.empty(); })
      .def_property_readonly("converged", [](const Model& m) { return m.fitted.fit.converged; })
      .def_property_readonly("warnings", [](const Model& m) { return m.fitted.fit.warnings; })
      .def_property_readonly("advice",
                             [](const Model& m) {
                               std::vector<std::pair<std::string, std::string>> advice;
                               for (const Advice& a : m.fitted.advice) {
                                 advice.emplace_back(a.sentence, a.command);
                               }
                               return advice;
                             })
      .def("save", &Save)
      .def("report", &WriteReport)
      .def("attach", &Attach)
      .def("profile", &AddProfilesOf)
      .def("bootstrap", &AddReplicas)
      .def("evaluate", &EvaluateOn);
  module->def("fit", &FitModel);
  module->def("load", &Load);
  module->def("from_json", &FromText);
  module->def("crossvalidate", &CrossValidateAll);
  module->def("options", &OptionList);
}

}  // namespace pushid
