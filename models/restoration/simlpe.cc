// models: cosine transform, dense layers, and on.
#include "models/restoration/simlpe.h"

#include <cmath>

namespace pushid {
namespace {

using Transform = Eigen::Matrix<double, kGivenFrames, kGivenFrames>;

// Orthonormal DCT-II: row k of the matrix is coefficient k.
const Transform& CosineTransform() {
  static const Transform transform = [] {
    Transform d;
    for (int k = 0; k < kGivenFrames; ++k) {
      for (int t = 0; t < kGivenFrames; ++t) {
        d(k, t) = std::sqrt((k == 0 ? 1.0 : 2.0) / kGivenFrames) *
                  std::cos(M_PI * (t + 0.5) * k / kGivenFrames);
      }
    }
    return d;
  }();
  return transform;
}

}  // namespace

Eigen::VectorXf SimlpeInput(const BodyMotion& motion, int last) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(motion[last]));
  const Eigen::Vector3d origin = motion[last].col(0);
  Eigen::Matrix<double, kGivenFrames, 3 * kBodyJoints> seen;
  for (int t = 0; t < kGivenFrames; ++t) {
    const Pose pose = turn * (motion[last - kGivenFrames + 1 + t].colwise() - origin);
    seen.row(t) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  seen = (CosineTransform() * seen).eval();
  return Eigen::Map<const Eigen::VectorXd>(seen.data(), seen.size()).cast<float>();
}

Eigen::VectorXf SimlpeTarget(const BodyMotion& motion, int last) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(motion[last]));
  Eigen::VectorXf target(kSimlpeOutputs);
  for (int t = 0; t < kSimlpeFrames; ++t) {
    const Pose way = turn * (motion[last + 1 + t] - motion[last]);
    target.segment<3 * kBodyJoints>(3 * kBodyJoints * t) =
        Eigen::Map<const Eigen::VectorXd>(way.data(), way.size()).cast<float>();
  }
  return target;
}

BodyMotion ContinueMotion(const SimlpeWeights& weights, const BodyMotion& given, int frames) {
  BodyMotion motion(given.begin(), given.begin() + kGivenFrames);
  while (static_cast<int>(motion.size()) < frames) {
    const int last = static_cast<int>(motion.size()) - 1;
    const Eigen::MatrixXf output =
        weights.network.Evaluate(weights.inputs.Scaled(SimlpeInput(motion, last)));
    const Eigen::Matrix3d turn = TurnAboutZ(Heading(motion[last]));
    const Pose from = motion[last];
    for (int t = 0; t < kSimlpeFrames && static_cast<int>(motion.size()) < frames; ++t) {
      const Eigen::VectorXd way =
          output.block<3 * kBodyJoints, 1>(3 * kBodyJoints * t, 0).cast<double>();
      motion.push_back(from + turn * Eigen::Map<const Pose>(way.data()));
    }
  }
  return motion;
}

}  // namespace pushid
