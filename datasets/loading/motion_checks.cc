// datasets: whether positions read from a file can be a person at all.
#include "datasets/loading/motion_checks.h"

#include <cmath>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr double kShortestRod = 0.12, kLongestRod = 3.0;  // m; a small humanoid robot has 0.3
constexpr double kLargestLean = 1.0;                      // rad; beyond it the person has fallen
constexpr double kFarthest = 1e5;                         // m
constexpr int kFewestFrames = 3;                          // an acceleration takes three

constexpr double kShortestAdult = 0.5, kLongestAdult = 1.5;  // m, of rods

// The unit in which the rod would have an adult's length.
std::optional<LengthUnit> LikelyUnit(double rod_m, double metres_per_unit) {
  for (LengthUnit unit : {LengthUnit::kMillimetre, LengthUnit::kMetre, LengthUnit::kCentimetre}) {
    const double rod = rod_m / metres_per_unit * MetresPer(unit);
    if (rod >= kShortestAdult && rod <= kLongestAdult) return unit;
  }
  return std::nullopt;
}

MaybeError CheckTrack(const RecordedPerson& person, const char* what,
                      const std::vector<Eigen::Vector3d>& track) {
  for (std::size_t frame = 0; frame < track.size(); ++frame) {
    // Written so that NaN fails.
    if (!(track[frame].cwiseAbs().maxCoeff() < kFarthest) || !track[frame].allFinite()) {
      return Error{std::string("the ") + what + " is " + Rounded(track[frame].norm(), 3) +
                       " m from the origin at frame " + std::to_string(frame) +
                       ": a number is damaged, or the unit is wrong (--length_unit)",
                   person.file, 0};
    }
  }
  return std::nullopt;
}

}  // namespace

MaybeError CheckMotion(const RecordedPerson& person, double metres_per_unit) {
  if (person.hip.size() < kFewestFrames) {
    return Error{"the motion has " + std::to_string(person.hip.size()) +
                     " frames; at least three are needed",
                 person.file, 0};
  }
  const Eigen::Vector3d rod = person.hip[0] - 0.5 * (person.left_ankle[0] + person.right_ankle[0]);
  const double length = rod.norm();
  if (!(length >= kShortestRod && length <= kLongestRod)) {
    const std::optional<LengthUnit> likely = LikelyUnit(length, metres_per_unit);
    return Error{
        "the hip is " + Rounded(length, 3) + " m high above the ankles when lengths are read as " +
            LengthText(metres_per_unit) + ": " +
            (likely ? "looks like " + Name(*likely) + ", pass --length_unit=" + Name(*likely)
                    : "check the unit (--length_unit) and the joints chosen; give odd "
                      "units in metres (--length_scale)"),
        person.file, 0};
  }
  const double lean = std::acos(std::fmin(1.0, std::fmax(-1.0, rod.z() / length)));
  if (lean > kLargestLean) {
    return Error{"at frame 0 the line from the ankles to the hip leans " +
                     Rounded(lean * 180.0 / 3.14159265358979323846, 3) +
                     " degrees from up: if z is not the file's vertical axis, set \"up\" and "
                     "\"forward\" in the manifest; otherwise check \"joints\"",
                 person.file, 0};
  }
  if (MaybeError failed = CheckTrack(person, "hip", person.hip)) return failed;
  if (MaybeError failed = CheckTrack(person, "left ankle", person.left_ankle)) return failed;
  return CheckTrack(person, "right ankle", person.right_ankle);
}

}  // namespace pushid
