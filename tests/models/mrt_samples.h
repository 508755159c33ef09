// An MRT of random weights and groups that walk, for tests.
#pragma once

#include "models/peers/mrt_network.h"
#include "tests/models/body_samples.h"

namespace pushid {

// People one behind the other, who walk in directions and with sways of their own.
inline std::vector<BodyMotion> WalkingGroup(int people, int frames) {
  std::vector<BodyMotion> group;
  for (int n = 0; n < people; ++n) {
    BodyMotion motion;
    for (int t = 0; t < frames; ++t) {
      const double sway = 0.02 * std::sin(0.2 * t + n);
      Pose pose = Placed(StandingPose(), 0.3 * n + 0.5 * sway,
                         {0.6 * n + 0.01 * t, 0.1 * n + 0.004 * n * t + sway, 0.0});
      pose.col(kBodyHead).z() += 0.5 * sway;
      motion.push_back(pose);
    }
    group.push_back(std::move(motion));
  }
  return group;
}

inline MrtLayer RandomMrtLayer(const MrtWidths& widths, Random* random) {
  const int width = widths.width, heads = widths.heads * widths.head;
  const MrtNorm norm = {Eigen::VectorXf::Ones(width), Eigen::VectorXf::Zero(width)};
  return {RandomLayer(width, heads, random),
          RandomLayer(width, heads, random),
          RandomLayer(width, heads, random),
          RandomLayer(heads, width, random),
          norm,
          RandomLayer(width, widths.inner, random),
          RandomLayer(widths.inner, width, random),
          norm};
}

// Its steps are of a few millimetres.
inline MrtWeights RandomMrt(uint64_t seed = 1) {
  Random random(seed);
  MrtWeights weights;
  const MrtWidths widths = WidthsOf(weights.size);
  weights.scalings = {UnitScaling(kMrtPoseRows * kMrtTokens), UnitScaling(kMrtQueryRows),
                      UnitScaling(kMrtPoseRows * kMrtFrames)};
  weights.scalings.tokens.spread *= 0.01f;
  weights.scalings.outputs.spread *= 0.002f;
  weights.local_token = RandomLayer(kMrtPoseRows, widths.width, &random);
  weights.global_token = RandomLayer(kMrtPoseRows, widths.width, &random);
  weights.place = RandomLayer(kMrtPlaceRows, widths.width, &random);
  weights.query = RandomLayer(kMrtQueryRows, widths.width, &random);
  weights.coefficients = RandomMatrix(widths.width, kMrtTokens, 0.3, &random);
  for (auto* layers : {&weights.local, &weights.global, &weights.decoder}) {
    for (int i = 0; i < widths.layers; ++i) layers->push_back(RandomMrtLayer(widths, &random));
  }
  weights.output = RandomLayer(widths.width, kMrtPoseRows * kMrtFrames, &random);
  return weights;
}

}  // namespace pushid
