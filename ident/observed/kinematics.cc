// ident: constant velocity, and a quadratic that fades.
#include "ident/observed/kinematics.h"

#include <algorithm>
#include <cmath>

#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr double kWindow = 14.0 / 60.0, kFading = 0.25, kDrag = 1.0;  // s, s and 1/s

struct Motion {
  Vector3<double> place, velocity, acceleration;
};

// At the last frame that was seen.
Motion FittedMotion(const SeenPath& path, int last, double dt) {
  const int window = std::max(3, static_cast<int>(std::lround(kWindow / dt)));
  std::vector<int> frames;
  for (int t = std::max(0, last - window + 1); t <= last; ++t) {
    if (path.seen[t] || t == 0) frames.push_back(t);
  }
  Motion motion{path.hip[last], Vector3<double>::Zero(), Vector3<double>::Zero()};
  const int order = std::min<int>(3, static_cast<int>(frames.size()));
  if (order < 2) return motion;
  Eigen::MatrixXd powers(frames.size(), order), places(frames.size(), 3);
  for (size_t i = 0; i < frames.size(); ++i) {
    const double s = (frames[i] - last) * dt;
    for (int j = 0; j < order; ++j) powers(i, j) = j == 0 ? 1.0 : j == 1 ? s : 0.5 * s * s;
    places.row(i) = path.hip[frames[i]].transpose();
  }
  const Eigen::MatrixXd fitted = SolveSymmetric(Eigen::MatrixXd(powers.transpose() * powers),
                                                Eigen::MatrixXd(powers.transpose() * places));
  motion.velocity = fitted.row(1).transpose();
  if (order > 2) motion.acceleration = fitted.row(2).transpose();
  return motion;
}

// frames_ahead places after the last frame there is, from a motion at an earlier one.
template <typename Step>
HipPath Continued(Motion motion, int frames_before, int frames_ahead, const Step& step) {
  HipPath ahead;
  for (int t = 0; t < frames_before + frames_ahead; ++t) {
    step(&motion);
    if (t >= frames_before) ahead.push_back(motion.place);
  }
  return ahead;
}

}  // namespace

int LastSeen(const SeenPath& path) {
  int last = static_cast<int>(path.hip.size()) - 1;
  while (last > 0 && !path.seen[last]) --last;
  return last;
}

HipPath GoesOn(const SeenPath& path, double seconds, double dt, int frames_ahead) {
  const int last = LastSeen(path);
  int before = std::max(0, last - std::max(1, static_cast<int>(std::lround(seconds / dt))));
  while (before > 0 && !path.seen[before]) --before;
  Motion motion{path.hip[last], Vector3<double>::Zero(), Vector3<double>::Zero()};
  if (last > before) motion.velocity = (path.hip[last] - path.hip[before]) / ((last - before) * dt);
  return Continued(motion, static_cast<int>(path.hip.size()) - 1 - last, frames_ahead,
                   [dt](Motion* m) { m->place += dt * m->velocity; });
}

HipPath GoesOnAccelerating(const SeenPath& path, double dt, int frames_ahead) {
  const int last = LastSeen(path);
  return Continued(FittedMotion(path, last, dt), static_cast<int>(path.hip.size()) - 1 - last,
                   frames_ahead, [dt](Motion* m) {
                     m->velocity += dt * (m->acceleration - kDrag * m->velocity);
                     m->acceleration *= std::exp(-dt / kFading);
                     m->place += dt * m->velocity;
                   });
}

}  // namespace pushid
