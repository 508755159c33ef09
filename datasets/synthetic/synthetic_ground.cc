// datasets: ground of synthetic recordings, and the platforms on it.
#include <algorithm>
#include <cmath>

#include "datasets/synthetic/synthetic_recordings.h"

namespace pushid {
namespace {

constexpr double kStepStart = 0.3, kStepSeconds = 0.4;       // s
constexpr double kSine = 0.5;                                // Hz
constexpr double kSines[] = {0.15, 0.35, 0.65, 1.05, 1.55};  // Hz

// From 0 to 1 with velocity and acceleration zero at both ends (minimum jerk).
double Smooth(double u) {
  const double v = std::clamp(u, 0.0, 1.0);
  return v * v * v * (10.0 - 15.0 * v + 6.0 * v * v);
}

}  // namespace

std::vector<GroundPose> SyntheticGround(GroundKind kind, double size, int frames, double dt,
                                        const Eigen::Vector2d& along) {
  std::vector<GroundPose> poses(frames, GroundPose::Zero());
  for (int t = 0; t < frames; ++t) {
    const double s = t * dt;
    double shift = 0.0;
    if (kind == GroundKind::kStep) shift = Smooth((s - kStepStart) / kStepSeconds);
    if (kind == GroundKind::kSine) shift = Smooth(s) * std::sin(2.0 * M_PI * kSine * s);
    if (kind == GroundKind::kSumOfSines) {
      for (double f : kSines) shift += Smooth(s) * std::sin(2.0 * M_PI * f * s);
    }
    poses[t].head<2>() = size * shift * along;
  }
  return poses;
}

}  // namespace pushid
