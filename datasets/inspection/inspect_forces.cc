// datasets: forces of files, inspected.
#include "datasets/inspection/inspect_forces.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "datasets/files/list_of_names.h"
#include "datasets/files/number_text.h"
#include "datasets/sensors/force_platform.h"

namespace pushid {
namespace {

constexpr std::size_t kMostSignals = 6;  // in the picture
constexpr double kRest = 0.01;           // of the peak
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

void TakeOffRest(std::vector<double>* force, Inspection* found) {
  const std::size_t tenth = force->size() / 10;
  if (tenth == 0) return;
  std::vector<double> ends(force->begin(), force->begin() + tenth);
  ends.insert(ends.end(), force->end() - tenth, force->end());
  std::nth_element(ends.begin(), ends.begin() + tenth, ends.end());
  const double rest = ends[tenth];
  double peak = 0.0;
  for (double value : *force) peak = std::max(peak, std::fabs(value - rest));
  if (!(std::fabs(rest) > kRest * peak)) return;
  found->Fact("at rest", Rounded(rest, 3) + " N, subtracted below; pushid-push --sensor_zero=" +
                             Rounded(rest, 3) + " does the same");
  for (double& value : *force) value -= rest;
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
  const LengthUnit unit = LengthUnitFromName(file.point_unit).value_or(LengthUnit::kMillimetre);
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

}  // namespace pushid
