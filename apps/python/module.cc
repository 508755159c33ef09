// apps: the Python module: errors, and what the other parts share.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "apps/python/bindings.h"

namespace pushid {
namespace {

// Owned by the module; set when it is imported.
PyObject* g_errors[3] = {};

}  // namespace

void Raise(Fault fault, const Error& error) {
  PyObject* type = g_errors[static_cast<int>(fault)];
  py::object value = py::reinterpret_borrow<py::object>(type)(InPython(error.ToString()));
  value.attr("file") = error.file.empty() ? py::object(py::none()) : py::str(error.file);
  value.attr("line") = error.line > 0 ? py::object(py::int_(error.line)) : py::none();
  PyErr_SetObject(type, value.ptr());
  throw py::error_already_set();
}

SolveProgress ProgressOf(const py::object& callable) {
  return [callable = callable.ptr()](const std::string& phase, int iteration, double cost) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable == Py_None) return;
    py::reinterpret_borrow<py::object>(callable)(phase, iteration, cost);
  };
}

JobProgress JobsOf(const py::object& callable) {
  return [callable = callable.ptr()](int done, int total) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (callable == Py_None) return;
    py::reinterpret_borrow<py::object>(callable)(done, total);
  };
}

std::string InPython(const std::string& text) {
  static const std::regex flag(R"((^|[^A-Za-z0-9_-])--([a-z]))");
  return std::regex_replace(text, flag, "$1$2");
}

void Warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, InPython(text).c_str(), 2) != 0) {
    throw py::error_already_set();
  }
}

std::vector<Recording> Copies(const std::vector<SharedRecording>& recordings) {
  std::vector<Recording> copies;
  for (const SharedRecording& one : recordings) copies.push_back(*one);
  return copies;
}

std::vector<PendulumRecording> Pendulums(const std::vector<SharedRecording>& recordings,
                                         SkeletonMapping mapping) {
  std::vector<PendulumRecording> pendulums;
  for (const SharedRecording& one : recordings) {
    pendulums.push_back(MakePendulumRecording(*one, mapping));
  }
  return pendulums;
}

Array PathsArray(const std::vector<std::vector<Vector3<double>>>& paths) {
  const int people = static_cast<int>(paths.size());
  const int frames = people == 0 ? 0 : static_cast<int>(paths[0].size());
  return TableArray(frames, people, 3, [&](int t, int n) { return paths[n][t]; });
}

py::object FromJson(const nlohmann::ordered_json& json) {
  if (json.is_null()) return py::none();
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  if (json.is_number()) return py::float_(json.get<double>());
  if (json.is_string()) {
    const std::string text = json.get<std::string>();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (text == "infinity") return py::float_(kInfinity);
    if (text == "-infinity") return py::float_(-kInfinity);
    if (text == "nan") return py::float_(std::nan(""));
    return py::str(text);
  }
  if (json.is_array()) {
    py::list list;
    for (const auto& item : json) list.append(FromJson(item));
    return std::move(list);
  }
  py::dict dict;
  for (const auto& [key, value] : json.items()) dict[py::str(key)] = FromJson(value);
  return std::move(dict);
}

}  // namespace pushid

PYBIND11_MODULE(_pushid, module) {
  using namespace pushid;
  module.doc() = "The C++ library behind pushid.";
  module.attr("version") = PUSHID_VERSION;
  const std::pair<const char*, const char*> errors[] = {
      {"DataError", "Invalid data: the problem, its location and its remedy."},
      {"UsageError", "Invalid request: the option, and its valid values."},
      {"FitError", "The fit failed, or a rollout left the model's domain."}};
  for (int i = 0; i < 3; ++i) {
    const std::string name = std::string("pushid.") + errors[i].first;
    g_errors[i] = PyErr_NewExceptionWithDoc(
        name.c_str(), errors[i].second, i == 2 ? PyExc_RuntimeError : PyExc_ValueError, nullptr);
    module.add_object(errors[i].first, py::reinterpret_borrow<py::object>(g_errors[i]));
  }
  BindRecordings(&module);
  BindArrays(&module);
  BindFits(&module);
  BindStudies(&module);
  BindPredictions(&module);
  BindFormations(&module);
}
