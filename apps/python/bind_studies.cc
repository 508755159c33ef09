// apps: what more is asked of a fit in Python: profiles, bootstrap, refits under other priors,
// pushes and horizons, and which recording to make next.
#include <nlohmann/json.hpp>

#include "apps/python/model.h"
#include "ident/fit/confidence.h"
#include "ident/model/json_pieces.h"
#include "ident/push/push_check.h"
#include "ident/report/advice.h"
#include "ident/report/design_text.h"

namespace pushid {
namespace {

// Adds something to a copy of the model, without the GIL, and puts the copy in its place.
template <typename Add>
void Extend(Model* model, Add add) {
  const std::shared_ptr<const FittedTo> to = DataOf(*model);
  FittedModel extended = *model->fitted;
  MaybeError error;
  {
    const py::gil_scoped_release no_gil;
    error = add(to->pendulums, &extended);
    if (!error) extended.advice = Advise(extended);
  }
  Check(error, Fault::kUsage);
  model->fitted = std::make_shared<const FittedModel>(std::move(extended));
}

using PendulumRecordings = std::vector<PendulumRecording>;

void ProfilesOf(Model* model, const std::vector<std::string>& names, int num_threads,
                const py::object& progress) {
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    return AddProfiles(recordings, names, num_threads, told, fitted);
  });
}

void BootstrapOf(Model* model, int replicas, uint64_t seed, int num_threads,
                 const std::string& file, const py::object& progress) {
  BootstrapOptions options;
  options.replicas = replicas;
  options.seed = seed;
  options.num_threads = num_threads;
  options.file = file;
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    return AddBootstrap(recordings, options, told, fitted);
  });
}

void CheckPriorsOf(Model* model) {
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    AddPriorCheck(recordings, fitted);
    return MaybeError();
  });
}

void CheckPushesOf(Model* model, double noise, uint64_t seed, int num_threads,
                   const py::object& progress) {
  PushVariantOptions options;
  options.sensor_noise = noise;
  options.seed = seed;
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    return AddPushCheck(recordings, options, num_threads, told, fitted);
  });
}

void CheckHorizonsOf(Model* model, int num_threads, const py::object& progress) {
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    AddHorizonCheck(recordings, num_threads, told, fitted);
    return MaybeError();
  });
}

using Json = nlohmann::ordered_json;

// A number for each name; none where there are none.
Json Named(const std::vector<std::string>& names, const std::vector<double>& numbers) {
  Json json = Json::object();
  for (size_t i = 0; i < numbers.size(); ++i) json[names[i]] = NumberJson(numbers[i]);
  return json;
}

Json PushesJson(const ExperimentDesign& design, const std::string& parameter) {
  Json rows = Json::array();
  if (!design.refused.empty()) return rows;
  for (const DesignRow& row : Unwrapped(RankedRows(design, parameter), Fault::kUsage)) {
    rows.push_back({{"direction_deg", row.push.direction_deg},
                    {"acceleration", row.push.acceleration},
                    {"height", row.push.height},
                    {"duration_s", row.push.duration_s},
                    {"mass_kg", row.push.mass_kg},
                    {"error_ratio", Named(design.parameters, row.error_ratio)},
                    {"mean_error_ratio", NumberJson(row.volume_ratio)}});
  }
  return rows;
}

Json StudiesJson(const StudyPlan& plan) {
  Json sizes = Json::array();
  for (const StudySize& size : plan.sizes) {
    sizes.push_back({{"people", size.people},
                     {"pushes_of_each", size.pushes},
                     {"standard_error", Named(plan.parameters, size.standard_error)}});
  }
  return {{"sensor_ratio", Named(plan.parameters, plan.sensor_ratio)},
          {"no_sensor", plan.no_sensor},
          {"sizes", sizes},
          {"no_sizes", plan.no_sizes},
          {"between_people", Named(plan.parameters, plan.between_people)},
          {"between_recordings", Named(plan.parameters, plan.between_recordings)},
          {"noise", Named(plan.parameters, plan.noise)}};
}

py::object DesignOf(const Model& model, const std::string& parameter) {
  const std::shared_ptr<const FittedTo> to = DataOf(model);
  const std::shared_ptr<const FittedModel> fitted = model.fitted;
  ExperimentDesign design;
  {
    const py::gil_scoped_release no_gil;
    design = DesignExperiments(to->pendulums, fitted->fit);
  }
  Json json = {{"text", Unwrapped(DesignText(design, parameter), Fault::kUsage)},
               {"standard_error", Named(design.parameters, design.standard_error)},
               {"pushes", PushesJson(design, parameter)},
               {"no_push", design.refused}};
  json.update(StudiesJson(design.studies));
  return FromJson(json);
}

}  // namespace

void BindStudies(py::module_* module) {
  module->def("profile", &ProfilesOf);
  module->def("bootstrap", &BootstrapOf);
  module->def("prior_check", &CheckPriorsOf);
  module->def("push_check", &CheckPushesOf);
  module->def("horizon_check", &CheckHorizonsOf);
  module->def("design", &DesignOf);
}

}  // namespace pushid
