// datasets: a data set of Motion-BIDS.
#include "datasets/exchange/bids_dataset.h"

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "datasets/files/atomic_file.h"
#include "datasets/files/json_file.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_bids.h"
#include "datasets/manifest/manifest.h"

namespace pushid {
namespace {

constexpr char kTask[] = "push";

constexpr char kReadme[] =
    "Recordings of people who were pushed, as Motion-BIDS.\n\n"
    "Positions are metres, x forward (the direction of the push), y left, z up. The channels\n"
    "push_fx, push_fy (N), push_ftheta and push_fphi (N m) are the generalized force on the\n"
    "pendulum of hip and feet; n/a: no push. manifest.json lists the recordings for pushid.\n";

std::string Label(const std::string& name) {
  std::string label;
  for (char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (plain) label += c;
  }
  return label;
}

// Labels by name; an Error where two names have one.
class Labels {
 public:
  explicit Labels(const char* noun) : noun_(noun) {}

  MaybeError Add(const std::string& name) {
    const std::string label = Label(name);
    const auto [found, is_new] = names_.emplace(label, name);
    if (!label.empty() && (is_new || found->second == name)) return std::nullopt;
    return Error{std::string(noun_) + " " + Quoted(name) +
                 (label.empty() ? " has no letter or digit"
                                : " and " + Quoted(found->second) + " are both " + Quoted(label) +
                                      " in letters and digits") +
                 ", which is what Motion-BIDS names files by; rename one in the manifest"};
  }

 private:
  const char* noun_;
  std::map<std::string, std::string> names_;
};

// All joints of the file, without frames that do not count.
PointMotion PointsOfPerson(const Recording& recording, const RecordedPerson& person) {
  PointMotion motion;
  motion.rate_hz = recording.fps;
  motion.unit = LengthUnit::kMetre;
  motion.names = person.joint_names;
  motion.positions.resize(motion.names.size());
  const Eigen::Vector3d unseen =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int frame = 0; frame < recording.num_frames(); ++frame) {
    const bool counts = person.weight.empty() || person.weight[frame] > 0.0;
    for (std::size_t i = 0; i < motion.names.size(); ++i) {
      motion.positions[i].push_back(counts ? person.joints[frame][i] : unseen);
    }
  }
  return motion;
}

// Hip and ankles as they were read, by the names that stand in the file.
JointMapping MappingOf(const RecordedPerson& person) {
  JointMapping mapping;
  for (int role : {kBodyHip, kLeftAnkle, kRightAnkle}) {
    JointReference reference;
    for (int joint : person.roles.joints[role]) {
      reference.mean_of.push_back(JointReference{person.joint_names[joint]});
    }
    mapping.Set(role, reference.mean_of.size() == 1 ? reference.mean_of[0] : reference);
  }
  return mapping;
}

std::vector<TimedForce> PushesOn(const Recording& recording, int person) {
  std::vector<TimedForce> pushes;
  for (const Push& push : recording.pushes) {
    if (push.person == person) pushes.push_back({push.start_frame, push.force});
  }
  return pushes;
}

MaybeError WriteRecording(const std::string& folder, const Recording& recording,
                          ManifestRecording* entry) {
  for (std::size_t n = 0; n < recording.people.size(); ++n) {
    const RecordedPerson& person = recording.people[n];
    const std::string subject = "sub-" + Label(person.subject_id);
    const std::string stem = subject + "/motion/" + subject + "_task-" + kTask +
                             "_tracksys-body_acq-" + Label(recording.id);
    if (MaybeError failed = MakeFolder(folder + "/" + subject + "/motion")) return failed;
    const std::vector<TimedForce> pushes = PushesOn(recording, static_cast<int>(n));
    if (MaybeError failed = WriteMotionBids(folder + "/" + stem, kTask,
                                            PointsOfPerson(recording, person), pushes)) {
      return failed;
    }
    entry->subjects.push_back({person.subject_id, person.mass_kg, MappingOf(person)});
    entry->motion.push_back(stem + "_motion.tsv");
    if (!pushes.empty()) {
      entry->pushes.push_back({static_cast<int>(n), entry->motion.back(), 0});
    }
  }
  return std::nullopt;
}

// What a data set would lose: read again, it would be another experiment.
MaybeError CheckLaboratory(const Recording& recording) {
  std::string lost = recording.ground.empty() ? "" : "ground that moves (\"ground\")";
  for (const RecordedPerson& person : recording.people) {
    if (lost.empty() && !person.plates.empty()) lost = "force platforms (\"force_plates\")";
  }
  if (lost.empty()) return std::nullopt;
  return Error{"recording " + Quoted(recording.id) + " has " + lost +
               ", which the exported data set would lose; leave the recording out "
               "(--leave_out), or take the key out of its manifest"};
}

MaybeError WriteParticipants(const std::string& folder,
                             const std::map<std::string, double>& masses) {
  std::string text = "participant_id\tmass_kg\n";
  for (const auto& [subject, mass] : masses) {
    text += "sub-" + Label(subject) + '\t' + DoubleText(mass) + '\n';
  }
  nlohmann::ordered_json about;
  about["mass_kg"] = {{"Description", "body mass"}, {"Units", "kg"}};
  if (MaybeError failed = WriteJson(folder + "/participants.json", about)) return failed;
  return WriteFileAtomically(folder + "/participants.tsv", text);
}

MaybeError WriteAbout(const std::string& folder, const std::string& version) {
  nlohmann::ordered_json about;
  about["Name"] = "Recordings of pushed people";
  about["BIDSVersion"] = "1.10.0";
  about["DatasetType"] = "raw";
  about["GeneratedBy"] = {{{"Name", "pushid"}, {"Version", version}}};
  if (MaybeError failed = WriteJson(folder + "/dataset_description.json", about)) return failed;
  if (MaybeError failed = WriteFileAtomically(folder + "/README", kReadme)) return failed;
  return WriteFileAtomically(folder + "/.bidsignore", "manifest.json\n");
}

}  // namespace

MaybeError WriteBidsDataset(const std::string& folder, const std::vector<Recording>& recordings,
                            const std::string& version) {
  Labels subjects("subject"), ids("recording");
  std::map<std::string, double> masses;
  for (const Recording& recording : recordings) {
    if (MaybeError failed = ids.Add(recording.id)) return failed;
    if (MaybeError failed = CheckLaboratory(recording)) return failed;
    for (const RecordedPerson& person : recording.people) {
      if (MaybeError failed = subjects.Add(person.subject_id)) return failed;
      masses[person.subject_id] = person.mass_kg;
    }
  }
  if (MaybeError failed = MakeFolder(folder)) return failed;
  Manifest manifest;
  manifest.length_unit = LengthUnit::kMetre;
  for (const Recording& recording : recordings) {
    manifest.recordings.push_back(EntryOf(recording));
    manifest.recordings.back().motion_format = MotionFormat::kBids;
    if (MaybeError failed = WriteRecording(folder, recording, &manifest.recordings.back())) {
      return failed;
    }
  }
  if (MaybeError failed = WriteAbout(folder, version)) return failed;
  if (MaybeError failed = WriteParticipants(folder, masses)) return failed;
  return WriteManifest(folder + "/manifest.json", manifest);
}

}  // namespace pushid
