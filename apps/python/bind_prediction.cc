// apps: predictions in Python: from the first frame and the push, from frames as they come, and as
// whole bodies.
#include "apps/python/bindings.h"
#include "ident/bodies/body_evaluation.h"
#include "ident/bodies/body_recording.h"
#include "ident/bodies/restoration_files.h"
#include "ident/prediction/futures.h"
#include "ident/prediction/online_predictor.h"
#include "ident/prediction/prediction.h"
#include "ident/prediction/predictive_bands.h"
#include "models/rollout.h"

namespace pushid {

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

IdentifiedModel With(const Model& model, const std::string& set) {
  IdentifiedModel identified = IdentifiedOf(model);
  Check(SetValues(set, &identified), Fault::kUsage);
  return identified;
}

void WarnOfInputs(const IdentifiedModel& model, const PendulumRecording& recording) {
  for (const Warning& warning : InputWarnings(model, {recording})) Warn(warning.text);
}

namespace {

// Hips of drawn futures, (samples, frames, people, 3).
Array DrawsArray(const std::vector<HipPaths>& futures) {
  const size_t people = futures.empty() ? 0 : futures[0].size();
  const size_t frames = people == 0 ? 0 : futures[0][0].size();
  Array array({futures.size(), frames, people, size_t{3}});
  auto cells = array.mutable_unchecked<4>();
  for (size_t s = 0; s < futures.size(); ++s) {
    for (size_t n = 0; n < people; ++n) {
      for (size_t t = 0; t < frames; ++t) {
        for (int i = 0; i < 3; ++i) cells(s, t, n, i) = futures[s][n][t][i];
      }
    }
  }
  array.attr("flags").attr("writeable") = false;
  return array;
}

std::vector<HipPaths> HipsOf(const std::vector<std::vector<std::vector<BandPoint>>>& paths) {
  std::vector<HipPaths> hips;
  for (const auto& draw : paths) {
    hips.emplace_back();
    for (const auto& person : draw) {
      hips.back().emplace_back();
      for (const BandPoint& point : person) hips.back().back().push_back(point.head<3>());
    }
  }
  return hips;
}

// Futures by what the model knows of them: with process noise, its draws; else parameters drawn
// from their covariance, with the errors of the fitted recordings.
Result<std::vector<HipPaths>> Drawn(const Model& model, const IdentifiedModel& identified,
                                    const PendulumRecording& seen, int frames, int samples,
                                    uint64_t seed) {
  if (identified.options.process_noise != ProcessNoise::kNone) {
    Result<Futures> futures = DrawFutures(identified, seen, samples, seed, frames);
    if (!futures.ok()) return futures.error();
    return HipsOf(futures.value().paths);
  }
  const BandOptions options{samples, seed};
  const FitResult& fit = model.fitted->fit;
  const auto sets = SampleParameters(fit, options);
  if (!sets.ok()) return sets.error();
  return HipsOf(
      DrawPaths(fit, sets.value(), ErrorPaths(fit, DataOf(model)->pendulums), seen, seed, frames));
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
  const ForecastUse use = ForecastFrom(forecast);
  const PendulumRecording seen =
      PushedAs({push_scale, push_again}, MakePendulumRecording(*recording), observed, frames);
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
  if (samples > 0 && !set.empty() && identified.options.process_noise == ProcessNoise::kNone) {
    Raise(Fault::kUsage,
          Error{"samples draws the parameters, which set=... fixes; give one of them"});
  }
  WarnOfInputs(identified, seen);
  py::dict dict =
      DictOf(Unwrapped(PredictFrom(identified, seen, observed, frames, use), Fault::kUsage), seen);
  if (samples > 0) {
    dict["samples"] =
        DrawsArray(Unwrapped(Drawn(model, identified, seen, frames, samples, seed), Fault::kUsage));
  }
  return dict;
}

// Everybody's frames as they come; states need the frame before.
class Online {
 public:
  Online(const Model& model, const SharedRecording& recording, int frames,
         const std::string& forecast)
      : model_(std::make_unique<IdentifiedModel>(IdentifiedOf(model))),
        recording_(std::make_unique<PendulumRecording>(MakePendulumRecording(*recording))),
        last_(*recording),
        predictor_(std::make_unique<OnlinePredictor>(
            Unwrapped(OnlinePredictor::Make(*model_, *recording_, frames, ForecastFrom(forecast)),
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

  py::dict Predict() const { return DictOf(predictor_->Predict(), *recording_); }
  int observed() const { return predictor_->observed(); }

 private:
  std::unique_ptr<IdentifiedModel> model_;
  std::unique_ptr<PendulumRecording> recording_;
  Recording last_;  // the last two frames
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
  py::class_<Online>(*module, "Online")
      .def(py::init<const Model&, const SharedRecording&, int, const std::string&>())
      .def("observe", &Online::Observe)
      .def("predict", &Online::Predict)
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
