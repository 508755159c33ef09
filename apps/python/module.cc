// apps: the Python module: errors, warnings and their words, and what the other parts share.
#include "apps/python/bindings.h"

namespace pushid {
namespace {

// Owned by the module; set when it is imported.
PyObject* g_errors[3] = {};

}  // namespace

std::string InPython(const std::string& text) {
  return py::cast<std::string>(py::module_::import("pushid._options").attr("in_python")(text));
}

std::vector<std::string> InPython(const Warnings& warnings) {
  std::vector<std::string> words = GroupedWarnings(warnings);
  for (std::string& text : words) text = InPython(text);
  return words;
}

void Raise(Fault fault, const Error& error) {
  PyObject* type = g_errors[static_cast<int>(fault)];
  py::object value = py::reinterpret_borrow<py::object>(type)(InPython(error.ToString()));
  value.attr("file") = error.file.empty() ? py::object(py::none()) : py::str(error.file);
  value.attr("line") = error.line > 0 ? py::object(py::int_(error.line)) : py::none();
  PyErr_SetObject(type, value.ptr());
  throw py::error_already_set();
}

void Warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, InPython(text).c_str(), 2) != 0) {
    throw py::error_already_set();
  }
}

void Warn(const Warnings& warnings) {
  for (const std::string& text : GroupedWarnings(warnings)) Warn(text);
}

Warnings WarningsOf(const WarningTuples& tuples) {
  Warnings warnings;
  for (const auto& [text, recording, of_many] : tuples) {
    warnings.emplace_back(text, recording, of_many);
  }
  return warnings;
}

std::vector<PendulumRecording> Pendulums(const std::vector<SharedRecording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const SharedRecording& one : recordings) {
    pendulums.push_back(MakePendulumRecording(*one));
  }
  return pendulums;
}

}  // namespace pushid

PYBIND11_MODULE(_pushid, module) {
  using namespace pushid;
  module.doc() = "The C++ library behind pushid.";
  module.attr("version") = PUSHID_VERSION;
  module.def("grouped",
             [](const WarningTuples& tuples) { return GroupedWarnings(WarningsOf(tuples)); });
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
  BindFits(&module);
  BindPredictions(&module);
}
