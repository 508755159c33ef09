#include "ident/push/push_estimation.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "datasets/loading/motion_tracks.h"
#include "models/decompositions.h"
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
                           const PendulumRecording& recording, double margin, bool empty) {
  const double zero = sensor.start_s.value_or(0.0);
  const double end = zero + (recording.num_frames() - 1) * recording.scene.dt;
  const Vector3<double> before = Impulse(record, record.time_s.front(), zero - margin);
  const Vector3<double> after = Impulse(record, end + margin, record.time_s.back());
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
constexpr double kOddGain = 3.0;     // beyond what friction and recovery blur
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

// A sensor, with what the motion's file says of it, and what it measured.
struct ReadSensorOf {
  SensorChoice choice;
  SensorRecord record;
};

// The clock at frame 0 of a sensor in a file of its own, when nothing is said of it: the motion's,
// where the record holds at least half of the recording by it; otherwise both began at once. So a
// motion that is cut (first_frame) keeps its push.
double ClockBeside(const SensorRecord& record, const RecordedPerson& person, double seconds) {
  const double begin = person.file_clock_s, end = begin + seconds;
  const double shared =
      std::min(end, record.time_s.back()) - std::max(begin, record.time_s.front());
  return shared >= 0.5 * seconds ? begin : record.time_s.front() + person.skipped_s;
}

Result<std::vector<ReadSensorOf>> ReadAll(const SensorSetup& setup, const Recording& recorded,
                                          int person, SensorPush* result) {
  std::vector<ReadSensorOf> read;
  const std::size_t count = setup.sensors.size();
  result->how =
      count == 1 ? "from the sensor, averaged over the frames"
                 : "from " + std::to_string(count) + " sensors together, averaged over the frames";
  for (SensorChoice sensor : setup.sensors) {
    const bool said = sensor.start_s.has_value();
    for (const RecordedPerson& one : recorded.people) FillFromMotion(one, &sensor);
    Result<SensorRecord> record = ReadSensor(sensor, &result->warnings);
    if (!record.ok()) return record.error();
    const bool together = sensor.start_s.has_value();
    if (!together) {
      sensor.start_s = ClockBeside(record.value(), recorded.people[person],
                                   (recorded.num_frames() - 1) / recorded.fps);
    }
    if (!said && (together || *sensor.start_s != 0.0)) {
      result->how += std::string(together ? "; recorded with the motion, its clock"
                                          : "; by the motion's times, its clock") +
                     " at frame 0 is " + Rounded(*sensor.start_s, 4) + " s" +
                     (together ? "" : " (--sensor_start changes it)");
    }
    const Vector3<double>& rest = record.value().subtracted;
    if (rest.norm() > 0.0) {
      const double size = record.value().is_vector ? rest.norm() : rest.x();
      result->how += "; " + Rounded(size, 3) +
                     " N before the pull subtracted (zero: 0, "
                     "in a list of sensors, keeps them)";
    }
    read.push_back({sensor, std::move(record.value())});
  }
  return read;
}

// The error of an estimated offset: that of noise, and half a frame, which its fit cannot tell.
double ClockError(const SensorOffset& offset, const PendulumRecording& recording) {
  return 0.5 * recording.scene.dt + 2.0 * offset.standard_error_s;
}

// Offset of the sensors' clocks by the motion; zero unless it is asked for and the motion does not
// contradict it.
Result<SensorOffset> Offset(const SensorSetup& setup, const std::vector<ReadSensorOf>& read,
                            const PendulumRecording& recording, int person, SensorPush* result) {
  if (!setup.estimate_offset) return SensorOffset();
  std::vector<TimedRecord> timed;
  for (const auto& [sensor, record] : read) {
    // Vectors along the direction, as PushFromSensor makes them.
    timed.push_back({record, sensor.start_s.value_or(0.0)});
    if (record.is_vector) continue;
    for (Eigen::Vector3d& force : timed.back().record.force) {
      force = force.x() * sensor.direction.normalized();
    }
  }
  Result<SensorOffset> offset = EstimateSensorOffset(timed, recording, person);
  if (!offset.ok()) return offset;
  const double gain = offset.value().gain;
  if (gain < 1.0 / kOddGain || gain > kOddGain) {
    result->warnings.push_back("the motion fits best with " + Rounded(gain, 2) +
                               " times the force: check its unit and gain, and the mass");
  }
  const std::string estimate = Rounded(offset.value().offset_s, 4) + " +- " +
                               Rounded(offset.value().standard_error_s, 2) + " s";
  if (std::abs(offset.value().offset_s) <= ClockError(offset.value(), recording)) {
    result->how += "; the clocks agree (offset by the motion " + estimate + "): not moved";
    offset.value().offset_s = 0.0;
  } else {
    result->how += "; clock at frame 0 moved by " + estimate + " (estimated)";
  }
  return offset;
}

using Eigen::VectorXd;

constexpr double kAfterPush = 0.4;  // s of motion behind the push's end that take part
constexpr int kFewestFrames = 12;
constexpr int kRefinements = 20;

// The first and second integral of a sensor's force along the direction, exact for linear
// interpolation.
class Integrals {
 public:
  Integrals(const TimedRecord& force, const Eigen::Vector2d& direction)
      : zero_(force.frame_zero_time_s), time_(force.record.time_s) {
    for (const Eigen::Vector3d& f : force.record.force) {
      force_.push_back(f.head<2>().dot(direction));
    }
    integrals_.emplace_back(0.0, 0.0);
    for (std::size_t i = 1; i < time_.size(); ++i) {
      integrals_.push_back(Within(i - 1, time_[i] - time_[i - 1]));
    }
  }

  // (once, twice) at a time of the cameras plus the offset.
  Eigen::Vector2d At(double t) const {
    t += zero_;
    if (t <= time_.front()) return Eigen::Vector2d::Zero();
    const Eigen::Vector2d& last = integrals_.back();
    if (t >= time_.back()) return {last[0], last[1] + last[0] * (t - time_.back())};
    const std::size_t i = std::upper_bound(time_.begin(), time_.end(), t) - time_.begin() - 1;
    return Within(i, t - time_[i]);
  }

 private:
  // h behind sample i, within its interval.
  Eigen::Vector2d Within(std::size_t i, double h) const {
    const double slope = (force_[i + 1] - force_[i]) / (time_[i + 1] - time_[i]);
    const double once = integrals_[i][0], twice = integrals_[i][1];
    return {once + h * (force_[i] + 0.5 * h * slope),
            twice + h * (once + h * (0.5 * force_[i] + h * slope / 6.0))};
  }

  double zero_;
  const std::vector<double>& time_;
  std::vector<double> force_;
  std::vector<Eigen::Vector2d> integrals_;  // up to each sample
};

class OffsetFit {
 public:
  OffsetFit(const std::vector<TimedRecord>& forces, const PendulumRecording& recording, int person,
            const Eigen::Vector2d& direction, int frames)
      : dt_(recording.scene.dt), mass_(recording.scene.people[person].body.mass) {
    for (const TimedRecord& force : forces) integrals_.emplace_back(force, direction);
    regressors_.resize(frames, 4);
    target_.resize(frames);
    weight_.resize(frames);
    double lean_once = 0.0, lean_twice = 0.0, way = 0.0, lean_before = 0.0, x_before = 0.0;
    double lean_zero = 0.0, x_zero = 0.0;
    for (int t = 0; t < frames; ++t) {
      const double x = recording.states[person][t].q.head<2>().dot(direction);
      const double hip = recording.hip[person][t].head<2>().dot(direction);
      if (t == 0) lean_zero = hip - x, x_zero = x;
      const double lean = hip - x - lean_zero, moved = x - x_zero;
      if (t > 0) {  // trapezoids
        const double once = lean_once + 0.5 * dt_ * (lean + lean_before);
        lean_twice += 0.5 * dt_ * (once + lean_once);
        lean_once = once;
        way += 0.5 * dt_ * (moved + x_before);
      }
      lean_before = lean;
      x_before = moved;
      weight_[t] = recording.Weight(person, t);
      regressors_.row(t) << 1.0, t * dt_, lean_twice, way;
      target_[t] = 0.9 * hip + 0.1 * x;
    }
    pseudo_inverse_ = PseudoInverse(weight_.asDiagonal() * regressors_);
  }

  // Residuals after the linear parameters; the derivative is by tau, with them following.
  VectorXd Residual(double tau, VectorXd* derivative = nullptr) const {
    const Eigen::MatrixX2d moved = ByTheForce(tau);
    if (derivative != nullptr) *derivative = Projected(-moved.col(0));
    return Projected(target_ - moved.col(1));
  }

  // The multiple of the force that would leave least.
  double Gain(double tau) const {
    const VectorXd along = Projected(ByTheForce(tau).col(1));
    return along.dot(Projected(target_)) / along.squaredNorm();
  }

  double Count() const { return weight_.squaredNorm(); }

 private:
  // Velocity and way that the force alone would have given the person, by frame.
  Eigen::MatrixX2d ByTheForce(double tau) const {
    Eigen::MatrixX2d moved(target_.size(), 2);
    for (int t = 0; t < target_.size(); ++t) {
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (const Integrals& integral : integrals_) sum += integral.At(t * dt_ + tau);
      moved.row(t) = (sum / mass_).transpose();
    }
    return moved;
  }

  VectorXd Projected(const VectorXd& value) const {
    const VectorXd weighted = weight_.cwiseProduct(value);
    return weighted - weight_.asDiagonal() * (regressors_ * (pseudo_inverse_ * weighted));
  }

  double dt_, mass_;
  std::vector<Integrals> integrals_;
  VectorXd target_, weight_;
  Eigen::MatrixXd regressors_, pseudo_inverse_;
};

// The time at which 99 % of the force's impulse has passed, on the cameras' clock; the net
// direction.
double PushEnd(const std::vector<TimedRecord>& forces, Eigen::Vector2d* direction) {
  double end = 0.0;
  Eigen::Vector2d impulse = Eigen::Vector2d::Zero();
  for (const TimedRecord& force : forces) {
    const SensorRecord& r = force.record;
    double total = 0.0, sum = 0.0;
    const auto size = [&r](std::size_t i) {
      return (r.time_s[i] - r.time_s[i - 1]) * r.force[i].head<2>().norm();
    };
    for (std::size_t i = 1; i < r.time_s.size(); ++i) {
      total += size(i);
      impulse += (r.time_s[i] - r.time_s[i - 1]) * r.force[i].head<2>();
    }
    for (std::size_t i = 1; i < r.time_s.size() && sum < 0.99 * total; ++i) {
      sum += size(i);
      if (sum >= 0.99 * total) end = std::max(end, r.time_s[i] - force.frame_zero_time_s);
    }
  }
  *direction = impulse.normalized();
  return impulse.norm() > 0.0 ? end : -1.0;
}

// The way back after a push would otherwise do for a push the other way.
bool MovesAgainst(const std::vector<Vector3<double>>& hip, int frames,
                  const Eigen::Vector2d& direction) {
  double forth = 0.0, back = 0.0;
  for (int t = 0; t < frames; ++t) {
    const double way = (hip[t] - hip[0]).head<2>().dot(direction);
    forth = std::max(forth, way);
    back = std::max(back, -way);
  }
  return back > forth;
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
                            const PendulumRecording& recording, int person, double clock_error_s) {
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
  if (MaybeError error = CheckPushInside(record, sensor, recording, clock_error_s, empty)) {
    return *error;
  }
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

Result<SensorPush> PushFromSensors(const SensorSetup& setup, const Recording& recorded,
                                   const PendulumRecording& recording, int person) {
  if (MaybeError error = CheckPerson(recording, person)) return *error;
  SensorPush result;
  Result<std::vector<ReadSensorOf>> read = ReadAll(setup, recorded, person, &result);
  if (!read.ok()) return read.error();
  const Result<SensorOffset> offset = Offset(setup, read.value(), recording, person, &result);
  if (!offset.ok()) return offset.error();
  const double clock_error_s = setup.estimate_offset ? ClockError(offset.value(), recording) : 0.0;
  for (auto& [sensor, record] : read.value()) {
    if (!sensor.height_m) sensor.height_m = record.height_m;
    sensor.start_s = sensor.start_s.value_or(0.0) + offset.value().offset_s;
    if (!(sensor.idle_force > 0.0)) {  // the mean over a frame that noise at rest makes
      const double span = record.time_s.back() - record.time_s.front();
      const double step = span / (record.num_samples() - 1);
      sensor.idle_force =
          kNoisePeaks * record.noise * std::sqrt(std::min(1.0, step / recording.scene.dt));
    }
    if (!sensor.height_m && sensor.height_fraction == SensorChoice{}.height_fraction) {
      result.how += "; contact at the hip's height (--height changes it)";
    }
    const Result<Push> push = PushFromSensor(record, sensor, recording, person, clock_error_s);
    if (!push.ok()) return push.error();
    for (const std::string& doubt : {CutShort(record), ClippedText(record)}) {
      if (!doubt.empty()) result.warnings.push_back(doubt);
    }
    if (record.height_m && *record.height_m < 0.1) {
      result.warnings.push_back(sensor.file + ": " + sensor.column +
                                " lies on the floor: it measures the ground reaction force of the "
                                "person standing there, not a push");
    }
    AddPush(push.value(), &result.push);
  }
  return result;
}

Result<SensorOffset> EstimateSensorOffset(const std::vector<TimedRecord>& forces,
                                          const PendulumRecording& recording, int person,
                                          double max_offset_s) {
  if (MaybeError error = CheckPerson(recording, person)) return *error;
  if (!(max_offset_s > 0.0 && max_offset_s <= 60.0)) {
    return Error{"the largest offset must be above 0 and at most 60 s"};
  }
  Eigen::Vector2d direction;
  const double end = PushEnd(forces, &direction);
  if (forces.empty() || end < -0.5)
    return Error{"there is no horizontal force whose time could be found"};
  const double dt = recording.scene.dt;
  const int frames = std::min(recording.num_frames(),
                              static_cast<int>(std::ceil((end + max_offset_s + kAfterPush) / dt)));
  if (frames < kFewestFrames) {
    return Error{"recording " + recording.id + ": the push ends too early to find its time"};
  }
  if (recording.StepsKnown() && !recording.steps[person].Moved()) {
    return Error{
        "recording " + recording.id +
        ": the feet do not move, and how a person who stands gives way does not tell the "
        "sensor's time; give it (--sensor_start), or leave --estimate_offset out where the "
        "clocks agree"};
  }
  if (MovesAgainst(recording.hip[person], frames, direction)) {
    return Error{"recording " + recording.id +
                 ": the person moves against the force; its sign or its direction is wrong"};
  }
  const OffsetFit fit(forces, recording, person, direction, frames);
  const int steps = std::max(4, static_cast<int>(std::ceil(4.0 * max_offset_s / dt)));
  int best = 0;
  double least = 0.0;
  for (int i = -steps; i <= steps; ++i) {
    const double cost = fit.Residual(i * max_offset_s / steps).squaredNorm();
    if (i == -steps || cost < least) least = cost, best = i;
  }
  if (best == -steps || best == steps) {
    return Error{"recording " + recording.id + ": force and motion do not fit together within " +
                 Rounded(max_offset_s) + " s; give the sensor's time at frame 0"};
  }
  SensorOffset result;
  result.offset_s = best * max_offset_s / steps;
  VectorXd slope, residual;
  for (int i = 0; i < kRefinements; ++i) {
    residual = fit.Residual(result.offset_s, &slope);
    const double step = -slope.dot(residual) / slope.squaredNorm();
    if (!std::isfinite(step)) return Error{"the force does not move the person"};
    result.offset_s += std::clamp(step, -dt, dt);
    if (std::fabs(step) < 1e-9) break;
  }
  residual = fit.Residual(result.offset_s, &slope);
  const double n = fit.Count(), variance = residual.squaredNorm() / std::max(1.0, n - 5.0);
  const double after = residual.head(frames - 1).dot(residual.tail(frames - 1));
  const double r = std::clamp(after / std::max(residual.squaredNorm(), 1e-300), 0.0, 0.99);
  result.standard_error_s = std::sqrt(variance / slope.squaredNorm() * (1.0 + r) / (1.0 - r));
  result.gain = fit.Gain(result.offset_s);
  if (!(result.standard_error_s <= 0.25 * max_offset_s)) {
    return Error{"recording " + recording.id +
                 ": the sensor's time cannot be found from the motion (" +
                 Rounded(result.offset_s, 3) + " +- " + Rounded(result.standard_error_s, 2) +
                 " s); is the force in N?"};
  }
  return result;
}

}  // namespace pushid
