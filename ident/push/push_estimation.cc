#include "ident/push/push_estimation.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/loading/motion_tracks.h"
#include "models/rollout.h"
#include "models/skeleton_mapping.h"

namespace pushid {
namespace {

constexpr double kDetectionSpan = 0.15;  // s, smoothing of the hip for detection
constexpr int kSustained = 3;            // frames above the onset speed that make an onset
constexpr double kOnsetSpeed = 0.1;      // m/s, of a hip that counts as moving
constexpr double kEndFraction = 0.05;    // of the peak acceleration, below which a push is over

MaybeError CheckPerson(const PendulumRecording& recording, int person) {
  if (person >= 0 && person < recording.num_people()) return std::nullopt;
  return Error{"recording " + recording.id + ": there is no person " + std::to_string(person) +
               "; it has " + std::to_string(recording.num_people()) + ", counted from 0"};
}

MaybeError CheckEstimationOptions(const PendulumRecording& recording,
                                  const PushEstimationOptions& options) {
  if (MaybeError error = CheckPerson(recording, options.person)) return error;
  const int smoothing = options.smoothing_frames;
  if (smoothing != 0 && (smoothing < 5 || smoothing % 2 == 0)) {
    return Error{"a smoothing window of " + std::to_string(smoothing) +
                 " frames: must be 0 (none) or an odd number from 5"};
  }
  return {};
}

// Smoothed horizontal motion of the hip.
std::vector<SmoothedSample> SmoothedHip(const PendulumRecording& recording, int person) {
  std::vector<Eigen::Vector4d> hip;
  for (const Vector3<double>& p : recording.hip[person]) hip.emplace_back(p.x(), p.y(), 0.0, 0.0);
  const int half = static_cast<int>(std::lround(0.5 * kDetectionSpan / recording.scene.dt));
  return SavitzkyGolay(hip, std::max(5, 2 * half + 1), recording.scene.dt);
}

constexpr double kNoise = 0.01;        // of the largest row: smaller ones end no push
constexpr double kLostImpulse = 0.01;  // of the whole, tolerated outside the recording

// Integral of the samples' broken line from `from` to `to` (s), by the trapezoids in between.
Vector3<double> Impulse(const SensorRecord& record, double from, double to) {
  Vector3<double> sum = Vector3<double>::Zero();
  const std::vector<double>& time = record.time_s;
  // First sample interval that reaches beyond `from`.
  size_t i = std::upper_bound(time.begin(), time.end(), from) - time.begin();
  for (i = std::max<size_t>(i, 1); i < time.size() && time[i - 1] < to; ++i) {
    const double begin = std::max(from, time[i - 1]), end = std::min(to, time[i]);
    const double middle = 0.5 * (begin + end);
    const double share = (middle - time[i - 1]) / (time[i] - time[i - 1]);
    sum += (end - begin) * ((1.0 - share) * record.force[i - 1] + share * record.force[i]);
  }
  return sum;
}

// A push that lies outside the recording, or is no greater than the idling. `empty`: no row holds
// more than that.
MaybeError CheckPushInside(const SensorRecord& record, const SensorChoice& sensor,
                           const PendulumRecording& recording, bool empty) {
  const double zero = sensor.start_s.value_or(0.0);
  const double end = zero + (recording.num_frames() - 1) * recording.scene.dt;
  const Vector3<double> before = Impulse(record, record.time_s.front(), zero);
  const Vector3<double> after = Impulse(record, end, record.time_s.back());
  const Vector3<double> inside = Impulse(record, zero, end);
  // An idling sensor adds up outside the recording; only what exceeds it is a lost push.
  const double span = record.time_s.back() - record.time_s.front();
  const double lost = before.norm() + after.norm() - sensor.idle_force * span;
  if (lost > kLostImpulse * inside.norm() || (empty && lost > 0.0)) {
    return Error{
        Rounded(lost) + " N s of the push lie outside recording " + recording.id + " (" +
            Rounded(inside.norm()) + " N s inside), whose frame 0 is at " + Rounded(zero) +
            " s of the sensor's clock; check that time, and what it reads at rest (zero, in a "
            "list of sensors)",
        record.file};
  }
  if (!empty) return std::nullopt;
  return Error{
      "no force greater than " + Rounded(sensor.idle_force) + " N within recording " + recording.id,
      record.file};
}

constexpr double kCutShort = 0.2;    // of the peak
constexpr double kNoisePeaks = 4.0;  // standard deviations

// Rows of several pushes on one person, added frame by frame.
void AddPush(const Push& more, Push* sum) {
  if (sum->force.empty()) {
    *sum = more;
    return;
  }
  const int start = std::min(sum->start_frame, more.start_frame);
  const int end = std::max(sum->EndFrame(), more.EndFrame());
  std::vector<Eigen::Vector4d> force(end - start, Eigen::Vector4d::Zero());
  for (const Push* push : {static_cast<const Push*>(sum), &more}) {
    for (std::size_t i = 0; i < push->force.size(); ++i) {
      force[push->start_frame - start + i] += push->force[i];
    }
  }
  sum->force = std::move(force);
  sum->start_frame = start;
}

// A warning for a record that begins or ends while it measures a push: the rest of it is lost.
std::string CutShort(const SensorRecord& record) {
  double peak = 0.0;
  for (const Eigen::Vector3d& force : record.force) peak = std::max(peak, force.norm());
  for (const bool first : {true, false}) {
    const double force = (first ? record.force.front() : record.force.back()).norm();
    if (!(force > kCutShort * peak)) continue;
    return record.file + ": the record " + (first ? "begins" : "ends") + " with " +
           Rounded(force, 3) + " N, with a maximum of " + Rounded(peak, 3) +
           " N: part of the push is missing, or the sensor has an offset (zero, "
           "in a list of sensors)";
  }
  return "";
}

// The clock at frame 0 of a sensor in a file of its own, when nothing is said of it: the motion's,
// where the record holds at least half of the recording by it; otherwise both began at once. So a
// motion that is cut (first_frame) keeps its push.
double ClockBeside(const SensorRecord& record, const RecordedPerson& person, double seconds) {
  const double begin = person.file_clock_s, end = begin + seconds;
  const double shared =
      std::min(end, record.time_s.back()) - std::max(begin, record.time_s.front());
  return shared >= 0.5 * seconds ? begin : record.time_s.front() + person.skipped_s;
}

// Reads a sensor, with what the motion's file says of it; tells what was taken as known.
SensorRecord ReadBeside(const Recording& recorded, int person, SensorChoice* sensor,
                        SensorPush* result) {
  const bool said = sensor->start_s.has_value();
  for (const RecordedPerson& one : recorded.people) FillFromMotion(one, sensor);
  SensorRecord record = OrThrow(ReadSensor(*sensor, &result->warnings));
  const bool together = sensor->start_s.has_value();
  if (!together) {
    sensor->start_s =
        ClockBeside(record, recorded.people[person], (recorded.num_frames() - 1) / recorded.fps);
  }
  if (!said && (together || *sensor->start_s != 0.0)) {
    result->how += std::string(together ? "; recorded with the motion, its clock"
                                        : "; by the motion's times, its clock") +
                   " at frame 0 is " + Rounded(*sensor->start_s, 4) + " s" +
                   (together ? "" : " (--sensor_start changes it)");
  }
  const Vector3<double>& rest = record.subtracted;
  if (rest.norm() > 0.0) {
    result->how += "; " + Rounded(record.is_vector ? rest.norm() : rest.x(), 3) +
                   " N before the pull subtracted (zero: 0, in a list of sensors, keeps them)";
  }
  return record;
}

}  // namespace

Result<PushWindow> DetectPushWindow(const PendulumRecording& recording,
                                    const PushEstimationOptions& options, const PushWindow& given) {
  if (given.start >= 0 && given.end >= 0) return given;
  if (MaybeError wrong = CheckEstimationOptions(recording, options)) return *std::move(wrong);
  const std::vector<SmoothedSample> hip = SmoothedHip(recording, options.person);
  const int frames = recording.num_frames();
  const auto speed = [&](int t) { return hip[t].rate.norm(); };

  int onset = 0, above = 0;
  for (; onset < frames && above < kSustained; ++onset) {
    above = speed(onset) > kOnsetSpeed ? above + 1 : 0;
  }
  if (above < kSustained) {
    return Error{"recording " + recording.id + ": the hip of person " +
                 std::to_string(options.person) + " never moves faster than " +
                 std::to_string(kOnsetSpeed) +
                 " m/s for three frames, so no push is found; name the window"};
  }
  onset -= kSustained;
  PushWindow window;
  window.start = onset;
  while (window.start > 0 && speed(window.start - 1) < speed(window.start)) --window.start;

  // Along the way the person goes: mean direction of the first 0.15 s after the onset.
  const int later =
      std::min(frames - 1, onset + static_cast<int>(kDetectionSpan / recording.scene.dt));
  const Eigen::Vector4d way = (hip[later].value - hip[window.start].value).normalized();
  double peak = 0.0;
  for (window.end = window.start + 1; window.end < frames - 1; ++window.end) {
    const double acceleration = hip[window.end].acceleration.dot(way);
    peak = std::max(peak, acceleration);
    if (window.end > onset && acceleration <= kEndFraction * peak) break;
  }
  if (given.start >= 0) window.start = given.start;
  if (given.end >= 0) window.end = given.end;
  return window;
}

Result<EstimatedPush> EstimatePush(const PendulumRecording& recording, const PushWindow& window,
                                   const PushEstimationOptions& options) {
  if (MaybeError wrong = CheckEstimationOptions(recording, options)) return *std::move(wrong);
  const int frames = recording.num_frames();
  if (window.start < 0 || window.end <= window.start || window.end >= frames) {
    return Error{"recording " + recording.id + ": a push from frame " +
                 std::to_string(window.start) + " to " + std::to_string(window.end) +
                 " is not within its frames 0 to " + std::to_string(frames - 1)};
  }
  const double dt = recording.scene.dt;
  std::vector<PendulumState<double>> states = recording.states[options.person];
  if (options.smoothing_frames > 0) {
    std::vector<Eigen::Vector4d> q;
    for (const PendulumState<double>& state : states) q.push_back(state.q);
    const std::vector<SmoothedSample> smoothed = SavitzkyGolay(q, options.smoothing_frames, dt);
    for (int t = 0; t < frames; ++t) {
      states[t].q = smoothed[t].value;
      // The smoother's rate is not used: qd must be what an Euler step makes of q.
      if (t > 0) states[t].qd = (states[t].q - states[t - 1].q) / dt;
    }
  }
  if (window.start > 0 &&
      SmoothedHip(recording, options.person)[window.start].rate.norm() <= kOnsetSpeed) {
    states[window.start].qd.setZero();
  }

  EstimatedPush result;
  result.start_speed = states[window.start].qd.head<2>().norm();
  result.push.person = options.person;
  result.push.start_frame = window.start;
  const Body& body = recording.scene.people[options.person].body;
  for (int t = window.start; t <= window.end; ++t) {
    const PendulumState<double>& state = states[t];
    const std::string_view outside = OutsideDomain(body, state);
    if (!outside.empty()) {
      return Error{"recording " + recording.id + ": " + std::string(outside) + " at frame " +
                   std::to_string(t) + " is outside the model's domain of +-1.4 rad"};
    }
    result.motion.push_back(state);
    if (t == window.end) break;
    result.push.force.push_back(
        InverseDynamics<double>(body, state, (states[t + 1].qd - state.qd) / dt));
  }
  return result;
}

Result<Push> PushFromSensor(const SensorRecord& record, const SensorChoice& sensor,
                            const PendulumRecording& recording, int person) {
  if (MaybeError error = CheckPerson(recording, person)) return *error;
  const double zero = sensor.start_s.value_or(0.0), length = sensor.direction.norm();
  if (!record.is_vector && !(std::isfinite(length) && length > 0.0)) {
    return Error{"the push direction must be a finite vector other than zero"};
  }
  if (!std::isfinite(sensor.height_fraction + sensor.height_m.value_or(0.0) + zero)) {
    return Error{"contact height and the time of frame 0 must be finite numbers"};
  }
  if (record.num_samples() < 2) return Error{"the record has no force samples", record.file};
  // Row by row, then without the idle rows at both ends.
  const double dt = recording.scene.dt;
  std::vector<Vector3<double>> rows;
  for (int t = 0; t + 1 < recording.num_frames(); ++t) {
    rows.push_back(Impulse(record, zero + (t - 0.5) * dt, zero + (t + 0.5) * dt) / dt);
  }
  double largest = 0.0;
  for (const Vector3<double>& row : rows) largest = std::max(largest, row.norm());
  const bool by_noise = sensor.idle_force < kNoise * largest;
  const double resting = by_noise ? kNoise * largest : sensor.idle_force;
  const auto idle = [resting](const Vector3<double>& row) { return !(row.norm() > resting); };
  auto first = std::find_if_not(rows.begin(), rows.end(), idle);
  auto last = std::find_if_not(rows.rbegin(), rows.rend(), idle).base();
  // A push may begin or end within a row, of which little is left.
  const auto some = [](const Vector3<double>& row) { return row.norm() > 0.0; };
  if (by_noise && first != rows.begin() && some(first[-1])) --first;
  if (by_noise && last != rows.end() && some(*last)) ++last;
  const bool empty = first == rows.end();
  if (MaybeError error = CheckPushInside(record, sensor, recording, empty)) return *error;
  Push push;
  push.person = person;
  push.start_frame = static_cast<int>(first - rows.begin());
  push.file = record.file;
  const Body& body = recording.scene.people[person].body;
  const std::vector<PendulumState<double>>& states = recording.states[person];
  const double fraction = sensor.height_m
                              ? HeightFraction(body, states[push.start_frame].q, *sensor.height_m)
                              : sensor.height_fraction;
  for (auto row = first; row != last; ++row) {
    const Vector4<double>& q = states[row - rows.begin()].q;
    const Vector3<double> force =
        record.is_vector ? *row : Vector3<double>(row->x() / length * sensor.direction);
    push.force.push_back(GeneralizedForce(body, q, force, fraction));
  }
  return push;
}

Result<SensorPush> PushFromSensors(const std::vector<SensorChoice>& sensors,
                                   const Recording& recorded, const PendulumRecording& recording,
                                   int person) {
  return Caught([&] {
    OrThrow(CheckPerson(recording, person));
    SensorPush result;
    result.how = sensors.size() == 1 ? "from the sensor, averaged over the frames"
                                     : StrCat("from ", sensors.size(),
                                              " sensors together, averaged over the frames");
    std::vector<std::pair<SensorChoice, SensorRecord>> read;
    for (SensorChoice sensor : sensors) {
      SensorRecord record = ReadBeside(recorded, person, &sensor, &result);
      read.emplace_back(std::move(sensor), std::move(record));
    }
    for (auto& [sensor, record] : read) {
      if (!sensor.height_m) sensor.height_m = record.height_m;
      if (!(sensor.idle_force > 0.0)) {  // the mean over a frame that noise at rest makes
        const double span = record.time_s.back() - record.time_s.front();
        const double step = span / (record.num_samples() - 1);
        sensor.idle_force =
            kNoisePeaks * record.noise * std::sqrt(std::min(1.0, step / recording.scene.dt));
      }
      if (!sensor.height_m && sensor.height_fraction == SensorChoice{}.height_fraction) {
        result.how += "; contact at the hip's height (--height changes it)";
      }
      AddPush(OrThrow(PushFromSensor(record, sensor, recording, person)), &result.push);
      for (const std::string& doubt : {CutShort(record), ClippedText(record)}) {
        if (!doubt.empty()) result.warnings.push_back(doubt);
      }
      if (record.height_m && *record.height_m < 0.1) {
        result.warnings.push_back(sensor.file + ": " + sensor.column +
                                  " lies on the floor: it measures the ground reaction force of "
                                  "the person standing there, not a push");
      }
    }
    return result;
  });
}

}  // namespace pushid
