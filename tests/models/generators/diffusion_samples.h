// Groups who are pushed, and diffusion networks of random weights, for tests.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "models/generators/diffusion_generator.h"
#include "tests/models/body_samples.h"

namespace pushid {

// `people` in a line 0.6 m apart; the first is pushed for 6 frames, and each goes forwards, later
// than the one behind, arms swinging.
inline std::vector<ObservedMotion> PushedGroup(int people, int frames, float push = 4.0f) {
  std::vector<ObservedMotion> group(people);
  for (int n = 0; n < people; ++n) {
    ObservedMotion& person = group[n];
    person.place = {0.6f * static_cast<float>(n), 0.05f * static_cast<float>(n % 3)};
    person.mass = 70.0f + 2.0f * static_cast<float>(n);
    person.frames.resize(kMotionRows, frames);
    person.controls = Eigen::MatrixXf::Zero(kPushRows, frames);
    for (int t = 0; t < frames; ++t) {
      const double since = std::max(0, t - 4 * n) / 60.0;
      Pose pose = Placed(StandingPose(), 0.0, {-0.02 + 0.2 * push * since * since, 0, 0});
      pose.col(kRightWrist).x() += 0.1 * std::sin(3.0 * since);
      person.frames.col(t) = pose.reshaped().cast<float>();
    }
    if (n == 0) person.controls.topLeftCorner(1, std::min(6, frames)).setConstant(push);
  }
  return group;
}

inline DiffusionNetwork RandomDiffusion(uint64_t seed, const DiffusionStructure& structure = {}) {
  Random random(seed);
  DiffusionNetwork network;
  network.structure = structure;
  network.scales = JointScales::Constant(0.1f);
  if (structure.frame == MotionFrame::kOwn) {
    network.scales.mean = Eigen::VectorXf::Constant(kOwnFrameRows, 0.02f);
    network.scales.spread = Eigen::VectorXf::Constant(kOwnFrameRows, 0.3f);
  }
  network.first_time = RandomLayer(kTimeWidth, kConditionWidth, &random);
  network.second_time = RandomLayer(kConditionWidth, kConditionWidth, &random);
  network.first_static = RandomLayer(kStaticRows, kConditionWidth, &random);
  network.second_static = RandomLayer(kConditionWidth, kConditionWidth, &random);
  for (int b = 0; b < kDiffusionBlocks; ++b) {
    const BlockWidths w = WidthsOf(b, structure);
    network.blocks.push_back(
        {RandomLayer(3 * w.in, w.out, &random), RandomLayer(3 * w.out, w.out, &random),
         RandomLayer(w.in, w.out, &random), RandomLayer(kConditionWidth, 2 * w.out, &random)});
  }
  for (int b = 0; b < kDiffusionLevels; ++b) {
    if (!structure.AttendsAfter(b)) continue;
    const int width = WidthsOf(b, structure).out;
    const auto layer = [&] { return RandomLayer(width, width, &random); };
    network.pools.push_back({layer(), layer(), layer(), layer()});
  }
  network.out = RandomLayer(3 * kDownWidths[0], structure.NumMotion(), &random);
  network.direct = RandomLayer(structure.NumInputs(), structure.NumMotion(), &random);
  return network;
}

inline std::function<NormalSource()> SeededNoise(uint64_t seed = 1) {
  return [seed] {
    const auto random = std::make_shared<Random>(seed);
    return NormalSource([random] { return random->Normal(); });
  };
}

}  // namespace pushid
