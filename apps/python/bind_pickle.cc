// apps: recordings as bytes, for pickle, copy and other processes.
#include <nlohmann/json.hpp>

#include "apps/python/bindings.h"
#include "ident/parameters/json_archive.h"

namespace pushid {

template <class Archive>
void Fields(Archive& a, Push& p) {
  PUSHID_FIELDS(a, p, person, start_frame, force, file);
}

template <class Archive>
void Fields(Archive& a, PlateSample& sample) {
  PUSHID_FIELDS(a, sample, force, centre, weight);
}

// Roles are of the joints, and go with them. A BVH file's skeleton stays behind: only the programs
// write motions back into such files.
template <class Archive>
void Fields(Archive& a, RecordedPerson& p) {
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
  PUSHID_FIELDS(a, r, fps, pushed_person, push_kind, initial_velocity, people, pushes, ground,
                stated_errors, content_hash);
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
