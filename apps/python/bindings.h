// apps: declarations shared by the sources of the Python module.
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
#include "ident/prediction/prediction.h"
#include "ident/pushid.h"

namespace pushid {

namespace py = pybind11;

// The origin of an error: the data, the call or the fit. Python sees DataError, UsageError and
// FitError with message, file and line.
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

// Calls `compute` with the GIL released.
template <typename Compute>
auto WithoutGil(Compute compute) {
  const py::gil_scoped_release no_gil;
  return compute();
}

// Progress of a long computation: checks for signals, so that Ctrl-C ends it, and calls `callable`.
// Called without the GIL.
template <typename... Args>
auto CallbackOf(const py::object& callable) {
  return [callable = callable.ptr()](Args... args) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable != Py_None) py::reinterpret_borrow<py::object>(callable)(args...);
  };
}
// Progress of a fit: (phase, iteration, cost).
inline SolveProgress ProgressOf(const py::object& callable) {
  return CallbackOf<const std::string&, int, double>(callable);
}
// Progress of many jobs: (done, total).
inline JobProgress JobsOf(const py::object& callable) { return CallbackOf<int, int>(callable); }

// Text with flags and programs replaced by options and calls: "--fix=mu=0" -> "fix={"mu": 0}",
// "pushid-push" -> "pushid.estimate_push".
std::string InPython(const std::string& text);
// Warnings that are equal or differ only in the recording are combined.
std::vector<std::string> InPython(const Warnings& warnings);
// Warns by Python's warnings.warn.
void Warn(const std::string& text);
void Warn(const Warnings& warnings);

// Warnings as the package keeps them: text, recording, of_many.
using WarningTuples = std::vector<std::tuple<std::string, std::string, std::string>>;
Warnings WarningsOf(const WarningTuples& tuples);

// Recordings are shared, so that results and arrays outlive the list they came from.
using SharedRecording = std::shared_ptr<const Recording>;
std::vector<PendulumRecording> Pendulums(const std::vector<SharedRecording>& recordings);

// The enum value with this name; raises UsageError.
template <typename E>
E Named(const char* argument, const std::string& name) {
  E value{};
  Check(ParseName(argument, name, &value), Fault::kUsage);
  return value;
}

using Array = py::array_t<double>;
// value(frame, person), each of `size` numbers, as a read-only array (frames, people, size).
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

inline Array Reshaped(const Array& array, const std::vector<int>& shape) {
  return array.attr("reshape")(shape);
}

void BindRecordings(py::module_* module);
void BindFits(py::module_* module);
void BindPredictions(py::module_* module);

// The recordings to which a model was fitted.
struct FittedTo {
  std::vector<SharedRecording> recordings;
  std::vector<PendulumRecording> pendulums;
};

// A model and its recordings. Both are replaced as a whole and never changed, as another thread may
// be reading them without the GIL. `to` is null where the model was loaded.
struct Model {
  std::shared_ptr<const FittedModel> fitted;
  std::shared_ptr<const FittedTo> to;
};

// The data of a model that asks for them.
std::shared_ptr<const FittedTo> DataOf(const Model& model);

IdentifiedModel IdentifiedOf(const Model& model);

}  // namespace pushid
