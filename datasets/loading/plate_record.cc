// datasets: platforms sampled at the frames of the motion, and held against who stands on them.
#include "datasets/loading/plate_record.h"

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/formats/motion_formats.h"
#include "datasets/loading/motion_preparation.h"
#include "datasets/sensors/force_platform.h"
#include "datasets/sensors/sensor_choice.h"
#include "models/ipm.h"

namespace pushid {
namespace {

MaybeError CheckWeight(const std::string& file, const RecordedPerson& person) {
  double vertical = 0.0;
  int seen = 0;
  for (const PlateSample& sample : person.plates) {
    if (sample.weight <= 0.0) continue;
    vertical += sample.force.z();
    ++seen;
  }
  if (seen == 0) {
    return Error{"the platforms are pressed with less than " + Rounded(kPressed) +
                     " N at every frame; are up and forward right, and the platforms named?",
                 file};
  }
  vertical /= seen;
  const double weight = person.mass_kg * kGravity;
  if (std::abs(vertical / weight - 1.0) <= kWeightTolerance) return std::nullopt;
  return Error{"the mean vertical force is " + Rounded(vertical, 4) + " N, but " +
                   Rounded(person.mass_kg, 4) + " kg weigh " + Rounded(weight, 4) + " N (" +
                   Rounded(100.0 * (vertical / weight - 1.0), 2) +
                   " %): correct mass_kg, the platform's gain or axes, or name the platform under "
                   "the other foot (\"plates\")",
               file};
}

double MeanDistance(const std::vector<PlateSample>& plates, const RecordedPerson& person) {
  double sum = 0.0;
  int seen = 0;
  for (size_t t = 0; t < plates.size() && t < person.left_ankle.size(); ++t) {
    if (plates[t].weight <= 0.0) continue;
    sum +=
        (plates[t].centre - 0.5 * (person.left_ankle[t] + person.right_ankle[t])).head<2>().norm();
    ++seen;
  }
  return sum / std::max(1, seen);
}

// Of several people, the one who is named stands nearest to where the platforms are pressed.
MaybeError CheckPerson(const std::string& file, const Recording& recording, int named) {
  const std::vector<PlateSample>& plates = recording.people[named].plates;
  const double own = MeanDistance(plates, recording.people[named]);
  for (size_t n = 0; n < recording.people.size(); ++n) {
    const double other = MeanDistance(plates, recording.people[n]);
    if (other >= own) continue;
    return Error{"the centre of pressure is " + Rounded(own, 2) + " m from the ankles of person " +
                     std::to_string(named) + " (" + recording.people[named].subject_id + "), but " +
                     Rounded(other, 2) + " m from those of person " + std::to_string(n) + " (" +
                     recording.people[n].subject_id +
                     "); give force_plates the right \"person\", or name their platforms "
                     "(\"plates\")",
                 file};
  }
  return std::nullopt;
}

MaybeError CheckCentre(const PlateTracks& tracks, const RecordedPerson& person) {
  int far = 0, seen = 0;
  for (size_t t = 0; t < person.plates.size() && t < person.left_ankle.size(); ++t) {
    if (person.plates[t].weight <= 0.0) continue;
    const Eigen::Vector3d feet = 0.5 * (person.left_ankle[t] + person.right_ankle[t]);
    far += (person.plates[t].centre - feet).head<2>().norm() > kFarFromFeet;
    ++seen;
  }
  if (2 * far <= seen) return std::nullopt;
  return Error{"the centre of pressure is " + Rounded(MeanDistance(person.plates, person), 2) +
                   " m from the ankles on average: platforms and markers must share their origin "
                   "and axes (up, forward), and centres must be in metres",
               tracks.file};
}

// The tracks' clock at frame 0, and that they last as long as the motion from there.
Result<double> PlatesStart(const PlateTracks& tracks, const ManifestPlates& plates,
                           const RecordedPerson& person, double fps, double seconds) {
  const bool of_motion = plates.file.empty() || tracks.file == person.file;
  const bool c3d = MotionFormatOfFile(tracks.file) == MotionFormat::kC3d;
  const double start =
      plates.start_s.value_or(of_motion && !c3d ? person.file_clock_s : person.skipped_s);
  const RecordTimes times = {
      "the platforms were recorded", tracks.first_s, tracks.last_s(), start, seconds, fps, 1.5};
  if (MaybeError error = CheckLasts(times, tracks.file, tracks.last_line)) return *std::move(error);
  return start;
}

// At the frames, from the tracks' time `start` on.
std::vector<PlateSample> SampledAt(const PlateTracks& tracks, double start, double fps,
                                   int frames) {
  std::vector<PlateSample> samples;
  for (int t = 0; t < frames; ++t) {
    const double at = (start + t / fps - tracks.first_s) * tracks.rate_hz;
    const Eigen::Vector3d moment = ValueBetween(tracks.moment, at);
    PlateSample sample;
    sample.force = ValueBetween(tracks.force, at);
    if (moment.z() >= kPressed) {
      sample.centre = {moment.x() / moment.z(), moment.y() / moment.z(), 0.0};
      sample.weight = 1.0;
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

MaybeError CheckPlates(const std::string& file, const Recording& recording, int person) {
  if (MaybeError error = CheckWeight(file, recording.people[person])) return error;
  return CheckPerson(file, recording, person);
}

MaybeError LoadPlates(const ManifestRecording& entry, const ManifestPlates& plates,
                      double lowpass_hz, Recording* recording) {
  if (plates.use == PlateUse::kNone) return std::nullopt;
  RecordedPerson& person = recording->people[plates.person];
  Result<PlateTracks> read = ReadPlates(entry, plates, person);
  if (!read.ok()) return read.error();
  PlateTracks& tracks = read.value();
  const double fps = recording->fps, seconds = (recording->num_frames() - 1) / fps;
  const Result<double> start = PlatesStart(tracks, plates, person, fps, seconds);
  if (!start.ok()) return start.error();
  double cutoff = plates.lowpass_hz > 0.0 ? plates.lowpass_hz : 0.4 * fps;
  if (lowpass_hz > 0.0) cutoff = std::min(cutoff, lowpass_hz);
  if (cutoff < HighestCutoff(tracks.rate_hz)) {
    LowPass(cutoff, tracks.rate_hz, &tracks.force);
    LowPass(cutoff, tracks.rate_hz, &tracks.moment);
  }
  person.plates = SampledAt(tracks, start.value(), fps, recording->num_frames());
  if (MaybeError error = CheckPlates(tracks.file, *recording, plates.person)) return error;
  // Of platforms alone the feet are not seen; on ground that moves they go with it.
  const bool feet_seen = recording->ground.empty() && !entry.plates_alone;
  return feet_seen ? CheckCentre(tracks, person) : std::nullopt;
}

}  // namespace pushid
