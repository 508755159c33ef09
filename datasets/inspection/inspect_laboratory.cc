// datasets: ground that moves and force platforms of a manifest's recordings, inspected.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/files/number_text.h"
#include "datasets/inspection/inspection.h"
#include "datasets/loading/ground_record.h"
#include "datasets/loading/plate_record.h"
#include "models/ipm.h"

namespace pushid {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kInMillimetres = 1000.0, kDegrees = 180.0 / M_PI;

InspectedGround GroundOf(const ManifestRecording& entry, const Recording& recording) {
  InspectedGround ground;
  ground.recording = entry.id;
  ground.kind = entry.ground.csv.empty() ? "markers" : NameOf(entry.ground.quantity);
  ground.rate_hz = recording.fps;
  if (!entry.ground.csv.empty()) {
    const Result<GroundTracks> tracks = GroundOfCsv(entry);
    if (tracks.ok()) ground.rate_hz = tracks.value().rate_hz;
  }
  const std::vector<GroundPose>& poses = recording.ground;
  for (size_t t = 0; t < poses.size(); ++t) {
    ground.farthest_m = std::max(ground.farthest_m, poses[t].head<2>().norm());
    ground.peak_tilt_rad = std::max(ground.peak_tilt_rad, poses[t].tail<2>().norm());
    if (t == 0 || t + 1 == poses.size()) continue;
    const GroundPose second = poses[t + 1] - 2.0 * poses[t] + poses[t - 1];
    ground.peak_acceleration =
        std::max(ground.peak_acceleration, second.head<2>().norm() * recording.fps * recording.fps);
  }
  return ground;
}

InspectedPlates PlatesOf(const ManifestRecording& entry, const ManifestPlates& plates,
                         const RecordedPerson& person) {
  InspectedPlates found{entry.id, person.subject_id, NameOf(plates.use)};
  const Result<PlateTracks> tracks = ReadPlates(entry, plates, person);
  if (tracks.ok()) {
    found.platforms = tracks.value().platforms;
    found.rate_hz = tracks.value().rate_hz;
  }
  double vertical = 0.0;
  int pressed = 0;
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    const Eigen::Vector2d centre = sample.centre.head<2>();
    found.least = pressed == 0 ? centre : Eigen::Vector2d(found.least.cwiseMin(centre));
    found.most = pressed == 0 ? centre : Eigen::Vector2d(found.most.cwiseMax(centre));
    vertical += sample.force.z();
    ++pressed;
  }
  if (pressed > 0) found.weight_ratio = vertical / pressed / (person.mass_kg * kGravity);
  return found;
}

std::string Span(double least, double most) {
  return Rounded(kInMillimetres * least, 3) + " to " + Rounded(kInMillimetres * most, 3) + " mm";
}

Json Two(const Eigen::Vector2d& v) { return Json::array({v.x(), v.y()}); }

}  // namespace

void InspectLaboratory(const ManifestRecording& entry, const Recording& recording,
                       Inspection* found) {
  if (entry.ground.given()) {
    const InspectedGround ground = GroundOf(entry, recording);
    found->Fact("ground", entry.id + ": " + ground.kind + " at " + Rounded(ground.rate_hz, 5) +
                              " per second, up to " +
                              Rounded(kInMillimetres * ground.farthest_m, 3) + " mm, " +
                              Rounded(ground.peak_acceleration, 3) + " m/s^2 and " +
                              Rounded(kDegrees * ground.peak_tilt_rad, 3) + " degrees of tilt");
    found->grounds.push_back(ground);
  }
  for (const ManifestPlates& plates : entry.plates) {
    const InspectedPlates seen =
        PlatesOf(entry, plates, recording.people[static_cast<size_t>(plates.person)]);
    std::string text = entry.id + ", " + seen.person + ": " + std::to_string(seen.platforms) +
                       " at " + Rounded(seen.rate_hz, 5) + " per second, ";
    text += plates.use == PlateUse::kNone
                ? "not used"
                : "measured: mean vertical force " + Rounded(seen.weight_ratio, 4) +
                      " of the weight, centre of pressure " + Span(seen.least.x(), seen.most.x()) +
                      " forward and " + Span(seen.least.y(), seen.most.y()) + " to the left";
    found->Fact("force plates", text);
    found->plates.push_back(seen);
  }
}

Json InspectionJson(const Inspection& inspection) {
  Json json = {
      {"schema", "pushid-inspection/1"}, {"file", inspection.path}, {"format", inspection.format}};
  json["facts"] = Json::array();
  for (const auto& [what, text] : inspection.facts) {
    json["facts"].push_back({{"what", what}, {"text", text}});
  }
  json["warnings"] = inspection.warnings;
  json["ground"] = Json::array();
  for (const InspectedGround& g : inspection.grounds) {
    json["ground"].push_back({{"recording", g.recording},
                              {"kind", g.kind},
                              {"rate_hz", g.rate_hz},
                              {"farthest_m", g.farthest_m},
                              {"peak_acceleration_m_s2", g.peak_acceleration},
                              {"peak_tilt_rad", g.peak_tilt_rad}});
  }
  json["plates"] = Json::array();
  for (const InspectedPlates& p : inspection.plates) {
    json["plates"].push_back({{"recording", p.recording},
                              {"person", p.person},
                              {"use", p.use},
                              {"platforms", p.platforms},
                              {"rate_hz", p.rate_hz},
                              {"weight_ratio", p.weight_ratio},
                              {"centre_least_m", Two(p.least)},
                              {"centre_most_m", Two(p.most)}});
  }
  return json;
}

}  // namespace pushid
