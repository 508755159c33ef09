// apps: recordings in Python: read from manifests, made by the model itself, as arrays.
#include <algorithm>
#include <limits>

#include "apps/python/bindings.h"
#include "datasets/inspection/findings.h"
#include "datasets/manifest/recording.h"
#include "ident/push/push_estimation.h"
#include "ident/validation/synthetic_truth.h"

namespace pushid {
namespace {

using namespace py::literals;

using Track = std::vector<Eigen::Vector3d>;

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
  const PendulumRecording seen = MakePendulumRecording(*recording);
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

py::object GroundArray(const SharedRecording& recording) {
  if (recording->ground.empty()) return py::none();
  Array array({static_cast<py::ssize_t>(recording->ground.size()), py::ssize_t{4}});
  auto cells = array.mutable_unchecked<2>();
  for (size_t t = 0; t < recording->ground.size(); ++t) {
    for (int i = 0; i < 4; ++i) cells(t, i) = recording->ground[t][i];
  }
  array.attr("flags").attr("writeable") = false;
  return std::move(array);
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
  if (!length_unit.empty()) options.length_unit = Named<LengthUnit>("length_unit", length_unit);
  if (length_scale != 0.0) {
    const std::string problem = LengthScaleProblem(length_scale);
    if (!problem.empty()) Raise(Fault::kUsage, Error{"length_scale " + problem});
    if (options.length_unit) {
      Raise(Fault::kUsage,
            Error{"length_scale is given together with length_unit; give one of them"});
    }
    options.length_scale = length_scale;
  }
  Check(CheckPreparation(options.preparation), Fault::kUsage);
  Warnings warnings;
  auto read = WithoutGil([&] { return LoadRecordings(manifest, options, &warnings); });
  std::vector<SharedRecording> recordings;
  std::vector<Finding> facing;
  for (Recording& one : Unwrapped(std::move(read), Fault::kData)) {
    for (Finding& finding : FacingFindings(one)) facing.push_back(std::move(finding));
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  for (Warning& doubt : FindingWarnings(facing)) warnings.push_back(std::move(doubt));
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
  const auto kind = FromName<PushKind>(push_kind);
  if (!kind)
    Raise(Fault::kUsage, Error{"push_kind is '" + push_kind + "'; it must be net or external"});
  options.push_kind = *kind;
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
                         int end_frame, int smoothing, const std::string& initial_velocity) {
  const PendulumRecording seen = MakePendulumRecording(*recording);
  PushEstimationOptions options;
  options.person = person;
  options.smoothing_frames = smoothing;
  Check(ParseInitialVelocity("initial_velocity", initial_velocity, &options.initial_velocity),
        Fault::kUsage);
  const PushWindow window =
      Unwrapped(PushWindowFrom({first_frame, end_frame}, seen, options), Fault::kData);
  const EstimatedPush push = Unwrapped(EstimatePush(seen, window, options), Fault::kData);
  Array rows({static_cast<py::ssize_t>(push.push.force.size()), py::ssize_t{4}});
  auto cells = rows.mutable_unchecked<2>();
  for (size_t t = 0; t < push.push.force.size(); ++t) {
    for (int i = 0; i < 4; ++i) cells(t, i) = push.push.force[t][i];
  }
  return py::make_tuple(rows, window.start, NameOf(push.kind));
}

// What of recordings cannot be right, a dict each.
py::list FindingsIn(const std::vector<SharedRecording>& recordings) {
  py::list list;
  std::vector<Finding> found = FindingsOf(Pendulums(recordings));
  for (const SharedRecording& one : recordings) {
    for (Finding& finding : FacingFindings(*one)) found.push_back(std::move(finding));
  }
  for (const Finding& finding : found) {
    const FindingRow& row = RowOf(finding.kind);
    list.append(py::dict("kind"_a = row.name, "recording"_a = finding.recording,
                         "about"_a = finding.about, "value"_a = finding.value, "unit"_a = row.unit,
                         "what"_a = row.what, "advice"_a = row.advice));
  }
  return list;
}

}  // namespace

void BindRecordings(py::module_* module) {
  const auto track = [](auto part) {
    return [part](const std::shared_ptr<Recording>& r) { return TrackArray(r, part); };
  };
  py::class_<Recording, std::shared_ptr<Recording>>(*module, "Recording")
      .def_readonly("id", &Recording::id, "Name, unique among the recordings of a fit.")
      .def_property_readonly(
          "setting", [](const Recording& r) { return r.labels.setting(); },
          "Label of the arrangement, as in the manifest.")
      .def_property_readonly(
          "magnitude", [](const Recording& r) { return r.labels.magnitude(); },
          "Label of the push strength, as in the manifest.")
      .def_property_readonly(
          "condition", [](const Recording& r) { return r.labels.condition(); },
          "Label of the protocol condition, as in the manifest.")
      .def_readonly("fps", &Recording::fps, "Frames per second.")
      .def_readonly("pushed_person", &Recording::pushed_person,
                    "Index of the person who is pushed.")
      .def_readonly("content_hash", &Recording::content_hash,
                    "Hash of everything that a fit reads from the recording.")
      .def_property_readonly("num_frames", &Recording::num_frames, "Number of frames.")
      .def_property_readonly(
          "num_people", [](const Recording& r) { return r.people.size(); }, "Number of people.")
      .def_property_readonly(
          "push_kind", [](const Recording& r) { return NameOf(r.push_kind); },
          "What the push means: \"external\", \"net\" or \"net_without_friction\".")
      .def_property_readonly(
          "initial_velocity", [](const Recording& r) { return NameOf(r.initial_velocity); },
          "\"zero\", \"estimated\" or \"free\".")
      .def_property_readonly(
          "subjects",
          [](const Recording& r) {
            std::vector<std::string> ids;
            for (const RecordedPerson& p : r.people) ids.push_back(p.subject_id);
            return ids;
          },
          "Id of each person.")
      .def_property_readonly(
          "mass",
          [](const Recording& r) {
            std::vector<double> masses;
            for (const RecordedPerson& p : r.people) masses.push_back(p.mass_kg);
            return masses;
          },
          "Mass of each person, kg.")
      .def_property_readonly(
          "known",
          [](const Recording& r) {
            py::list people;
            for (const RecordedPerson& p : r.people) {
              py::dict known;
              for (const auto& [key, number] : p.known.numbers) known[py::str(key)] = number;
              for (const auto& [key, text] : p.known.texts) known[py::str(key)] = text;
              people.append(known);
            }
            return people;
          },
          "Of each person: what the manifest says beside the mass, {key: number or text}.")
      .def_property_readonly("hip", track(&RecordedPerson::hip),
                             "(frames, people, 3), m; NaN where missing.")
      .def_property_readonly("left_ankle", track(&RecordedPerson::left_ankle),
                             "(frames, people, 3), m.")
      .def_property_readonly("right_ankle", track(&RecordedPerson::right_ankle),
                             "(frames, people, 3), m.")
      .def_property_readonly(
          "states", [](const std::shared_ptr<Recording>& r) { return StatesArray(r); },
          "(frames, people, 8): cart x, y (m), theta, phi (rad), and their rates (m/s, rad/s).")
      .def_property_readonly(
          "push", [](const std::shared_ptr<Recording>& r) { return PushArray(r); },
          "(frames, people, 4): generalized forces along x, y (N), theta, phi (N m).")
      .def_property_readonly(
          "ground", [](const std::shared_ptr<Recording>& r) { return GroundArray(r); },
          "(frames, 4): x, y (m), theta, phi (rad) of ground that moves; None where it rests.")
      .def_property_readonly(
          "plates", [](const std::shared_ptr<Recording>& r) { return PlatesArray(r); },
          "(frames, people, 5): force on the person fx, fy, fz (N) and centre of pressure px, py "
          "(m); None without.");
  module->attr("defaults") = Defaults();
  module->def("read", &Read);
  module->def("simulate", &Simulate);
  module->def("estimate_push", &EstimatePushOf);
  module->def("findings", &FindingsIn);
}

}  // namespace pushid
