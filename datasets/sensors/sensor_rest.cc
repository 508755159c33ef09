// datasets: what a force sensor reads before the pull.
#include <algorithm>
#include <cmath>

#include "datasets/sensors/sensor_choice.h"

namespace pushid {
namespace {

constexpr double kLeastRest = 0.1;    // s before the pull
constexpr double kMargin = 0.02;      // s before it that do not count: it begins softly
constexpr double kPullBegins = 0.05;  // of the peak
constexpr double kNoiseOfPull = 5.0;  // standard deviations
constexpr double kLoad = 0.3;         // of the peak
constexpr double kSurely = 4.0;       // standard errors of the reading
constexpr double kWorthwhile = 1e-3;  // of the peak
constexpr int kFewestAtRest = 5, kSustained = 3;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median of the first samples, and the standard deviation about it of their largest component.
Eigen::Vector3d ReadingOf(const SensorRecord& record, int samples, double* noise) {
  Eigen::Vector3d reading;
  *noise = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (int i = 0; i < samples; ++i) values.push_back(record.force[i][axis]);
    reading[axis] = Median(values);
    double squares = 0.0;
    for (double value : values) squares += (value - reading[axis]) * (value - reading[axis]);
    *noise = std::max(*noise, std::sqrt(squares / samples));
  }
  return reading;
}

// The last sample before which nobody pulls, judged from a first guess of the reading.
int SamplesAtRest(const SensorRecord& record, const Eigen::Vector3d& guess, double noise,
                  double peak) {
  const double pull = std::max(kPullBegins * peak, kNoiseOfPull * noise);
  int sustained = 0;
  for (int i = 0; i < record.num_samples(); ++i) {
    sustained = (record.force[i] - guess).norm() > pull ? sustained + 1 : 0;
    if (sustained < kSustained) continue;
    const double until = record.time_s[i - kSustained + 1] - kMargin;
    return static_cast<int>(std::lower_bound(record.time_s.begin(), record.time_s.end(), until) -
                            record.time_s.begin());
  }
  return 0;
}

}  // namespace

void SubtractRest(SensorRecord* record) {
  const std::vector<double>& time = record->time_s;
  const auto first = static_cast<int>(
      std::upper_bound(time.begin(), time.end(), time.front() + kLeastRest) - time.begin());
  if (first < kFewestAtRest || first == record->num_samples()) return;
  double noise = 0.0, peak = 0.0;
  const Eigen::Vector3d guess = ReadingOf(*record, first, &noise);
  for (const Eigen::Vector3d& force : record->force) peak = std::max(peak, (force - guess).norm());
  const int samples = SamplesAtRest(*record, guess, noise, peak);
  if (samples < kFewestAtRest || time[samples - 1] - time[0] < kLeastRest - kMargin) return;
  const Eigen::Vector3d rest = ReadingOf(*record, samples, &noise);
  if (!(rest.norm() < kLoad * peak)) return;
  record->noise = noise;
  if (rest.norm() < std::max(kSurely * noise / std::sqrt(samples), kWorthwhile * peak)) return;
  record->subtracted = rest;
  for (Eigen::Vector3d& force : record->force) force -= rest;
}

}  // namespace pushid
