// apps: recordings as bytes, for pickle, copy and other processes.
#include <nlohmann/json.hpp>

#include "apps/python/bindings.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

template <class Archive>
void Fields(Archive& a, Push& p) {
  a("person", p.person);
  a("start_frame", p.start_frame);
  a("force", p.force);
  a("file", p.file);
}

template <class Archive>
void Fields(Archive& a, PlateSample& sample) {
  a("force", sample.force);
  a("centre", sample.centre);
  a("weight", sample.weight);
}

// Roles are of the joints, and go with them. A BVH file's skeleton stays behind: only the programs
// write motions back into such files.
template <class Archive>
void Fields(Archive& a, RecordedPerson& p) {
  a("subject_id", p.subject_id);
  a("mass_kg", p.mass_kg);
  a("numbers", p.known.numbers);
  a("texts", p.known.texts);
  a("file", p.file);
  a("file_clock_s", p.file_clock_s);
  a("skipped_s", p.skipped_s);
  a("file_up", p.file_up);
  a("file_forward", p.file_forward);
  a("hip", p.hip);
  a("left_ankle", p.left_ankle);
  a("right_ankle", p.right_ankle);
  a("left_toe", p.left_toe);
  a("right_toe", p.right_toe);
  a("left_heel", p.left_heel);
  a("right_heel", p.right_heel);
  a("weight", p.weight);
  a("plates", p.plates);
  a("joints", p.joints);
  a("joint_names", p.joint_names);
  a("joint_parents", p.joint_parents);
  std::vector<std::vector<int>> roles(p.roles.joints.begin(), p.roles.joints.end());
  a("roles", roles);
  std::copy_n(roles.begin(), std::min(roles.size(), p.roles.joints.size()), p.roles.joints.begin());
  a("left_asis", p.roles.left_asis);
  a("right_asis", p.roles.right_asis);
  a("back", p.roles.back);
}

template <class Archive>
void Fields(Archive& a, StatedErrors& s) {
  for (const StatedErrorRow& row : kStatedErrors) a(row.key, s.*row.value);
}

template <class Archive>
void Fields(Archive& a, Recording& r) {
  a("id", r.id);
  std::map<std::string, std::string> labels;
  for (const std::string& key : r.labels.Keys()) labels[key] = r.labels.Of(key);
  a("labels", labels);
  for (const auto& [key, text] : labels) r.labels.Set(key, text);
  a("fps", r.fps);
  a("pushed_person", r.pushed_person);
  a("push_kind", r.push_kind);
  a("initial_velocity", r.initial_velocity);
  a("people", r.people);
  a("pushes", r.pushes);
  a("ground", r.ground);
  a("stated_errors", r.stated_errors);
  a("content_hash", r.content_hash);
}

void BindPickle(py::module_* module) {
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
