// Smoothing by local cubics: exact on cubics, ends included.
#include <gtest/gtest.h>

#include "datasets/files/random.h"
#include "models/skeleton_mapping.h"
#include "tests/models/model_samples.h"

namespace pushid {
namespace {

// Sample of four cubics in time, powers by row.
SmoothedSample Cubic(const Eigen::Matrix4d& c, double s) {
  return {c.transpose() * Eigen::Vector4d(1, s, s * s, s * s * s),
          c.transpose() * Eigen::Vector4d(0, 1, 2 * s, 3 * s * s),
          c.transpose() * Eigen::Vector4d(0, 0, 2, 6 * s)};
}

TEST(SavitzkyGolay, IsExactOnCubics) {
  Random random(71);
  for (int window : {5, 7, 11, 21}) {
    for (int frames : {5, 6, 8, 11, 40}) {
      const Eigen::Matrix4d c =
          Eigen::Matrix4d::NullaryExpr([&](auto, auto) { return random.Uniform(-2, 2); });
      std::vector<Eigen::Vector4d> samples;
      for (int t = 0; t < frames; ++t) samples.push_back(Cubic(c, t * kSampleDt).value);
      const auto smoothed = SavitzkyGolay(samples, window, kSampleDt);
      ASSERT_EQ(smoothed.size(), samples.size());
      for (int t = 0; t < frames; ++t) {
        const SmoothedSample expected = Cubic(c, t * kSampleDt);
        EXPECT_LT((smoothed[t].value - expected.value).norm(), 1e-12) << window << ", " << t;
        EXPECT_LT((smoothed[t].rate - expected.rate).norm(), 1e-10) << window << ", " << t;
        EXPECT_LT((smoothed[t].acceleration - expected.acceleration).norm(), 1e-8)
            << window << ", " << t;
      }
    }
  }
}

TEST(SavitzkyGolay, WiderWindowsLeaveLessNoise) {
  Random random(72);
  std::vector<Eigen::Vector4d> samples(400);
  for (Eigen::Vector4d& sample : samples) {
    for (double& value : sample) value = random.Normal();
  }
  double before = 20.0;  // root sum square of 400 unit normals
  for (int window : {5, 9, 17, 33}) {
    double sum = 0.0;
    for (const SmoothedSample& s : SavitzkyGolay(samples, window, kSampleDt)) {
      sum += s.value[0] * s.value[0];
    }
    EXPECT_LT(std::sqrt(sum), before) << window;
    before = std::sqrt(sum);
  }
}

TEST(SavitzkyGolay, TooShortASignalIsReturnedAsItIs) {
  for (int frames : {0, 1, 4}) {
    const std::vector<Eigen::Vector4d> samples(frames, Eigen::Vector4d(1, 2, 3, 4));
    const auto smoothed = SavitzkyGolay(samples, 11, kSampleDt);
    ASSERT_EQ(smoothed.size(), samples.size());
    for (const SmoothedSample& s : smoothed) {
      EXPECT_EQ(s.value, samples[0]);
      EXPECT_EQ(s.rate.norm() + s.acceleration.norm(), 0.0);
    }
  }
}

}  // namespace
}  // namespace pushid
