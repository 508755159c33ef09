// apps: recordings in Python: read from manifests, made from arrays, made by the model itself.
#include <cmath>

#include "apps/python/bindings.h"
#include "datasets/loading/recording_from_tracks.h"
#include "datasets/manifest/recording_names.h"
#include "ident/push/push_estimation.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;
using Points = const Track RecordedPerson::*;

// One person's track is a view of the recording itself; those of several are gathered.
Array TrackArray(const SharedRecording& recording, Track RecordedPerson::*track) {
  const auto& people = recording->people;
  if (people.size() != 1) {
    return TableArray(recording->num_frames(), static_cast<int>(people.size()), 3,
                      [&](int t, int n) { return (people[n].*track)[t]; });
  }
  auto* keeper = new SharedRecording(recording);
  const py::capsule owner(keeper, [](void* p) { delete static_cast<SharedRecording*>(p); });
  Array view({static_cast<py::ssize_t>(recording->num_frames()), py::ssize_t{1}, py::ssize_t{3}},
             (people[0].*track)[0].data(), owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

Array StatesArray(const SharedRecording& recording) {
  const PendulumRecording seen = MakePendulumRecording(*recording, SkeletonMapping::kExact);
  return TableArray(seen.num_frames(), seen.num_people(), 8, [&](int t, int n) {
    Eigen::Matrix<double, 8, 1> state;
    state << seen.states[n][t].q, seen.states[n][t].qd;
    return state;
  });
}

// All pushes by frame and person; zero where nobody pushes.
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

py::tuple Read(const std::string& manifest, const std::string& setting,
               const std::vector<std::string>& ids, const std::vector<std::string>& leave_out,
               bool all_joints, double max_gap_s, double lowpass_hz, double resample_fps,
               const std::string& length_unit) {
  LoadOptions options;
  options.setting = setting;
  options.ids = ids;
  options.leave_out = leave_out;
  options.keep_all_joints = all_joints;
  options.preparation = {max_gap_s, lowpass_hz, resample_fps};
  if (!length_unit.empty()) {
    options.length_unit = LengthUnitFromName(length_unit);
    if (!options.length_unit) {
      Raise(Fault::kUsage, Error{"length_unit is '" + length_unit + "'; it must be mm, cm or m"});
    }
  }
  std::vector<std::string> warnings;
  Result<std::vector<Recording>> read = [&] {
    const py::gil_scoped_release no_gil;
    return LoadRecordings(manifest, options, &warnings);
  }();
  std::vector<SharedRecording> recordings;
  for (Recording& one : Unwrapped(std::move(read), Fault::kData)) {
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  return py::make_tuple(recordings, warnings);
}

Error WrongShape(const std::string& what, const Array& array, const std::string& must) {
  std::string shape;
  for (int i = 0; i < array.ndim(); ++i) {
    shape += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return Error{what + " has the shape (" + shape + "); it must be " + must};
}

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

// Rows of a push as it was given: numbers forwards, (fx, fy), (fx, fy, fz), or generalized forces.
void AddPush(const Array& rows, int person, int start, double height, Recording* recording) {
  const bool one = rows.ndim() == 1;
  const py::ssize_t columns = one ? 1 : rows.ndim() == 2 ? rows.shape(1) : 0;
  if (columns < 1 || columns > 4) {
    Raise(Fault::kData,
          WrongShape("push", rows,
                     "(rows,) or (rows, 2 or 3) of forces in N, or (rows, 4) of generalized forces "
                     "in N and N m"));
  }
  const PendulumRecording seen = MakePendulumRecording(*recording, SkeletonMapping::kExact);
  Push push;
  push.person = person;
  push.start_frame = start;
  for (py::ssize_t t = 0; t < rows.shape(0); ++t) {
    Eigen::Vector4d row = Eigen::Vector4d::Zero();
    for (py::ssize_t i = 0; i < columns; ++i) row[i] = one ? rows.at(t) : rows.at(t, i);
    if (columns < 4) {
      const auto& states = seen.states[person];
      const size_t frame = std::min<size_t>(start + t, states.size() - 1);
      row = GeneralizedForce<double>(seen.scene.people[person].body, states[frame].q,
                                     Vector3<double>(row.head<3>()), height);
    }
    push.force.push_back(row);
  }
  recording->pushes.push_back(std::move(push));
}

SharedRecording FromArrays(const Array& hip, const Array& left_ankle, const Array& right_ankle,
                           const std::vector<double>& mass, double fps, const py::object& push,
                           const std::string& id, const std::vector<std::string>& subjects,
                           int pushed_person, int push_start, double push_height,
                           const std::string& push_kind, const std::string& initial_velocity,
                           const std::string& setting, const std::string& magnitude,
                           const std::string& condition) {
  TrackedRecording tracks;
  tracks.id = id;
  tracks.fps = fps;
  tracks.setting = setting;
  tracks.magnitude = magnitude;
  tracks.condition = condition;
  tracks.pushed_person = pushed_person;
  const auto kind = PushKindFromName(push_kind);
  const auto velocity = InitialVelocityFromName(initial_velocity);
  if (!kind) {
    Raise(Fault::kUsage, Error{"push_kind is '" + push_kind +
                               "'; it must be net, net_without_friction or external"});
  }
  if (!velocity) {
    Raise(Fault::kUsage, Error{"initial_velocity is '" + initial_velocity +
                               "'; it must be zero, estimated or free"});
  }
  tracks.push_kind = *kind;
  tracks.initial_velocity = *velocity;
  const std::vector<Track> hips = TracksOf("hip", hip), left = TracksOf("left_ankle", left_ankle),
                           right = TracksOf("right_ankle", right_ankle);
  if (left.size() != hips.size() || right.size() != hips.size() || mass.size() != hips.size() ||
      (!subjects.empty() && subjects.size() != hips.size())) {
    Raise(Fault::kData, Error{"hip is of " + std::to_string(hips.size()) +
                              " people; ankles, mass and subjects must be of as many"});
  }
  if (pushed_person < 0 || pushed_person >= static_cast<int>(hips.size())) {
    Raise(Fault::kUsage, Error{"pushed_person is " + std::to_string(pushed_person) +
                               "; there are " + std::to_string(hips.size()) + " people"});
  }
  for (size_t n = 0; n < hips.size(); ++n) {
    tracks.people.push_back({subjects.empty() ? "person " + std::to_string(n) : subjects[n],
                             mass[n], hips[n], left[n], right[n]});
  }
  // The rod and the angles, which turn forces into generalized ones, come with the motion.
  Recording recording = Unwrapped(RecordingFromTracks(tracks), Fault::kData);
  if (push.is_none()) return std::make_shared<const Recording>(std::move(recording));
  if (push_start < 0) Raise(Fault::kUsage, Error{"push_start counts frames from 0"});
  AddPush(py::cast<Array>(push), pushed_person, push_start, push_height, &recording);
  tracks.pushes = recording.pushes;
  return std::make_shared<const Recording>(Unwrapped(RecordingFromTracks(tracks), Fault::kData));
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
  const auto kind = PushKindFromName(push_kind);
  if (!kind)
    Raise(Fault::kUsage, Error{"push_kind is '" + push_kind + "'; it must be net or external"});
  options.push_kind = *kind;
  const FitOptions preset = Unwrapped(MakeFitOptions({{"preset", "tail"}}), Fault::kUsage);
  IdentifiedModel truth;
  truth.options = preset.model;
  truth.table = preset.table;
  truth.parameters = preset.table.Values();
  for (Parameter p : preset.table.Free()) truth.parameters[p] = options.parameters[p];
  Check(SetValues(set, &truth), Fault::kUsage);
  options.model = truth.options;
  options.parameters = truth.parameters;
  const auto made = Unwrapped(MakeSyntheticRecordings(options), Fault::kUsage);
  std::vector<SharedRecording> recordings;
  for (const SyntheticRecording& one : made) {
    recordings.push_back(std::make_shared<const Recording>(one.recording));
  }
  py::dict values;
  for (Parameter p : preset.table.Free())
    values[py::str(preset.table[p].name)] = truth.parameters[p];
  return py::make_tuple(recordings, values);
}

py::tuple EstimatePushOf(const SharedRecording& recording, int person, int first_frame,
                         int end_frame, int smoothing, const std::string& initial_velocity) {
  const PendulumRecording seen = MakePendulumRecording(*recording, SkeletonMapping::kExact);
  PushEstimationOptions options;
  options.person = person;
  options.smoothing_frames = smoothing;
  if (initial_velocity != "auto") {
    options.initial_velocity = InitialVelocityFromName(initial_velocity);
    if (!options.initial_velocity || *options.initial_velocity == InitialVelocity::kFree) {
      Raise(Fault::kUsage, Error{"initial_velocity is '" + initial_velocity +
                                 "'; it must be zero, estimated or auto"});
    }
  }
  PushWindow window{first_frame, end_frame};
  if (window.start < 0 || window.end < 0) {
    const PushWindow found = Unwrapped(DetectPushWindow(seen, options), Fault::kData);
    if (window.start < 0) window.start = found.start;
    if (window.end < 0) window.end = found.end;
  }
  const EstimatedPush push = Unwrapped(EstimatePush(seen, window, options), Fault::kData);
  Array rows({static_cast<py::ssize_t>(push.push.force.size()), py::ssize_t{4}});
  auto cells = rows.mutable_unchecked<2>();
  for (size_t t = 0; t < push.push.force.size(); ++t) {
    for (int i = 0; i < 4; ++i) cells(t, i) = push.push.force[t][i];
  }
  return py::make_tuple(rows, window.start, Name(push.kind));
}

}  // namespace

void BindRecordings(py::module_* module) {
  py::class_<Recording, std::shared_ptr<Recording>>(*module, "Recording")
      .def_readonly("id", &Recording::id)
      .def_readonly("setting", &Recording::setting)
      .def_readonly("magnitude", &Recording::magnitude)
      .def_readonly("condition", &Recording::condition)
      .def_readonly("fps", &Recording::fps)
      .def_readonly("pushed_person", &Recording::pushed_person)
      .def_readonly("content_hash", &Recording::content_hash)
      .def_property_readonly("num_frames", &Recording::num_frames)
      .def_property_readonly("num_people", [](const Recording& r) { return r.people.size(); })
      .def_property_readonly("push_kind", [](const Recording& r) { return Name(r.push_kind); })
      .def_property_readonly("initial_velocity",
                             [](const Recording& r) { return Name(r.initial_velocity); })
      .def_property_readonly("subjects",
                             [](const Recording& r) {
                               std::vector<std::string> ids;
                               for (const RecordedPerson& p : r.people) ids.push_back(p.subject_id);
                               return ids;
                             })
      .def_property_readonly("mass",
                             [](const Recording& r) {
                               std::vector<double> masses;
                               for (const RecordedPerson& p : r.people) masses.push_back(p.mass_kg);
                               return masses;
                             })
      .def_property_readonly(
          "hip",
          [](const std::shared_ptr<Recording>& r) { return TrackArray(r, &RecordedPerson::hip); })
      .def_property_readonly("left_ankle",
                             [](const std::shared_ptr<Recording>& r) {
                               return TrackArray(r, &RecordedPerson::left_ankle);
                             })
      .def_property_readonly("right_ankle",
                             [](const std::shared_ptr<Recording>& r) {
                               return TrackArray(r, &RecordedPerson::right_ankle);
                             })
      .def_property_readonly("states",
                             [](const std::shared_ptr<Recording>& r) { return StatesArray(r); })
      .def_property_readonly("push",
                             [](const std::shared_ptr<Recording>& r) { return PushArray(r); });
  module->def("read", &Read);
  module->def("from_arrays", &FromArrays);
  module->def("simulate", &Simulate);
  module->def("estimate_push", &EstimatePushOf);
}

}  // namespace pushid
