// apps: what the parts of the Python module share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/names.h"
#include "datasets/loading/warning.h"
#include "ident/fit.h"
#include "ident/parameters/option_names.h"
#include "ident/prediction/prediction.h"

namespace pushid {

namespace py = pybind11;

// What went wrong, by whose fault: the data's, the caller's, the fit's. Python sees DataError,
// UsageError and FitError with message, file and line.
enum class Fault { kData, kUsage, kFit };
[[noreturn]] void Raise(Fault fault, const Error& error);

template <typename T>
T Unwrapped(Result<T> result, Fault fault) {
  if (!result.ok()) Raise(fault, result.error());
  return std::move(result).value();
}
inline void Check(const MaybeError& error, Fault fault) {
  if (error) Raise(fault, *error);
}

// What `compute` returns, with the GIL released while it computes.
template <typename Compute>
auto WithoutGil(Compute compute) {
  const py::gil_scoped_release no_gil;
  return compute();
}

// A fit's progress: looks for signals, so that Ctrl-C ends it, and tells `callable` (phase,
// iteration, cost). Called without the GIL.
SolveProgress ProgressOf(const py::object& callable);

// Progress of many jobs: the same, `callable` (done, total).
JobProgress JobsOf(const py::object& callable);

// Flags and programs as options and calls: "--fix=mu=0" -> "fix={"mu": 0}", "pushid-push" ->
// "pushid.estimate_push".
std::string InPython(const std::string& text);
// Equal ones, or those that differ only in the recording, once.
std::vector<std::string> InPython(const Warnings& warnings);
// As warnings.warn does.
void Warn(const std::string& text);
void Warn(const Warnings& warnings);

// Warnings as the package keeps them: text, recording, of_many.
using Told = std::vector<std::tuple<std::string, std::string, std::string>>;
Warnings WarningsOf(const Told& told);

// Recordings are shared, so that results and arrays outlive the list they came from.
using SharedRecording = std::shared_ptr<const Recording>;
std::vector<Recording> Copies(const std::vector<SharedRecording>& recordings);
std::vector<PendulumRecording> Pendulums(const std::vector<SharedRecording>& recordings);

// A choice by its name.
template <typename E>
E Named(const char* argument, const std::string& name) {
  E value{};
  Check(ParseName(argument, name, &value), Fault::kUsage);
  return value;
}

using Array = py::array_t<double>;
// paths[person][frame] as (frames, people, 3), read-only.
Array PathsArray(const std::vector<std::vector<Vector3<double>>>& paths);
// value(frame, person) of so many numbers, as (frames, people, size), read-only.
template <typename Value>
Array TableArray(int frames, int people, int size, Value value) {
  Array array({frames, people, size});
  auto cells = array.mutable_unchecked<3>();
  for (int t = 0; t < frames; ++t) {
    for (int n = 0; n < people; ++n) {
      const auto row = value(t, n);
      for (int i = 0; i < size; ++i) cells(t, n, i) = row[i];
    }
  }
  array.attr("flags").attr("writeable") = false;
  return array;
}

// A document as Python has it; the texts that stand for numbers JSON does not know are numbers.
py::object FromJson(const nlohmann::ordered_json& json);

// "push has the shape (3, 7); it must be ...".
Error WrongShape(const std::string& what, const Array& array, const std::string& must);

// Ground and platforms from arrays, or None.
struct TrackedRecording;
void TakeLaboratory(const py::object& ground, const py::object& plates, TrackedRecording* tracks);

void BindArrays(py::module_* module);
void BindRecordings(py::module_* module);
void BindPickle(py::module_* module);
void BindFits(py::module_* module);
void BindStudies(py::module_* module);
void BindPredictions(py::module_* module);
void BindFormations(py::module_* module);
void BindStanding(py::module_* module);
void BindFigures(py::module_* module);

// What a model was fitted to.
struct FittedTo {
  std::vector<SharedRecording> recordings;
  std::vector<PendulumRecording> pendulums;
};

// Both parts are replaced whole and never changed: another thread may be reading them without the
// GIL. `to` is null where the model was loaded.
struct Model {
  std::shared_ptr<const FittedModel> fitted;
  std::shared_ptr<const FittedTo> to;
};

// The data of a model that asks for them.
std::shared_ptr<const FittedTo> DataOf(const Model& model);

IdentifiedModel IdentifiedOf(const Model& model);

// With the figures of the recordings that the model has, if any. Releases the GIL.
struct Report;
Report ReportOf(const FittedModel& fitted, const Model& model);

// (frames, people, 8): q, then qd.
Array StatesOf(const RolloutPath<double>& path, int people);

// Who forecasts after observed frames. Raises on another name.
inline ForecastUse ForecastFrom(const std::string& name) {
  ForecastUse use = ForecastUse::kBoth;
  Check(ParseName("forecast", name, &use), Fault::kUsage);
  return use;
}

// hip, states, observed, and bands where there are any. Raises where the rollout left the domain.
py::dict DictOf(const Prediction& prediction, const PendulumRecording& recording);

// The model with some of its values replaced: "Kp_theta=1500,...".
IdentifiedModel With(const Model& model, const std::string& set);

// Warns of pushes beyond those that the model was fitted to.
void WarnOfInputs(const IdentifiedModel& model, const PendulumRecording& recording);

}  // namespace pushid
