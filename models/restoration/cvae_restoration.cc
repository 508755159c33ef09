// models: the autoregressive chain without any automatic differentiation.
#include "models/restoration/cvae_restoration.h"

#include <algorithm>

namespace pushid {
namespace {

// No rows without a pendulum; a column per frame all the same.
Eigen::MatrixXf ScaledPendulum(const CvaeWeights& weights, const RestorationInput& person) {
  const Eigen::MatrixXf frames = PendulumFrames(person, weights.layout);
  return weights.layout.pendulum ? weights.pendulum.Scaled(frames) : frames;
}

}  // namespace

std::vector<BodyMotion> CvaeRestoration::Restore(
    const std::vector<RestorationInput>& people) const {
  const int n = static_cast<int>(people.size());
  std::vector<RestorationInput> at_rate;
  std::vector<Eigen::MatrixXf> pendulums;
  std::vector<BodyFrames> frames;
  const CvaeLayout& layout = weights_.layout;
  Eigen::MatrixXf lower(layout.LowerFrame(), n), upper(layout.UpperFrame(), n);
  Eigen::MatrixXf pendulum(layout.PendulumFrame(), n),
      draws(kLatent, layout.pendulum ? 0 : kCvaeDraws);
  int longest = 0;
  for (int i = 0; i < n; ++i) {
    at_rate.push_back(Resampled(people[i], 1.0 / kCvaeRate));
    pendulums.push_back(ScaledPendulum(weights_, at_rate[i]));
    const int count = static_cast<int>(pendulums[i].cols());
    const BodyFrames first = FramesOf(at_rate[i], {people[i].first_pose}, layout);
    lower.col(i) = weights_.lower.Scaled(first.lower);
    if (layout.halves) upper.col(i) = weights_.upper.Scaled(first.upper);
    frames.push_back(
        {Eigen::MatrixXf(layout.LowerFrame(), count), Eigen::MatrixXf(layout.UpperFrame(), count)});
    longest = std::max(longest, count);
  }
  const NormalSource normal = layout.pendulum ? nullptr : draws_();
  for (int t = 0; t < longest; ++t) {
    if (t > 0) {
      for (int i = 0; i < n; ++i) {
        pendulum.col(i) = pendulums[i].col(std::min<Eigen::Index>(t, pendulums[i].cols() - 1));
      }
      for (float& z : draws.reshaped()) z = static_cast<float>(normal());
      StepLower(weights_, pendulum, draws, &lower);
      StepUpper(weights_, pendulum, draws, lower, &upper);
    }
    for (int i = 0; i < n; ++i) {
      if (t >= frames[i].lower.cols()) continue;
      frames[i].lower.col(t) = weights_.lower.Unscaled(lower.col(i));
      if (layout.halves) frames[i].upper.col(t) = weights_.upper.Unscaled(upper.col(i));
    }
  }
  std::vector<BodyMotion> motions;
  for (int i = 0; i < n; ++i) {
    const BodyMotion motion = MotionFromFrames(at_rate[i], frames[i], layout);
    motions.push_back(
        Resampled(motion, 1.0 / kCvaeRate, people[i].dt, static_cast<int>(people[i].q.size())));
  }
  return motions;
}

}  // namespace pushid
