// The chain's joints with derivatives: positions are the restoration's, derivatives those of finite
// differences, at rest, as pushed and far off, in every layout with a pendulum.
#include <gtest/gtest.h>

#include "models/restoration/body_tangent.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

constexpr int kChainFrames = 12;
const std::vector<int> kChainAsked = {0, 1, 6, 11};
const CvaeLayout kLayouts[] = {{}, {CvaeCoordinates::kLdp}, {CvaeCoordinates::kTip, true, false}};

enum class ChainRegime { kStanding, kPushed, kFar };

// Far: the pendulum sways ten times as much, so that some of its numbers are beyond their limit.
RestorationInput ChainPerson(ChainRegime regime, double fps) {
  RestorationInput person =
      MovingPerson(Placed(StandingPose(), 0.8, {0.3, -0.6, 0.0}), 70.0, kChainFrames);
  const double scale = regime == ChainRegime::kStanding ? 0.0
                       : regime == ChainRegime::kPushed ? 1.0
                                                        : 10.0;
  const Vector4<double> start = person.q[0];
  for (int t = 0; t < kChainFrames; ++t) {
    person.q[t] = start + scale * (person.q[t] - start);
    person.lengths.emplace_back(person.body.rod_length - scale * 1e-3 * t,
                                person.body.cart_height + scale * 5e-4 * t);
  }
  person.dt = 1.0 / fps;
  return person;
}

CvaeWeights ChainWeights(const CvaeLayout& layout) {
  CvaeWeights weights = RandomCvae(4, layout);
  weights.pendulum.spread *= 0.3f;
  return weights;
}

BodyTangent::PathDerivatives ChainDerivatives(int columns) {
  Random random(5);
  BodyTangent::PathDerivatives derivatives;
  const Eigen::MatrixXf a = RandomMatrix(BodyTangent::kPathRows, columns, 1.0, &random);
  for (int t = 0; t < kChainFrames; ++t) derivatives.emplace_back((t / 12.0 * a).cast<double>());
  return derivatives;
}

RestorationInput AlongColumn(RestorationInput person,
                             const BodyTangent::PathDerivatives& derivatives, int column,
                             double step) {
  for (int t = 0; t < kChainFrames; ++t) {
    const Eigen::VectorXd move = step * derivatives[t].col(column);
    person.q[t] += move.head<4>();
    person.lengths[t] += move.tail<2>();
  }
  return person;
}

TEST(CvaeTangentTest, PositionsAreTheRestorations) {
  for (const CvaeLayout& layout : kLayouts) {
    for (const double fps : {60.0, 25.0}) {
      const RestorationInput person = ChainPerson(ChainRegime::kPushed, fps);
      const CvaeWeights weights = ChainWeights(layout);
      const BodyMotion motion = CvaeRestoration(weights).Restore({person})[0];
      const auto joints = CvaeTangent(weights).At(person, {}, kChainAsked);
      for (size_t k = 0; k < kChainAsked.size(); ++k) {
        EXPECT_EQ(joints[k].derivatives.cols(), 0);
        const Eigen::VectorXd expected = motion[kChainAsked[k]].reshaped();
        EXPECT_LT((joints[k].positions - expected).cwiseAbs().maxCoeff(), 1e-4)
            << NameOf(layout.coordinates) << layout.halves << " at " << fps;
      }
    }
  }
}

TEST(CvaeTangentTest, DerivativesAreThoseOfFiniteDifferences) {
  constexpr int kColumns = 3;
  constexpr double kStep = 1e-6;
  const auto derivatives = ChainDerivatives(kColumns);
  for (const CvaeLayout& layout : kLayouts) {
    const CvaeTangent tangent(ChainWeights(layout));
    for (const auto regime : {ChainRegime::kStanding, ChainRegime::kPushed, ChainRegime::kFar}) {
      for (const double fps : {60.0, 25.0}) {
        const RestorationInput person = ChainPerson(regime, fps);
        const auto joints = tangent.At(person, derivatives, kChainAsked);
        for (int column = 0; column < kColumns; ++column) {
          const auto above =
              tangent.At(AlongColumn(person, derivatives, column, kStep), {}, kChainAsked);
          const auto below =
              tangent.At(AlongColumn(person, derivatives, column, -kStep), {}, kChainAsked);
          for (size_t k = 0; k < kChainAsked.size(); ++k) {
            const Eigen::VectorXd expected =
                (above[k].positions - below[k].positions) / (2.0 * kStep);
            const double largest = expected.cwiseAbs().maxCoeff();
            EXPECT_EQ(largest > 1e-4, kChainAsked[k] > 0) << "it is no test of nothing";
            EXPECT_LT((joints[k].derivatives.col(column) - expected).cwiseAbs().maxCoeff(),
                      1e-7 + 1e-6 * largest)
                << NameOf(layout.coordinates) << layout.halves << ", regime "
                << static_cast<int>(regime) << " at " << fps << ", frame " << kChainAsked[k]
                << ", column " << column;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace pushid
