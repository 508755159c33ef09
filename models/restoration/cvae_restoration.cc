// models: the autoregressive chain without any automatic differentiation.
#include "models/restoration/cvae_restoration.h"

#include <algorithm>

namespace pushid {

std::vector<BodyMotion> CvaeRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  const int n = static_cast<int>(people.size());
  std::vector<RestorationInput> at_rate;
  std::vector<Eigen::MatrixXf> pendulums;
  std::vector<BodyFrames> frames;
  Eigen::MatrixXf lower(kLowerFrame, n), upper(kUpperFrame, n), pendulum(kPendulumFrame, n);
  int longest = 0;
  for (int i = 0; i < n; ++i) {
    at_rate.push_back(Resampled(people[i], 1.0 / kCvaeRate));
    pendulums.push_back(weights_.pendulum.Scaled(PendulumFrames(at_rate[i])));
    const int count = static_cast<int>(pendulums[i].cols());
    const BodyFrames first = FramesOf(at_rate[i], {people[i].first_pose}, coordinates_);
    lower.col(i) = weights_.lower.Scaled(first.lower);
    upper.col(i) = weights_.upper.Scaled(first.upper);
    frames.push_back({Eigen::MatrixXf(kLowerFrame, count), Eigen::MatrixXf(kUpperFrame, count)});
    longest = std::max(longest, count);
  }
  for (int t = 0; t < longest; ++t) {
    if (t > 0) {
      for (int i = 0; i < n; ++i) {
        pendulum.col(i) = pendulums[i].col(std::min<Eigen::Index>(t, pendulums[i].cols() - 1));
      }
      StepLower(weights_, pendulum, &lower);
      StepUpper(weights_, pendulum, lower, &upper);
    }
    for (int i = 0; i < n; ++i) {
      if (t >= frames[i].lower.cols()) continue;
      frames[i].lower.col(t) = weights_.lower.Unscaled(lower.col(i));
      frames[i].upper.col(t) = weights_.upper.Unscaled(upper.col(i));
    }
  }
  std::vector<BodyMotion> motions;
  for (int i = 0; i < n; ++i) {
    const BodyMotion motion = MotionFromFrames(at_rate[i], frames[i], coordinates_);
    motions.push_back(
        Resampled(motion, 1.0 / kCvaeRate, people[i].dt, static_cast<int>(people[i].q.size())));
  }
  return motions;
}

}  // namespace pushid
