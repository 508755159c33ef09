// ident: from force samples to the rows of an external push.
#include "ident/push/push_from_sensor.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr double kNoise = 0.01;        // of the largest row: what no push ends with
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

Error Wrong(const PendulumRecording& recording, const std::string& what) {
  return Error{"recording " + recording.id + ": " + what};
}

MaybeError CheckSensorOptions(const SensorRecord& record, const PendulumRecording& recording,
                              const SensorPushOptions& options) {
  if (options.person < 0 || options.person >= recording.num_people()) {
    return Wrong(recording, "there is no person " + std::to_string(options.person));
  }
  const double length = options.direction.norm();
  if (!record.is_vector && !(std::isfinite(length) && length > 0.0)) {
    return Error{"the push direction must be a finite vector other than zero"};
  }
  if (!std::isfinite(options.height_fraction) || !std::isfinite(options.height_m.value_or(0.0)) ||
      !std::isfinite(options.frame_zero_time_s)) {
    return Error{"contact height and the time of frame 0 must be finite numbers"};
  }
  if (record.num_samples() < 2) return Error{"the record has no force samples", record.file};
  return std::nullopt;
}

// A push that lies outside the recording, or is no greater than the idling. `empty`: no row holds
// more than that.
MaybeError CheckPushInside(const SensorRecord& record, const PendulumRecording& recording,
                           const SensorPushOptions& options, bool empty) {
  const double zero = options.frame_zero_time_s, margin = options.clock_error_s;
  const double end = zero + (recording.num_frames() - 1) * recording.scene.dt;
  const Vector3<double> before = Impulse(record, record.time_s.front(), zero - margin);
  const Vector3<double> after = Impulse(record, end + margin, record.time_s.back());
  const Vector3<double> inside = Impulse(record, zero, end);
  // An idling sensor adds up outside the recording; only what exceeds it is a lost push.
  const double span = record.time_s.back() - record.time_s.front();
  const double lost = before.norm() + after.norm() - options.idle_force * span;
  if (lost > kLostImpulse * inside.norm() || (empty && lost > 0.0)) {
    return Error{
        Rounded(lost) + " N s of the push lie outside recording " + recording.id + " (" +
            Rounded(inside.norm()) + " N s inside), whose frame 0 is at " + Rounded(zero) +
            " s of the sensor's clock; check that time, and what it reads at rest (--sensor_zero)",
        record.file};
  }
  if (!empty) return std::nullopt;
  return Error{"no force greater than " + Rounded(options.idle_force) + " N within recording " +
                   recording.id,
               record.file};
}

}  // namespace

double HeightFraction(const Body& body, const Vector4<double>& q, double height) {
  return (height - body.cart_height) / (body.rod_length * std::cos(q[2]) * std::cos(q[3]));
}

Result<Push> PushFromSensor(const SensorRecord& record, const PendulumRecording& recording,
                            const SensorPushOptions& options) {
  if (MaybeError error = CheckSensorOptions(record, recording, options)) return *error;
  // Row by row, then without the idle rows at both ends.
  const double dt = recording.scene.dt, zero = options.frame_zero_time_s;
  std::vector<Vector3<double>> rows;
  for (int t = 0; t + 1 < recording.num_frames(); ++t) {
    rows.push_back(Impulse(record, zero + (t - 0.5) * dt, zero + (t + 0.5) * dt) / dt);
  }
  double largest = 0.0;
  for (const Vector3<double>& row : rows) largest = std::max(largest, row.norm());
  const bool by_noise = options.idle_force < kNoise * largest;
  const double resting = by_noise ? kNoise * largest : options.idle_force;
  const auto idle = [resting](const Vector3<double>& row) { return !(row.norm() > resting); };
  auto first = std::find_if_not(rows.begin(), rows.end(), idle);
  auto last = std::find_if_not(rows.rbegin(), rows.rend(), idle).base();
  // A push may begin or end within a row, of which little is left.
  const auto some = [](const Vector3<double>& row) { return row.norm() > 0.0; };
  if (by_noise && first != rows.begin() && some(first[-1])) --first;
  if (by_noise && last != rows.end() && some(*last)) ++last;
  if (MaybeError error = CheckPushInside(record, recording, options, first == rows.end())) {
    return *error;
  }
  Push push;
  push.person = options.person;
  push.start_frame = static_cast<int>(first - rows.begin());
  push.file = record.file;
  const Body& body = recording.scene.people[options.person].body;
  const std::vector<PendulumState<double>>& states = recording.states[options.person];
  const double fraction = options.height_m
                              ? HeightFraction(body, states[push.start_frame].q, *options.height_m)
                              : options.height_fraction;
  const double length = options.direction.norm();
  for (auto row = first; row != last; ++row) {
    const Vector4<double>& q = states[row - rows.begin()].q;
    const Vector3<double> force =
        record.is_vector ? *row : Vector3<double>(row->x() / length * options.direction);
    push.force.push_back(GeneralizedForce(body, q, force, fraction));
  }
  return push;
}

}  // namespace pushid
