// apps: people who stand together, and most probable paths, in Python.
#include <map>

#include "apps/python/predicted.h"
#include "ident/forecasts/most_probable_path.h"
#include "ident/formations/formation_run.h"
#include "ident/formations/wave_speed.h"
#include "models/formation.h"

namespace pushid {
namespace {

struct FormationAsked {
  std::string shape;
  int people, pushed;
  double spacing, push, push_duration, mass, rod, duration, fps;
};

Scene SceneOf(const FormationAsked& asked) {
  const std::map<std::string, FormationShape> shapes = {{"line", FormationShape::kLine},
                                                        {"diamond", FormationShape::kDiamond},
                                                        {"grid", FormationShape::kGrid}};
  const auto how = shapes.find(asked.shape);
  if (how == shapes.end()) {
    Raise(Fault::kUsage, Error{"shape is '" + asked.shape + "'; it must be line, diamond or grid"});
  }
  if (asked.people < 1 || asked.people > 1000 || asked.pushed < 0 || asked.pushed >= asked.people ||
      !(asked.spacing > 0.0) || !(asked.mass > 0.0) || !(asked.rod > 0.0) ||
      !(asked.duration > 0.0) || !(asked.push_duration > 0.0) || !(asked.fps >= 1.0)) {
    Raise(Fault::kUsage, Error{"a formation has 1 to 1000 people, one of whom is pushed, and "
                               "spacing, mass, rod, durations and fps above 0"});
  }
  Body body;
  body.mass = asked.mass;
  body.rod_length = asked.rod;
  Scene scene = FormationScene(FormationPositions(how->second, asked.people, asked.spacing), body,
                               1.0 / asked.fps);
  AddHipPush(asked.pushed, {asked.push, 0.0, asked.push_duration}, &scene);
  return scene;
}

py::object SecondsOr(bool known, double seconds) {
  return known ? py::object(py::float_(seconds)) : py::object(py::none());
}

// What the picture of a wave shows, and the table beside it.
void AddSummaries(const FormationRun& run, const WaveBands& waves, py::dict* dict) {
  Array speed({run.num_frames(), run.num_people()});
  auto cells = speed.mutable_unchecked<2>();
  py::list onset, displacement, outcome, onset_band;
  for (int n = 0; n < run.num_people(); ++n) {
    const PersonSummary& person = run.summaries[n];
    for (int t = 0; t < run.num_frames(); ++t) cells(t, n) = SignedHipSpeed(run, n, t);
    onset.append(SecondsOr(person.onset_frame >= 0, run.Seconds(person.onset_frame)));
    displacement.append(person.displacement);
    outcome.append(std::string(Name(person.outcome)));
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
                     int pushed, double push, double push_duration, double mass, double rod,
                     double duration, double fps, const std::string& set, bool bands) {
  const Scene scene =
      SceneOf({shape, people, pushed, spacing, push, push_duration, mass, rod, duration, fps});
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

py::dict PathDict(const ProbablePath& path, int people) {
  const int frames = path.states.num_frames();
  py::dict dict;
  dict["states"] = StatesOf(path.states, people);
  dict["noise"] = TableArray(frames, people, 4, [&](int t, int n) { return path.noise.At(t, n); });
  dict["action"] = path.action();
  dict["noise_action"] = path.noise_action;
  dict["divergence_action"] = path.divergence_action;
  dict["measurement_cost"] = path.measurement_cost;
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
  Result<ProbablePath> path = [&] {
    const py::gil_scoped_release no_gil;
    return PathBetween(identified, {mass, rod, 0.0}, fps, from, to, frames);
  }();
  return PathDict(Unwrapped(std::move(path), Fault::kUsage), 1);
}

py::dict Smooth(const Model& model, const SharedRecording& recording) {
  const IdentifiedModel identified = IdentifiedOf(model);
  const PendulumRecording seen = MakePendulumRecording(*recording, identified.mapping);
  Result<ProbablePath> path = [&] {
    const py::gil_scoped_release no_gil;
    return SmoothPath(identified, seen);
  }();
  return PathDict(Unwrapped(std::move(path), Fault::kUsage), seen.num_people());
}

}  // namespace

void BindFormations(py::module_* module) {
  module->def("simulate_formation", &OnFormation);
  module->def("path_between", &Between);
  module->def("smooth", &Smooth);
}

}  // namespace pushid
