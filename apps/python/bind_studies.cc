// apps: what more is asked of a fit in Python: profiles, bootstrap, which recording
// to make next; formations and most probable paths.
#include <nlohmann/json.hpp>

#include "apps/python/bindings.h"
#include "ident/checks/model_checks.h"
#include "ident/forecasts/most_probable_path.h"
#include "ident/formations/formation_run.h"
#include "ident/formations/wave_speed.h"
#include "ident/parameters/json_archive.h"
#include "ident/report/advice.h"
#include "ident/report/report_text.h"
#include "ident/validation/experiment_design.h"
#include "models/formation.h"

namespace pushid {
namespace {

// Adds something to a copy of the model, without the GIL, and puts the copy in its place.
template <typename Add>
void Extend(Model* model, Add add) {
  const std::shared_ptr<const FittedTo> to = DataOf(*model);
  FittedModel extended = *model->fitted;
  const MaybeError error = WithoutGil([&] {
    MaybeError failed = add(to->pendulums, &extended);
    if (!failed) extended.advice = Advise(extended);
    return failed;
  });
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
                 const py::object& progress) {
  const BootstrapOptions options{replicas, seed, num_threads};
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    return AddBootstrap(recordings, options, told, fitted);
  });
}

void CheckHorizonsOf(Model* model, int num_threads, const py::object& progress) {
  const JobProgress told = JobsOf(progress);
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    AddHorizonCheck(recordings, num_threads, told, fitted);
    return MaybeError();
  });
}

void LearnForecastsOf(Model* model, int num_threads) {
  Extend(model, [&](const PendulumRecordings& recordings, FittedModel* fitted) {
    return AddForecasts(recordings, num_threads, fitted);
  });
}

using Json = nlohmann::ordered_json;

// A number for each name; none where there are none.
Json ByName(const std::vector<std::string>& names, const std::vector<double>& numbers) {
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
                    {"sensor", row.push.sensor},
                    {"error_ratio", ByName(design.parameters, row.error_ratio)},
                    {"mean_error_ratio", NumberJson(row.volume_ratio)}});
  }
  return rows;
}

py::object DesignOf(const Model& model, const std::string& parameter) {
  const std::shared_ptr<const FittedTo> to = DataOf(model);
  const std::shared_ptr<const FittedModel> fitted = model.fitted;
  const ExperimentDesign design =
      WithoutGil([&] { return DesignExperiments(to->pendulums, fitted->fit); });
  const Json json = {{"text", Unwrapped(DesignText(design, parameter), Fault::kUsage)},
                     {"standard_error", ByName(design.parameters, design.standard_error)},
                     {"pushes", PushesJson(design, parameter)},
                     {"no_push", design.refused}};
  return FromJson(json);
}

}  // namespace

void BindStudies(py::module_* module) {
  module->def("profile", &ProfilesOf);
  module->def("bootstrap", &BootstrapOf);
  module->def("horizon_check", &CheckHorizonsOf);
  module->def("learn_forecasts", &LearnForecastsOf);
  module->def("design", &DesignOf);
}

namespace {

struct FormationAsked {
  std::string shape;
  int people, pushed;
  double spacing, push, push_duration, push_direction, mass, rod, duration, fps;
};

Scene SceneOf(const FormationAsked& asked) {
  const auto shape = Named<FormationShape>("shape", asked.shape);
  if (asked.people < 1 || asked.people > 1000 || asked.pushed < 0 || asked.pushed >= asked.people ||
      !(asked.spacing > 0.0) || !(asked.mass > 0.0) || !(asked.rod > 0.0) ||
      !(asked.duration > 0.0) || !(asked.push_duration > 0.0) || !(asked.fps >= 1.0)) {
    Raise(Fault::kUsage, Error{"a formation has 1 to 1000 people, one of whom is pushed, and "
                               "spacing, mass, rod, durations and fps above 0"});
  }
  Scene scene = FormationScene(FormationPositions(shape, asked.people, asked.spacing),
                               {asked.mass, asked.rod}, 1.0 / asked.fps);
  AddHipPush(asked.pushed,
             {asked.push, 0.0, asked.push_duration, asked.push_direction * M_PI / 180.0}, &scene);
  return scene;
}

// What the picture of a wave shows, and the table beside it.
void AddSummaries(const FormationRun& run, const WaveBands& waves, py::dict* dict) {
  Array speed({run.num_frames(), run.num_people()});
  auto cells = speed.mutable_unchecked<2>();
  py::list onset, displacement, outcome, onset_band;
  for (int n = 0; n < run.num_people(); ++n) {
    const PersonSummary& person = run.summaries[n];
    for (int t = 0; t < run.num_frames(); ++t) cells(t, n) = SignedHipSpeed(run, n, t);
    std::optional<double> onset_s;
    if (person.onset_frame >= 0) onset_s = run.Seconds(person.onset_frame);
    onset.append(onset_s);
    displacement.append(person.displacement);
    outcome.append(NameOf(person.outcome));
    if (waves.onsets.empty()) continue;
    const OnsetBand& band = waves.onsets[n];
    onset_band.append(band.moved > 0.0 ? py::object(py::make_tuple(band.from, band.to))
                                       : py::object(py::none()));
  }
  speed.attr("flags").attr("writeable") = false;
  (*dict)["speed"] = speed;
  (*dict)["onset_s"] = onset;
  (*dict)["displacement"] = displacement;
  (*dict)["outcome"] = outcome;
  const std::optional<WaveSpeed> wave = SpeedOfWave(run);
  (*dict)["wave_speed"] = wave ? py::object(py::float_(wave->MetresPerSecond())) : py::none();
  if (!waves.onsets.empty()) (*dict)["onset_band90"] = onset_band;
  if (waves.speed.known()) {
    (*dict)["wave_speed_band90"] = py::make_tuple(waves.speed.from, waves.speed.to);
  }
  (*dict)["fps"] = 1.0 / run.recording.scene.dt;
}

py::dict OnFormation(const Model& model, const std::string& shape, int people, double spacing,
                     int pushed, double push, double push_duration, double push_direction,
                     double mass, double rod, double duration, double fps, const std::string& set,
                     bool bands) {
  const Scene scene = SceneOf({shape, people, pushed, spacing, push, push_duration, push_direction,
                               mass, rod, duration, fps});
  const IdentifiedModel identified = With(model, set);
  const std::shared_ptr<const FittedModel> fitted = model.fitted;
  FormationRun run;
  WaveBands waves;
  {
    const py::gil_scoped_release no_gil;
    run = RunFormation(identified, scene, static_cast<int>(duration * fps) + 1);
    if (bands && run.prediction.status.ok) waves = BandsOfWave(*fitted, set, run);
  }
  WarnOfInputs(identified, run.recording);
  py::dict dict = DictOf(run.prediction, run.recording);
  AddSummaries(run, waves, &dict);
  return dict;
}

py::dict Between(const Model& model, const std::string& start, const std::string& end, int frames,
                 double fps, double mass, double rod) {
  const PathEnd from = Unwrapped(ParsePathEnd("start", start, true), Fault::kUsage);
  const PathEnd to = Unwrapped(ParsePathEnd("end", end, false), Fault::kUsage);
  if (!(mass > 0.0) || !(rod > 0.0) || !(fps > 0.0)) {
    Raise(Fault::kUsage, Error{"mass, rod and fps must be above 0"});
  }
  const IdentifiedModel identified = IdentifiedOf(model);
  auto found = WithoutGil([&] {
    return PathBetween(identified, {mass, rod, 0.0}, fps, from, to, frames);
  });
  const ProbablePath path = Unwrapped(std::move(found), Fault::kUsage);
  py::dict dict;
  dict["states"] = StatesOf(path.states, 1);
  dict["noise"] =
      TableArray(path.states.num_frames(), 1, 4, [&](int t, int n) { return path.noise.At(t, n); });
  dict["action"] = path.action();
  dict["noise_action"] = path.noise_action;
  dict["divergence_action"] = path.divergence_action;
  return dict;
}

}  // namespace

void BindFormations(py::module_* module) {
  module->def("simulate_formation", &OnFormation);
  module->def("path_between", &Between);
}

}  // namespace pushid
