// apps: predictions in Python: from the first frame and the push, from frames as they come, on
// formations, and as whole bodies.
#include "apps/python/bindings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/bodies/restoration_files.h"
#include "ident/formations/formation_run.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/online_predictor.h"
#include "models/formation.h"

namespace pushid {

IdentifiedModel IdentifiedOf(const py::object& model);  // bind_fit.cc

namespace {

Array StatesOf(const RolloutPath<double>& path, int people) {
  return TableArray(path.num_frames(), people, 8, [&](int t, int n) {
    Eigen::Matrix<double, 8, 1> state;
    state << path.At(t, n).q, path.At(t, n).qd;
    return state;
  });
}

py::dict DictOf(const Prediction& prediction, const PendulumRecording& recording) {
  if (!prediction.status.ok) {
    Raise(Fault::kFit, Error{"recording " + recording.id + ": " + OutsideText(prediction.status)});
  }
  py::dict dict;
  dict["hip"] = PathsArray(prediction.hip);
  dict["states"] = StatesOf(prediction.path, recording.num_people());
  dict["observed"] = prediction.observed;
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

// Hips of drawn futures, (samples, frames, people, 3).
Array DrawsArray(const Futures& futures) {
  const auto& paths = futures.paths;
  const size_t people = paths.empty() ? 0 : paths[0].size();
  const size_t frames = people == 0 ? 0 : paths[0][0].size();
  Array array({paths.size(), frames, people, size_t{3}});
  auto cells = array.mutable_unchecked<4>();
  for (size_t s = 0; s < paths.size(); ++s) {
    for (size_t n = 0; n < people; ++n) {
      for (size_t t = 0; t < frames; ++t) {
        for (int i = 0; i < 3; ++i) cells(s, t, n, i) = paths[s][n][t][i];
      }
    }
  }
  return array;
}

IdentifiedModel With(const py::object& model, const std::string& set) {
  IdentifiedModel identified = IdentifiedOf(model);
  Check(SetValues(set, &identified), Fault::kUsage);
  return identified;
}

py::dict PredictOn(const py::object& model, const SharedRecording& recording, int observed,
                   int frames, int samples, uint64_t seed, const std::string& set) {
  const IdentifiedModel identified = With(model, set);
  const PendulumRecording seen = MakePendulumRecording(*recording, identified.mapping);
  if (observed > 0) Check(CheckObserved({seen}, observed), Fault::kUsage);
  py::dict dict =
      DictOf(Unwrapped(PredictFrom(identified, seen, observed, frames), Fault::kUsage), seen);
  if (samples > 0) {
    dict["samples"] =
        DrawsArray(Unwrapped(DrawFutures(identified, seen, samples, seed, frames), Fault::kUsage));
  }
  return dict;
}

py::dict OnFormation(const py::object& model, const std::string& shape, int people, double spacing,
                     int pushed, double push, double push_duration, double mass, double rod,
                     double duration, double fps, const std::string& set) {
  const std::map<std::string, FormationShape> shapes = {{"line", FormationShape::kLine},
                                                        {"diamond", FormationShape::kDiamond},
                                                        {"grid", FormationShape::kGrid}};
  const auto how = shapes.find(shape);
  if (how == shapes.end()) {
    Raise(Fault::kUsage, Error{"shape is '" + shape + "'; it must be line, diamond or grid"});
  }
  if (people < 1 || people > 1000 || pushed < 0 || pushed >= people || !(spacing > 0.0) ||
      !(mass > 0.0) || !(rod > 0.0) || !(duration > 0.0) || !(fps >= 1.0)) {
    Raise(Fault::kUsage, Error{"a formation has 1 to 1000 people, one of whom is pushed, and "
                               "spacing, mass, rod, duration and fps above 0"});
  }
  Body body;
  body.mass = mass;
  body.rod_length = rod;
  Scene scene = FormationScene(FormationPositions(how->second, people, spacing), body, 1.0 / fps);
  AddHipPush(pushed, {push, 0.0, push_duration}, &scene);
  const FormationRun run =
      RunFormation(With(model, set), scene, static_cast<int>(duration * fps) + 1);
  py::dict dict = DictOf(run.prediction, run.recording);
  py::list onset, outcome;
  for (const PersonSummary& person : run.summaries) {
    onset.append(person.onset_frame < 0 ? py::object(py::none())
                                        : py::object(py::float_(run.Seconds(person.onset_frame))));
    outcome.append(std::string(Name(person.outcome)));
  }
  dict["onset_s"] = onset;
  dict["outcome"] = outcome;
  return dict;
}

// Everybody's frames as they come; states need the frame before.
class Online {
 public:
  Online(const py::object& model, const SharedRecording& recording, int frames)
      : model_(std::make_unique<IdentifiedModel>(IdentifiedOf(model))),
        recording_(std::make_unique<PendulumRecording>(
            MakePendulumRecording(*recording, model_->mapping))),
        last_(*recording),
        predictor_(std::make_unique<OnlinePredictor>(
            Unwrapped(OnlinePredictor::Make(*model_, *recording_, frames), Fault::kUsage))) {
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
          Raise(Fault::kData, Error{"a frame with a value that is not finite; wait for the next"});
        }
        if (track->size() > 2) track->erase(track->begin());
      }
    }
    predictor_->Observe(FrameAt(MakePendulumRecording(last_, model_->mapping), 1));
  }

  py::dict Predict() const { return DictOf(predictor_->Predict(), *recording_); }
  int observed() const { return predictor_->observed(); }

 private:
  std::unique_ptr<IdentifiedModel> model_;
  std::unique_ptr<PendulumRecording> recording_;
  Recording last_;  // the last two frames
  std::unique_ptr<OnlinePredictor> predictor_;
};

// (frames, people, 22, 3), m.
Array Restored(const Restoration& restoration, const py::object& model,
               const SharedRecording& recording, int observed) {
  const IdentifiedModel identified = IdentifiedOf(model);
  const BodyRecording bodies =
      Unwrapped(MakeBodyRecording(*recording, identified.mapping), Fault::kData);
  const Prediction predicted =
      Unwrapped(PredictFrom(identified, bodies.pendulum, observed), Fault::kUsage);
  if (!predicted.status.ok) {
    Raise(Fault::kFit, Error{"recording " + recording->id + ": " + OutsideText(predicted.status)});
  }
  const auto motions = RestoreBodies(restoration, {}, PredictedPeople(bodies, predicted));
  const size_t frames = motions.empty() ? 0 : motions[0].size();
  Array array(std::vector<size_t>{frames, motions.size(), static_cast<size_t>(kBodyJoints), 3});
  auto cells = array.mutable_unchecked<4>();
  for (size_t n = 0; n < motions.size(); ++n) {
    for (size_t t = 0; t < frames; ++t) {
      for (int j = 0; j < kBodyJoints; ++j) {
        for (int i = 0; i < 3; ++i) cells(t, n, j, i) = motions[n][t](i, j);
      }
    }
  }
  return array;
}

}  // namespace

void BindPredictions(py::module_* module) {
  module->def("predict", &PredictOn);
  module->def("simulate_formation", &OnFormation);
  py::class_<Online>(*module, "Online")
      .def(py::init<const py::object&, const SharedRecording&, int>())
      .def("observe", &Online::Observe)
      .def("predict", &Online::Predict)
      .def_property_readonly("observed", &Online::observed);
  py::class_<Restoration, std::shared_ptr<Restoration>>(*module, "Restoration")
      .def("apply", [](const std::shared_ptr<Restoration>& r, const py::object& model,
                       const SharedRecording& recording,
                       int observed) { return Restored(*r, model, recording, observed); });
  module->def("load_restoration", [](const std::string& folder) {
    return std::shared_ptr<Restoration>(Unwrapped(LoadRestoration(folder), Fault::kData));
  });
}

}  // namespace pushid
