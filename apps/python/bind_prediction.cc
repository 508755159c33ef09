// apps: predictions in Python: from the first frame and the push, frame by frame, of whole bodies,
// of formations, and the linearized loop.
#include <algorithm>
#include <array>

#include "apps/python/bindings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/bodies/restoration_files.h"
#include "ident/formations/formation_run.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/prediction.h"
#include "ident/problem/linear_loop.h"
#include "models/formation.h"
#include "models/rollout.h"

namespace pushid {
namespace {

using namespace py::literals;

// paths[person][frame] as (frames, people, 3).
Array PathsArray(const std::vector<std::vector<Vector3<double>>>& paths) {
  const int people = static_cast<int>(paths.size());
  const int frames = people == 0 ? 0 : static_cast<int>(paths[0].size());
  return TableArray(frames, people, 3, [&](int t, int n) { return paths[n][t]; });
}

// (frames, people, 8): q, then qd.
Array StatesOf(const RolloutPath<double>& path, int people) {
  return TableArray(path.num_frames(), people, 8, [&](int t, int n) {
    Eigen::Matrix<double, 8, 1> state;
    state << path.At(t, n).q, path.At(t, n).qd;
    return state;
  });
}

// A dict with hip, states, observed, and bands if there are any. Raises FitError if the rollout
// left the domain.
py::dict DictOf(const Prediction& prediction, const PendulumRecording& recording) {
  if (!prediction.status.ok) {
    Raise(Fault::kFit, Error{"recording " + recording.id + ": " + OutsideText(prediction.status)});
  }
  py::dict dict("hip"_a = PathsArray(prediction.hip),
                "states"_a = StatesOf(prediction.path, recording.num_people()),
                "observed"_a = prediction.observed);
  if (prediction.bands.empty()) return dict;
  std::vector<HipPath> lower, upper;
  for (const HipBand& band : prediction.bands) {
    lower.push_back(band.lower90);
    upper.push_back(band.upper90);
  }
  dict["lower90"] = PathsArray(lower);
  dict["upper90"] = PathsArray(upper);
  return dict;
}

// The model with some of its values replaced: "Kp_theta=1500,...".
IdentifiedModel With(const Model& model, const std::string& set) {
  IdentifiedModel identified = IdentifiedOf(model);
  Check(SetValues(set, &identified), Fault::kUsage);
  return identified;
}

// Warns of pushes outside the range of the fit.
void WarnOfInputs(const IdentifiedModel& model, const PendulumRecording& recording) {
  for (const Warning& warning : InputWarnings(model, {recording})) Warn(warning.text);
}

// Hips of futures, (samples, frames, people, 3), with parameters drawn from their covariance and
// errors as those of the fitted recordings.
Array Drawn(const Model& model, const PendulumRecording& seen, int frames, int samples,
            uint64_t seed) {
  const FitResult& fit = model.fitted->fit;
  const auto paths = DrawPaths(fit, SampleParameters(fit, BandOptions{samples, seed}),
                               ErrorPaths(fit, DataOf(model)->pendulums), seen, seed, frames);
  const int drawn = static_cast<int>(paths.size()), people = seen.num_people();
  const int each = drawn == 0 ? 0 : static_cast<int>(paths[0][0].size());
  const auto hip = [&](int i, int n) -> Eigen::Vector3d {
    return paths[i / each][n][i % each].head<3>();
  };
  return Reshaped(TableArray(drawn * each, people, 3, hip), {drawn, each, people, 3});
}

PendulumRecording PushedAs(const ChangedPushes& changed, const PendulumRecording& recorded,
                           int observed, int frames) {
  if (changed.Any() && observed > 0) {
    Raise(Fault::kUsage, Error{"observed is for the recorded motion, and push_scale and push_again "
                               "for another push than made it; leave one out"});
  }
  Check(CheckChangedPushes(changed, recorded, frames > 0 ? frames : recorded.num_frames()),
        Fault::kUsage);
  return WithPushes(recorded, changed);
}

py::dict PredictOn(const Model& model, const SharedRecording& recording, int observed, int frames,
                   int samples, uint64_t seed, const std::string& set, double push_scale,
                   const std::vector<int>& push_again, const std::string& forecast) {
  const IdentifiedModel identified = With(model, set);
  const ForecastUse use = Named<ForecastUse>("forecast", forecast);
  const PendulumRecording seen = PushedAs({push_scale, {push_again.begin(), push_again.end()}},
                                          MakePendulumRecording(*recording), observed, frames);
  if (observed < 0 || frames < 0 || samples < 0) {
    Raise(Fault::kUsage, Error{"observed, frames and samples must not be negative"});
  }
  if (observed > 0) Check(CheckObserved({seen}, observed), Fault::kUsage);
  if (frames > 0 && frames <= observed) {
    Raise(Fault::kUsage, Error{"frames=" + std::to_string(frames) +
                               " leaves none to predict "
                               "after observed=" +
                               std::to_string(observed)});
  }
  if (samples > 0 && observed > 0) {
    Raise(Fault::kUsage, Error{"samples draws motions from frame 0 on, and observed has seen more; "
                               "leave one out"});
  }
  if (samples > 0 && !set.empty()) {
    Raise(Fault::kUsage,
          Error{"samples draws the parameters, which set=... fixes; give one of them"});
  }
  WarnOfInputs(identified, seen);
  py::dict dict =
      DictOf(Unwrapped(PredictFrom(identified, seen, observed, frames, use), Fault::kUsage), seen);
  dict["person"] = PersonText(model.fitted->fit, identified, {seen});
  if (samples > 0) dict["samples"] = Drawn(model, seen, frames, samples, seed);
  return dict;
}

// A predictor that observes frames of all people.
class Online {
 public:
  Online(const Model& model, const SharedRecording& recording, int frames,
         const std::string& forecast)
      : model_(std::make_unique<IdentifiedModel>(IdentifiedOf(model))),
        recording_(std::make_unique<PendulumRecording>(MakePendulumRecording(*recording))),
        last_(*recording),
        predictor_(std::make_unique<OnlinePredictor>(
            Unwrapped(OnlinePredictor::Make(*model_, *recording_, frames,
                                            Named<ForecastUse>("forecast", forecast)),
                      Fault::kUsage))) {
    for (RecordedPerson& person : last_.people) {
      for (auto* track : {&person.hip, &person.left_ankle, &person.right_ankle}) track->resize(1);
      person.left_toe.clear(), person.right_toe.clear();
      person.left_heel.clear(), person.right_heel.clear();
      person.weight.clear();
      person.joints.clear();
    }
  }

  // hip, left_ankle, right_ankle: (people, 3), m.
  void Observe(const Array& hip, const Array& left, const Array& right) {
    const size_t people = last_.people.size();
    for (const Array* array : {&hip, &left, &right}) {
      const bool fits = array->ndim() == 2 && array->shape(1) == 3 &&
                        array->shape(0) == static_cast<py::ssize_t>(people);
      if (!fits) {
        Raise(Fault::kData, Error{"hip and ankles of one frame have the shape (" +
                                  std::to_string(people) + ", 3)"});
      }
    }
    for (size_t n = 0; n < people; ++n) {
      RecordedPerson& person = last_.people[n];
      const std::pair<std::vector<Eigen::Vector3d>*, const Array*> tracks[] = {
          {&person.hip, &hip}, {&person.left_ankle, &left}, {&person.right_ankle, &right}};
      for (const auto& [track, array] : tracks) {
        track->emplace_back(array->at(n, 0), array->at(n, 1), array->at(n, 2));
        if (!track->back().allFinite()) {
          Raise(Fault::kData, Error{"the frame has a value that is not finite; skip it"});
        }
        if (track->size() > 2) track->erase(track->begin());
      }
    }
    predictor_->Observe(FrameAt(MakePendulumRecording(last_), 1));
  }

  void Push(int person, const Array& force) {
    const bool known = person >= 0 && person < recording_->num_people();
    if (!known || force.ndim() != 1 || force.shape(0) != 4) {
      Raise(Fault::kData, Error{"a push is [Fx, Fy, Mtheta, Mphi], on one of the people, from 0"});
    }
    predictor_->Push(person, {force.at(0), force.at(1), force.at(2), force.at(3)});
  }
  py::dict Predict() const { return DictOf(predictor_->Predict(), *recording_); }
  Array Next(int ahead) const { return PathsArray(predictor_->Next(std::max(0, ahead))); }
  int observed() const { return predictor_->observed(); }

 private:
  std::unique_ptr<IdentifiedModel> model_;
  std::unique_ptr<PendulumRecording> recording_;
  Recording last_;  // the last two frames, from which states are computed
  std::unique_ptr<OnlinePredictor> predictor_;
};

// (frames, people, 22, 3), m.
Array Restored(const Restoration& restoration, const Model& model, const SharedRecording& recording,
               int observed) {
  const IdentifiedModel identified = IdentifiedOf(model);
  const BodyRecording bodies = Unwrapped(MakeBodyRecording(*recording), Fault::kData);
  const Prediction predicted =
      Unwrapped(PredictFrom(identified, bodies.pendulum, observed), Fault::kUsage);
  if (!predicted.status.ok) {
    Raise(Fault::kFit, Error{"recording " + recording->id + ": " + OutsideText(predicted.status)});
  }
  const auto motions = RestoreBodies(restoration, {}, PredictedPeople(bodies, predicted));
  const int people = static_cast<int>(motions.size());
  const int frames = people == 0 ? 0 : static_cast<int>(motions[0].size());
  // A joint is a column.
  return Reshaped(TableArray(frames, people, 3 * kBodyJoints,
                             [&](int t, int n) { return motions[n][t].data(); }),
                  {frames, people, kBodyJoints, 3});
}

// Adds the values of the picture of a wave and of its table.
void AddSummaries(const FormationRun& run, const WaveBands& waves, py::dict* dict) {
  py::list onset, displacement, outcome, onset_band;
  for (int n = 0; n < run.num_people(); ++n) {
    const PersonSummary& person = run.summaries[n];
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
  (*dict)["speed"] =
      Reshaped(TableArray(run.num_frames(), run.num_people(), 1,
                          [&](int t, int n) { return std::array<double, 1>{HipSpeed(run, n, t)}; }),
               {run.num_frames(), run.num_people()});
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

// push, push_duration, mass and rod: empty: as in the fit.
py::dict OnFormation(const Model& model, const std::string& shape, int people, double spacing,
                     int pushed, std::optional<double> push, std::optional<double> push_duration,
                     double push_direction, std::optional<double> mass, std::optional<double> rod,
                     double duration, double fps, const std::string& set, bool bands) {
  const IdentifiedModel identified = With(model, set);
  const auto formation = Named<FormationShape>("shape", shape);
  if (people < 1 || people > 1000 || pushed < 0 || pushed >= people || !(spacing > 0.0) ||
      !(mass.value_or(1.0) > 0.0) || !(rod.value_or(1.0) > 0.0) || !(duration > 0.0) ||
      !(push_duration.value_or(1.0) > 0.0) || !(fps >= 1.0)) {
    Raise(Fault::kUsage, Error{"a formation has 1 to 1000 people, one of whom is pushed, and "
                               "spacing, mass, rod, durations and fps above 0"});
  }
  Scene scene = FormationScene(FormationPositions(formation, people, spacing),
                               {mass.value_or(85.0), rod.value_or(kReferenceRod)}, 1.0 / fps);
  const std::optional<PushRange>& range = identified.push_range;
  if (range && !mass && !rod && !range->people.empty()) PlaceFittedPeople(range->people, &scene);
  const UsualPush usual = range ? range->usual.value_or(UsualPush{}) : UsualPush{};
  AddHipPush(pushed,
             {push.value_or(usual.impulse), 0.0, push_duration.value_or(usual.duration),
              push_direction * M_PI / 180.0, usual.height, usual.kind},
             &scene);
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

py::dict LoopDict(const Model& model, double mass, double rod) {
  if (!(mass > 0.0) || !(rod > 0.0)) Raise(Fault::kUsage, Error{"mass and rod must be above 0"});
  const IdentifiedModel identified = IdentifiedOf(model);
  const std::string without = WithoutLinearLoop(identified.options);
  if (!without.empty()) Raise(Fault::kUsage, Error{"the model has no linear loop: " + without});
  py::dict dict;
  for (int plane = 0; plane < 2; ++plane) {
    const LoopNumbers n =
        LinearLoop(identified.options, {mass, rod, 0.0}, identified.parameters, plane).Numbers();
    dict[plane == 0 ? "theta" : "phi"] =
        py::dict("stiffness_ratio"_a = n.stiffness_ratio, "stable"_a = n.stable,
                 "fastest_growth"_a = n.fastest_growth, "damping_ratio"_a = n.damping_ratio,
                 "natural_hz"_a = n.natural_hz, "phase_margin"_a = n.phase_margin,
                 "delay_margin"_a = n.delay_margin, "crossover_hz"_a = n.crossover_hz,
                 "gain_up"_a = n.gain_up, "gain_down"_a = n.gain_down);
  }
  return dict;
}

}  // namespace

void BindPredictions(py::module_* module) {
  module->def("predict", &PredictOn);
  module->def("simulate_formation", &OnFormation);
  module->def("loop", &LoopDict);
  py::class_<Online>(*module, "Online")
      .def(py::init<const Model&, const SharedRecording&, int, const std::string&>())
      .def("observe", &Online::Observe)
      .def("push", &Online::Push)
      .def("predict", &Online::Predict)
      .def("next", &Online::Next)
      .def_property_readonly("observed", &Online::observed);
  py::class_<Restoration, std::shared_ptr<Restoration>>(*module, "Restoration")
      .def("apply", [](const std::shared_ptr<Restoration>& r, const Model& model,
                       const SharedRecording& recording,
                       int observed) { return Restored(*r, model, recording, observed); });
  module->def("load_restoration", [](const std::string& folder) {
    return std::shared_ptr<Restoration>(Unwrapped(LoadRestoration(folder), Fault::kData));
  });
}

}  // namespace pushid
