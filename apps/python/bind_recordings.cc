// apps: recordings in Python: from manifests, arrays and simulation; as arrays and bytes.
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/python/bindings.h"
#include "datasets/inspection/findings.h"
#include "datasets/loading/motion_tracks.h"
#include "datasets/manifest/recording.h"
#include "datasets/sensors/force_sensors.h"
#include "ident/fit/fit_setup.h"
#include "ident/parameters/json_archive.h"
#include "ident/push/push_estimation.h"

namespace pushid {

// Fields of a recording, for pickle, copy and other processes.
PUSHID_FIELDS_OF(Push, person, start_frame, force, file)
PUSHID_FIELDS_OF(PlateSample, force, centre, weight)

// The skeleton of a BVH file is not included: only the programs write BVH files.
void Fields(JsonArchive& a, RecordedPerson& p) {
  PUSHID_FIELDS(a, p, subject_id, mass_kg);
  a("numbers", p.known.numbers);
  a("texts", p.known.texts);
  PUSHID_FIELDS(a, p, file, file_clock_s, skipped_s, file_up, file_forward, hip, left_ankle,
                right_ankle, left_toe, right_toe, left_heel, right_heel, weight, plates, joints,
                joint_names, joint_parents);
  std::vector<std::vector<int>> roles(p.roles.joints.begin(), p.roles.joints.end());
  a("roles", roles);
  std::copy_n(roles.begin(), std::min(roles.size(), p.roles.joints.size()), p.roles.joints.begin());
  a("left_asis", p.roles.left_asis);
  a("right_asis", p.roles.right_asis);
  a("back", p.roles.back);
}

void Fields(JsonArchive& a, StatedErrors& s) {
  for (const StatedErrorRow& row : kStatedErrors) a(row.key, s.*row.value);
}

void Fields(JsonArchive& a, Recording& r) {
  a("id", r.id);
  std::map<std::string, std::string> labels;
  for (const std::string& key : r.labels.Keys()) labels[key] = r.labels.Of(key);
  a("labels", labels);
  for (const auto& [key, text] : labels) r.labels.Set(key, text);
  PUSHID_FIELDS(a, r, fps, pushed_person, push_kind, initial_velocity, people, pushes, ground,
                stated_errors, content_hash);
}

namespace {

using namespace py::literals;

using Track = std::vector<Eigen::Vector3d>;

Array TrackArray(const SharedRecording& recording, Track RecordedPerson::*track) {
  const auto& people = recording->people;
  return TableArray(recording->num_frames(), static_cast<int>(people.size()), 3,
                    [&](int t, int n) { return (people[n].*track)[t]; });
}

Array StatesArray(const SharedRecording& recording) {
  const PendulumRecording seen = MakePendulumRecording(*recording);
  return TableArray(seen.num_frames(), seen.num_people(), 8, [&](int t, int n) {
    Eigen::Matrix<double, 8, 1> state;
    state << seen.states[n][t].q, seen.states[n][t].qd;
    return state;
  });
}

Array PushArray(const SharedRecording& recording) {
  const int people = static_cast<int>(recording->people.size());
  std::vector<std::vector<Eigen::Vector4d>> force(
      people, std::vector<Eigen::Vector4d>(recording->num_frames(), Eigen::Vector4d::Zero()));
  for (const Push& push : recording->pushes) {
    for (size_t i = 0; i < push.force.size(); ++i) {
      force[push.person][push.start_frame + i] += push.force[i];
    }
  }
  return TableArray(recording->num_frames(), people, 4, [&](int t, int n) { return force[n][t]; });
}

// (frames, 4).
Array RowsArray(const std::vector<Eigen::Vector4d>& rows) {
  const int frames = static_cast<int>(rows.size());
  return Reshaped(TableArray(frames, 1, 4, [&](int t, int) { return rows[t]; }), {frames, 4});
}

py::object GroundArray(const SharedRecording& recording) {
  if (recording->ground.empty()) return py::none();
  return RowsArray(recording->ground);
}

// NaN where nothing was measured.
py::object PlatesArray(const SharedRecording& recording) {
  const auto& people = recording->people;
  const auto measured = [](const RecordedPerson& person) { return !person.plates.empty(); };
  if (std::none_of(people.begin(), people.end(), measured)) return py::none();
  return TableArray(recording->num_frames(), static_cast<int>(people.size()), 5, [&](int t, int n) {
    Eigen::Matrix<double, 5, 1> row;
    row.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (people[n].plates.empty() || people[n].plates[t].weight <= 0.0) return row;
    const PlateSample& sample = people[n].plates[t];
    row << sample.force, sample.centre.head<2>();
    return row;
  });
}

py::tuple Read(const std::string& manifest, const std::string& setting,
               const std::vector<std::string>& ids, const std::vector<std::string>& leave_out,
               bool all_joints, double max_gap_s, double lowpass_hz, double resample_fps,
               const std::string& length_unit, double length_scale) {
  LoadOptions options;
  options.setting = setting;
  options.ids = ids;
  options.leave_out = leave_out;
  options.keep_all_joints = all_joints;
  options.preparation = {max_gap_s, lowpass_hz, resample_fps};
  options.length = Unwrapped(ChooseLength("", length_unit, length_scale), Fault::kUsage);
  Check(CheckPreparation(options.preparation), Fault::kUsage);
  Warnings warnings;
  auto read = WithoutGil([&] { return LoadRecordings(manifest, options, &warnings); });
  std::vector<Recording> loaded = Unwrapped(std::move(read), Fault::kData);
  const Warnings facing = FindingWarnings(FacingFindings(loaded));
  warnings.insert(warnings.end(), facing.begin(), facing.end());
  std::vector<SharedRecording> recordings;
  for (Recording& one : loaded) {
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  Warn(warnings);
  py::list told;
  for (const Warning& warning : warnings) {
    told.append(py::make_tuple(warning.text, warning.recording, warning.of_many));
  }
  return py::make_tuple(recordings, told);
}

py::tuple Simulate(int people, int recordings_per_person, int people_in_row, double fps, int frames,
                   uint64_t seed, const std::string& push_kind, double joint_noise_m,
                   const std::string& set) {
  SyntheticOptions options;
  options.subjects = people;
  options.recordings_per_subject = recordings_per_person;
  options.people_in_row = people_in_row;
  options.fps = fps;
  options.frames = frames;
  options.seed = seed;
  options.joint_noise_m = joint_noise_m;
  options.push_kind = Named<PushKind>("push_kind", push_kind);
  const IdentifiedModel truth = Unwrapped(SyntheticTruth(options, set), Fault::kUsage);
  options.model = truth.options;
  options.parameters = truth.parameters;
  const auto made = Unwrapped(MakeSyntheticRecordings(options), Fault::kUsage);
  std::vector<SharedRecording> recordings;
  for (const SyntheticRecording& one : made) {
    recordings.push_back(std::make_shared<const Recording>(one.recording));
  }
  py::dict values;
  for (Parameter p : truth.table.Free()) {
    values[py::str(truth.table[p].name)] = truth.parameters[p];
  }
  return py::make_tuple(recordings, values);
}

// The defaults of Read and Simulate.
py::dict Defaults() {
  const LoadOptions read;
  const SyntheticOptions made;
  return py::dict("setting"_a = read.setting, "max_gap_s"_a = read.preparation.max_gap_s,
                  "lowpass_hz"_a = read.preparation.lowpass_hz,
                  "resample_fps"_a = read.preparation.resample_fps, "people"_a = made.subjects,
                  "recordings_per_person"_a = made.recordings_per_subject,
                  "people_in_row"_a = made.people_in_row, "fps"_a = made.fps,
                  "frames"_a = made.frames, "seed"_a = made.seed,
                  "push_kind"_a = NameOf(made.push_kind));
}

py::tuple EstimatePushOf(const SharedRecording& recording, int person, int first_frame,
                         int end_frame, int smoothing) {
  const PendulumRecording seen = MakePendulumRecording(*recording);
  PushEstimationOptions options;
  options.person = person;
  options.smoothing_frames = smoothing;
  const PushWindow window =
      Unwrapped(DetectPushWindow(seen, options, {first_frame, end_frame}), Fault::kData);
  const EstimatedPush push = Unwrapped(EstimatePush(seen, window, options), Fault::kData);
  return py::make_tuple(RowsArray(push.push.force), window.start, NameOf(push.kind));
}

// A dict for each finding.
py::list FindingsIn(const std::vector<SharedRecording>& recordings) {
  py::list list;
  std::vector<Finding> found = FindingsOf(Pendulums(recordings));
  for (const SharedRecording& one : recordings) {
    for (Finding& finding : FacingFindings({*one})) found.push_back(std::move(finding));
  }
  for (const Finding& finding : found) {
    const FindingRow& row = RowOf(finding.kind);
    list.append(py::dict("kind"_a = row.name, "recording"_a = finding.recording,
                         "about"_a = finding.about, "value"_a = finding.value, "unit"_a = row.unit,
                         "what"_a = row.what, "advice"_a = row.advice));
  }
  return list;
}

Error WrongShape(const std::string& what, const Array& array, const std::string& must) {
  std::string shape;
  for (int i = 0; i < array.ndim(); ++i) {
    shape += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return Error{what + " has the shape (" + shape + "); it must be " + must};
}

// rows[person][frame] of an array (frames, people, N), whatever its strides.
template <int N>
std::vector<std::vector<Eigen::Matrix<double, N, 1>>> RowsOf(const std::string& what,
                                                             const Array& array,
                                                             const std::string& must) {
  if (array.ndim() != 3 || array.shape(2) != N) Raise(Fault::kData, WrongShape(what, array, must));
  std::vector<std::vector<Eigen::Matrix<double, N, 1>>> rows(array.shape(1));
  for (py::ssize_t n = 0; n < array.shape(1); ++n) {
    rows[n].resize(array.shape(0));
    for (py::ssize_t t = 0; t < array.shape(0); ++t) {
      for (int i = 0; i < N; ++i) rows[n][t][i] = array.at(t, n, i);
    }
  }
  return rows;
}

// (frames, 2) of shifts in m, or (frames, 4) with tilts in rad.
std::vector<GroundPose> GroundFrom(const py::object& given) {
  if (given.is_none()) return {};
  const Array array = py::cast<Array>(given);
  if (array.ndim() != 2 || (array.shape(1) != 2 && array.shape(1) != 4)) {
    Raise(Fault::kData, WrongShape("ground", array,
                                   "(frames, 2) of x and y in m, or (frames, 4) with theta and phi "
                                   "in rad"));
  }
  std::vector<GroundPose> poses(array.shape(0), GroundPose::Zero());
  for (py::ssize_t t = 0; t < array.shape(0); ++t) {
    for (py::ssize_t i = 0; i < array.shape(1); ++i) poses[t][i] = array.at(t, i);
  }
  return poses;
}

// (frames, people, 5) of fx, fy, fz in N and px, py in m; NaN: not measured.
void AddPlates(const py::object& given, std::vector<RecordedPerson>* people) {
  if (given.is_none()) return;
  const char* must = "(frames, 5), or (frames, people, 5), of fx, fy, fz in N and px, py in m";
  const Array array = py::cast<Array>(given);
  const auto rows = RowsOf<5>("plates", array, must);
  if (rows.size() != people->size()) Raise(Fault::kData, WrongShape("plates", array, must));
  for (size_t n = 0; n < rows.size(); ++n) {
    std::vector<PlateSample>& plates = (*people)[n].plates;
    for (const auto& row : rows[n]) {
      PlateSample sample;
      if (!row.hasNaN()) {
        sample.force = row.template head<3>();
        sample.centre = {row[3], row[4], 0.0};
        sample.weight = row[2] >= kPressed ? 1.0 : 0.0;
      }
      plates.push_back(sample);
    }
    const auto measured = [](const PlateSample& sample) { return sample.weight > 0.0; };
    if (std::none_of(plates.begin(), plates.end(), measured)) plates.clear();
  }
}

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

// rows: (fx), (fx, fy), (fx, fy, fz), or generalized forces.
void AddPush(const Array& rows, int person, int start, const PushHeight& height,
             Recording* recording) {
  const py::ssize_t columns = rows.ndim() == 2 ? rows.shape(1) : 0;
  if (columns < 1 || columns > 4) {
    Raise(Fault::kData,
          WrongShape("push", rows,
                     "(rows,) or (rows, 2 or 3) of forces in N, or (rows, 4) of generalized forces "
                     "in N and N m"));
  }
  Push push;
  push.person = person;
  push.start_frame = start;
  std::vector<Eigen::Vector3d> forces;
  for (py::ssize_t t = 0; t < rows.shape(0); ++t) {
    Eigen::Vector4d row = Eigen::Vector4d::Zero();
    for (py::ssize_t i = 0; i < columns; ++i) row[i] = rows.at(t, i);
    push.force.push_back(row);
    forces.push_back(row.head<3>());
  }
  if (columns < 4) push.force = PushAtHeight(recording->people[person], start, forces, height);
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
  Recording tracks;
  tracks.id = id;
  tracks.fps = fps;
  tracks.labels.Set(kSettingLabel, setting);
  tracks.labels.Set(kMagnitudeLabel, magnitude);
  tracks.labels.Set(kConditionLabel, condition);
  tracks.pushed_person = pushed_person;
  tracks.push_kind = Named<PushKind>("push_kind", push_kind);
  tracks.initial_velocity = Named<InitialVelocity>("initial_velocity", initial_velocity);
  const char* must = "(frames, 3) or (frames, people, 3), in m";
  const auto hips = RowsOf<3>("hip", hip, must), left = RowsOf<3>("left_ankle", left_ankle, must),
             right = RowsOf<3>("right_ankle", right_ankle, must);
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
    RecordedPerson& person = tracks.people.emplace_back();
    person.subject_id = subjects.empty() ? "person " + std::to_string(n) : subjects[n];
    person.mass_kg = mass[n];
    person.hip = hips[n], person.left_ankle = left[n], person.right_ankle = right[n];
  }
  tracks.ground = GroundFrom(ground);
  AddPlates(plates, &tracks.people);
  const PushHeight height{push_height, push_height_m};
  CheckHeight(height);
  // Generalized forces need the rod and the angles, which are computed from the motion.
  Warnings warnings;
  Recording recording = Unwrapped(RecordingFromTracks(tracks, {}, &warnings), Fault::kData);
  const Warnings ankles = FindingWarnings(FacingFindings({recording}));
  warnings.insert(warnings.end(), ankles.begin(), ankles.end());
  Warn(warnings);
  if (push.is_none()) return std::make_shared<const Recording>(std::move(recording));
  if (push_start < 0) Raise(Fault::kUsage, Error{"push_start counts frames from 0"});
  AddPush(py::cast<Array>(push), pushed_person, push_start, height, &recording);
  tracks.pushes = recording.pushes;
  return std::make_shared<const Recording>(Unwrapped(RecordingFromTracks(tracks), Fault::kData));
}

}  // namespace

void BindRecordings(py::module_* module) {
  using Shared = std::shared_ptr<Recording>;
  const auto track = [](auto part) {
    return [part](const Shared& r) { return TrackArray(r, part); };
  };
  const auto of_people = [](auto part) {
    return [part](const Recording& r) {
      py::list values;
      for (const RecordedPerson& person : r.people) values.append(part(person));
      return values;
    };
  };
  py::class_<Recording, Shared>(*module, "Recording", R"(A recording; its arrays are read-only.

id, unique among the recordings of a fit; setting, magnitude, condition: labels as in the manifest; fps; pushed_person: index;
num_frames, num_people; push_kind: "external", "net" or "net_without_friction"; initial_velocity: "zero", "estimated" or "free";
content_hash: of everything that a fit reads. subjects, mass (kg), known ({key: number or text}, what the manifest says beside the
mass): one of each person. hip, left_ankle, right_ankle: (frames, people, 3), m, NaN where missing. states: (frames, people, 8),
cart x, y (m), theta, phi (rad) and their rates. push: (frames, people, 4), generalized forces along x, y (N), theta, phi (N m).
ground: (frames, 4), x, y (m), theta, phi (rad), None where it rests. plates: (frames, people, 5), force on the person fx, fy, fz
(N) and centre of pressure px, py (m), or None.)")
      .def_readonly("id", &Recording::id)
      .def_readonly("fps", &Recording::fps)
      .def_readonly("pushed_person", &Recording::pushed_person)
      .def_readonly("content_hash", &Recording::content_hash)
      .def_property_readonly("setting", [](const Recording& r) { return r.labels.setting(); })
      .def_property_readonly("magnitude", [](const Recording& r) { return r.labels.magnitude(); })
      .def_property_readonly("condition", [](const Recording& r) { return r.labels.condition(); })
      .def_property_readonly("num_frames", &Recording::num_frames)
      .def_property_readonly("num_people", [](const Recording& r) { return r.people.size(); })
      .def_property_readonly("push_kind", [](const Recording& r) { return NameOf(r.push_kind); })
      .def_property_readonly("initial_velocity",
                             [](const Recording& r) { return NameOf(r.initial_velocity); })
      .def_property_readonly("subjects",
                             of_people([](const RecordedPerson& p) { return p.subject_id; }))
      .def_property_readonly("mass", of_people([](const RecordedPerson& p) { return p.mass_kg; }))
      .def_property_readonly("known", of_people([](const RecordedPerson& p) {
                               py::dict known;
                               for (const auto& [key, n] : p.known.numbers) known[py::str(key)] = n;
                               for (const auto& [key, s] : p.known.texts) known[py::str(key)] = s;
                               return known;
                             }))
      .def_property_readonly("hip", track(&RecordedPerson::hip))
      .def_property_readonly("left_ankle", track(&RecordedPerson::left_ankle))
      .def_property_readonly("right_ankle", track(&RecordedPerson::right_ankle))
      .def_property_readonly("states", [](const Shared& r) { return StatesArray(r); })
      .def_property_readonly("push", [](const Shared& r) { return PushArray(r); })
      .def_property_readonly("ground", [](const Shared& r) { return GroundArray(r); })
      .def_property_readonly("plates", [](const Shared& r) { return PlatesArray(r); });
  module->attr("defaults") = Defaults();
  module->def("read", &Read);
  module->def("from_arrays", &FromArrays);
  module->def("simulate", &Simulate);
  module->def("estimate_push", &EstimatePushOf);
  module->def("findings", &FindingsIn);
  module->def("metres_per", [](const std::string& unit) {
    return MetresPer(Named<LengthUnit>("length_unit", unit));
  });
  module->def("to_bytes", [](const Recording& recording) {
    const std::vector<std::uint8_t> cbor = nlohmann::ordered_json::to_cbor(JsonOf(recording));
    return py::bytes(reinterpret_cast<const char*>(cbor.data()), cbor.size());
  });
  module->def("from_bytes", [](const std::string& bytes) {
    return std::make_shared<const Recording>(
        FromJson<Recording>(nlohmann::ordered_json::from_cbor(bytes)));
  });
}

}  // namespace pushid
