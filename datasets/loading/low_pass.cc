// datasets: the Butterworth filter, forwards and backwards.
#include "datasets/loading/low_pass.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

double TwoPassCorrection() { return std::pow(std::sqrt(2.0) - 1.0, 0.25); }

// y_i = b (x_i + 2 x_{i-1} + x_{i-2}) - a1 y_{i-1} - a2 y_{i-2}
struct Biquad {
  double b, a1, a2;
};

// Of which two passes have lost 3 dB at the cut-off.
Biquad Butterworth(double cutoff_hz, double rate_hz) {
  const double k = std::tan(kPi * cutoff_hz / rate_hz) / TwoPassCorrection();
  const double q = std::sqrt(2.0) * k;
  const double norm = 1.0 / (1.0 + q + k * k);
  return {k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - q + k * k) * norm};
}

// In place, from the steady state at the first value.
void Pass(const Biquad& filter, std::vector<Vector3d>* x) {
  Vector3d x1 = x->front(), x2 = x1, y1 = x1, y2 = x1;
  for (Vector3d& value : *x) {
    const Vector3d y = filter.b * (value + 2.0 * x1 + x2) - filter.a1 * y1 - filter.a2 * y2;
    x2 = x1;
    x1 = value;
    y2 = y1;
    y1 = y;
    value = y;
  }
}

}  // namespace

double HighestCutoff(double rate_hz) { return 0.499 * rate_hz; }

void LowPass(double cutoff_hz, double rate_hz, std::vector<Vector3d>* track) {
  const int frames = static_cast<int>(track->size());
  if (frames < 3) return;
  const Biquad filter = Butterworth(cutoff_hz, rate_hz);
  // Long enough for the filter to forget its start.
  const int wing = std::min(frames - 1, static_cast<int>(std::ceil(2.0 * rate_hz / cutoff_hz)));
  std::vector<Vector3d> x;
  x.reserve(frames + 2 * wing);
  const Vector3d first = track->front(), last = track->back();
  for (int i = wing; i > 0; --i) x.push_back(2.0 * first - (*track)[i]);
  x.insert(x.end(), track->begin(), track->end());
  for (int i = 1; i <= wing; ++i) x.push_back(2.0 * last - (*track)[frames - 1 - i]);
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  Pass(filter, &x);
  std::reverse(x.begin(), x.end());
  std::copy(x.begin() + wing, x.begin() + wing + frames, track->begin());
}

}  // namespace pushid
