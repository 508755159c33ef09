// apps: the Python module: errors, arrays, and what the other parts share.
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/python/bindings.h"
#include "datasets/inspection/findings.h"
#include "datasets/loading/recording_from_tracks.h"
#include "datasets/manifest/recording.h"
#include "ident/parameters/json_archive.h"
#include "ident/push/push_from_sensor.h"

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

void Warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, InPython(text).c_str(), 2) != 0) {
    throw py::error_already_set();
  }
}

void Warn(const Warnings& warnings) {
  for (const std::string& text : GroupedWarnings(warnings)) Warn(text);
}

Warnings WarningsOf(const Told& told) {
  Warnings warnings;
  for (const auto& [text, recording, of_many] : told) {
    warnings.emplace_back(text, recording, of_many);
  }
  return warnings;
}

std::vector<Recording> Copies(const std::vector<SharedRecording>& recordings) {
  std::vector<Recording> copies;
  for (const SharedRecording& one : recordings) copies.push_back(*one);
  return copies;
}

std::vector<PendulumRecording> Pendulums(const std::vector<SharedRecording>& recordings) {
  std::vector<PendulumRecording> pendulums;
  for (const SharedRecording& one : recordings) {
    pendulums.push_back(MakePendulumRecording(*one));
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
  module.def("in_python", py::overload_cast<const std::string&>(&InPython));
  module.def("in_python", [](const Told& told) { return InPython(WarningsOf(told)); });
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
  BindPickle(&module);
  BindFits(&module);
  BindStudies(&module);
  BindPredictions(&module);
  BindFormations(&module);
  BindStanding(&module);
  BindFigures(&module);
}

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

// (frames, 3) or (frames, people, 3), whatever its strides.
std::vector<Track> TracksOf(const std::string& what, const Array& array) {
  const bool alone = array.ndim() == 2 && array.shape(1) == 3;
  if (!alone && !(array.ndim() == 3 && array.shape(2) == 3)) {
    Raise(Fault::kData, WrongShape(what, array, "(frames, 3) or (frames, people, 3), in m"));
  }
  const py::ssize_t people = alone ? 1 : array.shape(1);
  std::vector<Track> tracks(people, Track(array.shape(0)));
  for (py::ssize_t n = 0; n < people; ++n) {
    for (py::ssize_t t = 0; t < array.shape(0); ++t) {
      for (py::ssize_t i = 0; i < 3; ++i) {
        tracks[n][t][i] = alone ? array.at(t, i) : array.at(t, n, i);
      }
    }
  }
  return tracks;
}

// Where a push acts: a fraction of the way from the ankles to the hip, or metres.
struct PushHeight {
  double fraction = 1.0;
  std::optional<double> metres;
};

void CheckHeight(const PushHeight& height) {
  if (!height.metres && !(height.fraction >= 0.0 && height.fraction <= 1.0)) {
    Raise(Fault::kUsage, Error{"push_height is " + Rounded(height.fraction) +
                               "; it is a fraction of the way from the ankles (0) to the hip (1); "
                               "give metres above the ground as push_height_m"});
  }
  if (height.metres && !(*height.metres >= 0.0 && *height.metres <= 3.0)) {
    Raise(Fault::kUsage, Error{"push_height_m is " + Rounded(*height.metres) +
                               "; it must be a height between 0 and 3 m"});
  }
}

// Rows of a push as it was given: numbers forwards, (fx, fy), (fx, fy, fz), or generalized forces.
void AddPush(const Array& rows, int person, int start, const PushHeight& height,
             Recording* recording) {
  const bool one = rows.ndim() == 1;
  const py::ssize_t columns = one ? 1 : rows.ndim() == 2 ? rows.shape(1) : 0;
  if (columns < 1 || columns > 4) {
    Raise(Fault::kData,
          WrongShape("push", rows,
                     "(rows,) or (rows, 2 or 3) of forces in N, or (rows, 4) of generalized forces "
                     "in N and N m"));
  }
  const PendulumRecording seen = MakePendulumRecording(*recording);
  Push push;
  push.person = person;
  push.start_frame = start;
  const Body& body = seen.scene.people[person].body;
  const auto& states = seen.states[person];
  const auto state = [&states](size_t frame) {
    return states[std::min(frame, states.size() - 1)].q;
  };
  const double fraction =
      height.metres ? HeightFraction(body, state(start), *height.metres) : height.fraction;
  for (py::ssize_t t = 0; t < rows.shape(0); ++t) {
    Eigen::Vector4d row = Eigen::Vector4d::Zero();
    for (py::ssize_t i = 0; i < columns; ++i) row[i] = one ? rows.at(t) : rows.at(t, i);
    if (columns < 4) {
      row = GeneralizedForce<double>(body, state(start + t), Vector3<double>(row.head<3>()),
                                     fraction);
    }
    push.force.push_back(row);
  }
  recording->pushes.push_back(std::move(push));
}

SharedRecording FromArrays(const Array& hip, const Array& left_ankle, const Array& right_ankle,
                           const std::vector<double>& mass, double fps, const py::object& push,
                           const std::string& id, const std::vector<std::string>& subjects,
                           int pushed_person, int push_start, double push_height,
                           std::optional<double> push_height_m, const std::string& push_kind,
                           const std::string& initial_velocity, const std::string& setting,
                           const std::string& magnitude, const std::string& condition,
                           const py::object& ground, const py::object& plates) {
  TrackedRecording tracks;
  tracks.id = id;
  tracks.fps = fps;
  tracks.labels.Set(kSettingLabel, setting);
  tracks.labels.Set(kMagnitudeLabel, magnitude);
  tracks.labels.Set(kConditionLabel, condition);
  tracks.pushed_person = pushed_person;
  tracks.push_kind = Named<PushKind>("push_kind", push_kind);
  tracks.initial_velocity = Named<InitialVelocity>("initial_velocity", initial_velocity);
  const std::vector<Track> hips = TracksOf("hip", hip), left = TracksOf("left_ankle", left_ankle),
                           right = TracksOf("right_ankle", right_ankle);
  if (left.size() != hips.size() || right.size() != hips.size() || mass.size() != hips.size() ||
      (!subjects.empty() && subjects.size() != hips.size())) {
    Raise(Fault::kData, Error{"hip has " + std::to_string(hips.size()) +
                              " people; ankles, mass and subjects must have as many"});
  }
  if (pushed_person < 0 || pushed_person >= static_cast<int>(hips.size())) {
    Raise(Fault::kUsage, Error{"pushed_person is " + std::to_string(pushed_person) +
                               "; there are " + std::to_string(hips.size()) + " people"});
  }
  for (size_t n = 0; n < hips.size(); ++n) {
    tracks.people.push_back({subjects.empty() ? "person " + std::to_string(n) : subjects[n],
                             mass[n], hips[n], left[n], right[n]});
  }
  TakeLaboratory(ground, plates, &tracks);
  const PushHeight height{push_height, push_height_m};
  CheckHeight(height);
  // The rod and the angles, which turn forces into generalized ones, come with the motion.
  Warnings warnings;
  Recording recording = Unwrapped(RecordingFromTracks(tracks, {}, &warnings), Fault::kData);
  const Warnings ankles = FindingWarnings(FacingFindings(recording));
  warnings.insert(warnings.end(), ankles.begin(), ankles.end());
  Warn(warnings);
  if (push.is_none()) return std::make_shared<const Recording>(std::move(recording));
  if (push_start < 0) Raise(Fault::kUsage, Error{"push_start counts frames from 0"});
  AddPush(py::cast<Array>(push), pushed_person, push_start, height, &recording);
  tracks.pushes = recording.pushes;
  return std::make_shared<const Recording>(Unwrapped(RecordingFromTracks(tracks), Fault::kData));
}

}  // namespace

void BindArrays(py::module_* module) {
  module->def("from_arrays", &FromArrays);
  module->def("metres_per", [](const std::string& unit) {
    return MetresPer(Named<LengthUnit>("length_unit", unit));
  });
}

}  // namespace pushid
