// models: cosine transform, dense layers, and on.
#include "models/peers/simlpe.h"

#include "models/particles.h"
#include "models/peers/peer.h"

namespace pushid {

Eigen::VectorXf SimlpeInput(const BodyMotion& motion, int last) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(motion[last]));
  const Eigen::Vector3d origin = motion[last].col(0);
  static const Eigen::MatrixXd transform = CosineTransform(kSimlpeGiven);
  Eigen::Matrix<double, kSimlpeGiven, 3 * kBodyJoints> seen;
  for (int t = 0; t < kSimlpeGiven; ++t) {
    const Pose pose = turn * (motion[last - kSimlpeGiven + 1 + t].colwise() - origin);
    seen.row(t) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  seen = (transform * seen).eval();
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

namespace {

BodyMotion Continued(const SimlpeWeights& weights, const BodyMotion& given, int frames) {
  BodyMotion motion(given.begin(), given.begin() + kSimlpeGiven);
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

}  // namespace

std::vector<BodyMotion> SimlpePeer::Continue(const std::vector<BodyMotion>& people,
                                             int frames) const {
  std::vector<BodyMotion> continued;
  for (const BodyMotion& given : people) continued.push_back(Continued(weights_, given, frames));
  return continued;
}

void AddTensors(const SimlpeWeights& weights, TensorList* tensors) {
  AddTensors("inputs", weights.inputs, tensors);
  AddTensors("network", weights.network, tensors);
}

SimlpeWeights TakeSimlpe(TensorReader* reader) {
  SimlpeWeights weights;
  TensorFields fields(reader);
  fields.Scales("inputs", kSimlpeInputs, &weights.inputs);
  fields.Network("network", 3, kSimlpeInputs, kSimlpeOutputs, &weights.network);
  return weights;
}

}  // namespace pushid
