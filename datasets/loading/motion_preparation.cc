// datasets: what is done to a motion between the file and the fit.
#include "datasets/loading/motion_preparation.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"
#include "datasets/manifest/joint_choice.h"

namespace pushid {
namespace {

using Track = std::vector<Eigen::Vector3d>;

constexpr double kSlowestCutoff = 0.5;  // Hz
constexpr double kNearlyAsFast = 0.95;  // of the old rate: there is next to nothing to alias

// change(track) for hip, feet and, where they were kept, every joint.
template <typename Change>
void ForEachTrack(RecordedPerson* person, const Change& change) {
  for (const PendulumTrack& row : kPendulumTracks) {
    Track& track = person->*row.track;
    if (!track.empty()) change(&track);
  }
  if (person->joints.empty()) return;
  std::vector<Track> tracks(person->joints[0].size());
  for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
    for (const auto& frame : person->joints) tracks[joint].push_back(frame[joint]);
    change(&tracks[joint]);
  }
  person->joints.assign(tracks[0].size(), Track(tracks.size()));
  for (std::size_t frame = 0; frame < person->joints.size(); ++frame) {
    for (std::size_t joint = 0; joint < tracks.size(); ++joint) {
      person->joints[frame][joint] = tracks[joint][frame];
    }
  }
}

bool IsRate(double value) { return FrameRateProblem(value).empty(); }

}  // namespace

MaybeError CheckPreparation(const PreparationOptions& options) {
  if (!(options.max_gap_s >= 0.0 && options.max_gap_s <= 10.0)) {
    return Error{"--max_gap_s is " + Rounded(options.max_gap_s) + "; it must be from 0 to 10 s"};
  }
  if (options.lowpass_hz != 0.0 &&
      !(options.lowpass_hz >= kSlowestCutoff && options.lowpass_hz <= 1e4)) {
    return Error{"--lowpass_hz is " + Rounded(options.lowpass_hz) +
                 "; it must be a cut-off of at least " + Rounded(kSlowestCutoff) +
                 " Hz (a lower one removes the push), or 0 for none"};
  }
  if (options.resample_fps != 0.0 && !IsRate(options.resample_fps)) {
    return Error{"--resample_fps is " + Rounded(options.resample_fps) +
                 "; it must be from 1 to 10000 frames per second, or 0 for the recording's own"};
  }
  return std::nullopt;
}

MaybeError PrepareMotion(const PreparationOptions& options, Recording* recording) {
  const double from = recording->fps, to = options.resample_fps;
  if (options.lowpass_hz > 0.0) {
    const double highest = HighestCutoff(from);
    if (options.lowpass_hz >= highest) {
      return Error{"--lowpass_hz=" + Rounded(options.lowpass_hz) + " is too high for its rate of " +
                   Rounded(from) + " frames per second: it must be below " + Rounded(highest, 3) +
                   " Hz"};
    }
    for (RecordedPerson& person : recording->people) {
      ForEachTrack(&person, [&](Track* track) { LowPass(options.lowpass_hz, from, track); });
    }
  }
  if (to == 0.0 || to == from) return std::nullopt;
  if (to < kNearlyAsFast * from && !(options.lowpass_hz > 0.0 && options.lowpass_hz <= 0.5 * to)) {
    return Error{"--resample_fps=" + Rounded(to) + " is below its " + Rounded(from) +
                 " frames per second: faster movements would be aliased; pass --lowpass_hz=" +
                 Rounded(to / 4.0, 3) + " or another cut-off of at most half the new rate"};
  }
  if (ResampledFrames(recording->num_frames(), from, to) < 3) {
    return Error{"fewer than three frames are left at --resample_fps=" + Rounded(to)};
  }
  for (RecordedPerson& person : recording->people) {
    ForEachTrack(&person, [&](Track* track) { *track = ResampleTrack(*track, from, to); });
    if (!person.weight.empty()) person.weight = ResampleWeights(person.weight, from, to);
  }
  for (Push& push : recording->pushes) {
    push = ResamplePush(push, from, to);
    // A push that ends with the motion may reach into a frame that is not there any more.
    const int room = recording->num_frames() - push.start_frame;
    if (static_cast<int>(push.force.size()) > room) push.force.resize(std::max(room, 1));
  }
  recording->fps = to;
  return std::nullopt;
}

namespace {

constexpr double kShortestRod = 0.12, kLongestRod = 3.0;  // m; a small humanoid robot has 0.3
constexpr double kLargestLean = 1.0;                      // rad; beyond it the person has fallen
constexpr double kFarthest = 1e5;                         // m
constexpr int kFewestFrames = 3;                          // an acceleration takes three

constexpr double kShortestAdult = 0.5, kLongestAdult = 1.5;  // m, of rods

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
    const std::optional<LengthUnit> likely =
        UnitThatGives(length / metres_per_unit, kShortestAdult, kLongestAdult);
    return Error{
        "the hip is " + Rounded(length, 3) + " m high above the ankles when lengths are read as " +
            LengthText(metres_per_unit) + ": " +
            (likely ? "looks like " + NameOf(*likely) + ", pass --length_unit=" + NameOf(*likely)
                    : "check the unit (--length_unit) and the joints chosen; give odd "
                      "units in metres (--length_scale)"),
        person.file, 0};
  }
  const double lean = std::acos(std::fmin(1.0, std::fmax(-1.0, rod.z() / length)));
  if (lean > kLargestLean) {
    return Error{"at frame 0 the line from the ankles to the hip leans " +
                     Rounded(lean * 180.0 / 3.14159265358979323846, 3) +
                     " degrees from up: if the file's vertical axis is another, set \"up\" and "
                     "\"forward\" in the manifest; otherwise check \"joints\"",
                 person.file, 0};
  }
  if (MaybeError failed = CheckTrack(person, "hip", person.hip)) return failed;
  if (MaybeError failed = CheckTrack(person, "left ankle", person.left_ankle)) return failed;
  return CheckTrack(person, "right ankle", person.right_ankle);
}

}  // namespace pushid
