// datasets: forces, crowds and manifests, inspected.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "datasets/files/names.h"
#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/formats/trajectories.h"
#include "datasets/inspection/findings.h"
#include "datasets/inspection/inspection.h"
#include "datasets/loading/load_recordings.h"
#include "datasets/sensors/force_platform.h"

namespace pushid {
namespace {

constexpr std::size_t kMostSignals = 6;  // in the picture
constexpr double kForceOnset = 20.0;     // N

}  // namespace

void AddForce(const std::string& name, double rate_hz, std::vector<double> values,
              Inspection* found) {
  double peak = 0.0, impulse = 0.0;
  int onset = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    if (std::fabs(values[i]) > std::fabs(peak)) peak = values[i];
    impulse += values[i] / rate_hz;
    if (onset < 0 && std::fabs(values[i]) > kForceOnset) onset = static_cast<int>(i);
  }
  found->Fact(name, "peak " + Rounded(peak, 3) + " N, impulse " + Rounded(impulse, 3) + " N s" +
                        (onset >= 0 ? ", above " + Rounded(kForceOnset) + " N from " +
                                          Rounded(onset / rate_hz, 3) + " s"
                                    : ""));
  if (found->forces.size() < kMostSignals) {
    found->forces.push_back({name, "N", rate_hz, std::move(values)});
  }
}

void LookAtAnalog(const C3dFile& file, Inspection* found) {
  std::vector<std::string> names;
  std::set<std::string> units;
  for (const C3dAnalogChannel& channel : file.analog) {
    names.push_back(channel.name);
    units.insert(channel.unit);
    const bool steady =
        std::all_of(channel.samples.begin(), channel.samples.end(),
                    [&channel](double sample) { return sample == channel.samples[0]; });
    if (steady && file.num_frames() > 1) names.back() += " (constant)";
  }
  found->Fact("analog", ListOfNames(names) + " at " + Rounded(file.analog_rate_hz) +
                            " per second, in " + ListOfNames({units.begin(), units.end()}));
  for (const C3dAnalogChannel& channel : file.analog) {
    if (channel.unit == "N" && file.platforms.empty()) {
      AddForce(channel.name, file.analog_rate_hz, channel.samples, found);
    }
  }
}

void LookAtPlatforms(const C3dFile& file, Inspection* found) {
  const LengthUnit unit = FromName<LengthUnit>(file.point_unit).value_or(LengthUnit::kMillimetre);
  for (std::size_t i = 0; i < file.platforms.size(); ++i) {
    const std::string name = "platform:" + std::to_string(i + 1);
    const Result<PlatformRecord> platform = EvaluatePlatform(file, static_cast<int>(i), unit);
    if (!platform.ok()) {
      found->Warn(platform.error().message);
      continue;
    }
    const Eigen::Vector3d& normal = platform.value().normal;
    std::vector<double> pressing;
    for (const Eigen::Vector3d& force : platform.value().force) {
      pressing.push_back(force.dot(normal));
    }
    found->Fact(name + " type", std::to_string(file.platforms[i].type) + ", surface faces (" +
                                    Rounded(normal.x(), 2) + ", " + Rounded(normal.y(), 2) + ", " +
                                    Rounded(normal.z(), 2) + ")");
    AddForce(name, platform.value().rate_hz, std::move(pressing), found);
    if (file.platforms[i].origin.z() > 0.0) {
      found->Warn(name +
                  " has its sensors above its surface (ORIGIN z > 0); they are taken to be "
                  "below");
    }
  }
}

namespace {

// The file's frame with most people.
std::int64_t FullestFrame(const PointMotion& motion) {
  int fullest = 0;
  std::ptrdiff_t most = -1;
  for (int frame = 0; frame < motion.num_frames(); ++frame) {
    const auto there =
        std::count_if(motion.positions.begin(), motion.positions.end(),
                      [frame](const auto& track) { return track[frame].allFinite(); });
    if (there > most) fullest = frame, most = there;
  }
  return FirstFrame(motion) + fullest;
}

}  // namespace

void InspectCrowd(const PointMotion& motion, Inspection* found) {
  found->Fact("people", std::to_string(motion.names.size()) + ": " + ListOfNames(motion.names));
  found->Fact("frames", std::to_string(motion.num_frames()) + " at " + Rounded(motion.rate_hz) +
                            " per second, from the file's frame " +
                            std::to_string(FirstFrame(motion)));
  const std::int64_t frame = FullestFrame(motion);
  const Result<std::vector<CrowdPlace>> places = PlacesAt(motion, frame);
  if (!places.ok()) return;
  const std::size_t people = places.value().size();
  found->Fact("fullest frame",
              std::to_string(frame) + ": " + std::to_string(people) + " people" +
                  (people < 2 ? ""
                              : ", the nearest other " + Rounded(MedianSpacing(places.value()), 3) +
                                    " m away (median)"));
  const std::string odd = OddSpacing(places.value());
  if (!odd.empty()) found->Warn(odd);
  found->Fact("use", "pushid-formation --formation=" + motion.path + " --formation_frame=" +
                         std::to_string(frame) + " places people as they stand there");
}

MaybeError InspectManifest(Inspection* found) {
  const Result<Manifest> manifest = ReadManifests(found->path);
  if (!manifest.ok()) return manifest.error();
  std::map<std::string, int> settings, formats;
  std::set<std::string> subjects;
  int pushed = 0, read = 0;
  std::vector<PendulumRecording> pendulums;
  std::vector<Finding> facing;
  for (const ManifestRecording& entry : manifest.value().recordings) {
    ++settings[entry.labels.setting()];
    ++formats[entry.plates_alone ? "force plates alone" : Title(entry.motion_format)];
    for (const ManifestSubject& subject : entry.subjects) subjects.insert(subject.id);
    pushed += entry.push_csv.empty() && entry.pushes.empty() ? 0 : 1;
    Warnings warnings;
    LoadOptions options;
    options.plates_alone = true;
    const Result<Recording> recording = LoadRecording(manifest.value(), entry, options, &warnings);
    for (const Warning& warning : warnings) found->Warn(warning.text);
    if (recording.ok()) ++read;
    if (recording.ok()) {
      InspectLaboratory(entry, recording.value(), found);
      pendulums.push_back(MakePendulumRecording(recording.value(), SkeletonMapping::kExact));
      const std::vector<Finding> more = FacingFindings(recording.value());
      facing.insert(facing.end(), more.begin(), more.end());
    }
    if (!recording.ok()) found->Warn(recording.error().ToString());
  }
  std::vector<Finding> findings = FindingsOf(pendulums);
  findings.insert(findings.end(), facing.begin(), facing.end());
  for (const std::string& text : FindingTexts(findings)) found->Warn(text);
  const auto counts = [](const std::map<std::string, int>& of) {
    std::vector<std::string> texts;
    for (const auto& [name, count] : of) texts.push_back(name + " " + std::to_string(count));
    return ListOfNames(texts);
  };
  const std::size_t all = manifest.value().recordings.size();
  found->Fact("recordings", std::to_string(all) + ", " + std::to_string(read) + " can be read, " +
                                std::to_string(pushed) + " have a push");
  found->Fact("settings", counts(settings));
  found->Fact("formats", counts(formats));
  found->Fact("subjects", ListOfNames({subjects.begin(), subjects.end()}));
  return std::nullopt;
}

}  // namespace pushid
