// models: displacements, their cosine transform, and back.
#include "models/peers/mrt_features.h"

#include <cmath>

#include "models/peers/peer.h"

namespace pushid {
namespace {

Eigen::Map<const Eigen::VectorXd> Column(const Pose& pose) { return {pose.data(), pose.size()}; }

// kMrtPoseRows x kMrtTokens, in world.
Eigen::MatrixXd CoefficientsOfGiven(const BodyMotion& motion, int last) {
  static const Eigen::MatrixXd transform = CosineTransform(kMrtTokens).transpose();
  Eigen::MatrixXd steps(kMrtPoseRows, kMrtTokens);
  for (int k = 0; k < kMrtTokens; ++k) {
    const int t = last - kMrtTokens + k;
    steps.col(k) = Column(motion[t + 1] - motion[t]);
  }
  return steps * transform;
}

// The numbers of a matrix as one column.
Eigen::Map<const Eigen::VectorXf> Flat(const Eigen::MatrixXf& values) {
  return {values.data(), values.size()};
}

}  // namespace

MrtView MrtViewOf(const std::vector<BodyMotion>& people, int last, int person) {
  const Pose& asked = people[person][last];
  const double heading = Heading(asked);
  const Eigen::Matrix3d turn = TurnAboutZ(-heading);
  const int count = static_cast<int>(people.size());
  MrtView view;
  view.person = person;
  view.tokens.resize(kMrtPoseRows, kMrtTokens * count);
  view.places.resize(kMrtPlaceRows, count);
  for (int n = 0; n < count; ++n) {
    const Eigen::MatrixXd world = CoefficientsOfGiven(people[n], last);
    const Eigen::Map<const Eigen::Matrix3Xd> joints(world.data(), 3, kBodyJoints * kMrtTokens);
    const Eigen::Matrix3Xf turned = (turn * joints).cast<float>();
    view.tokens.middleCols(kMrtTokens * n, kMrtTokens) =
        Eigen::Map<const Eigen::MatrixXf>(turned.data(), kMrtPoseRows, kMrtTokens);
    const Eigen::Vector3d place = turn * (people[n][last].col(0) - asked.col(0));
    const double near = std::exp(-place.head<2>().squaredNorm());
    const double facing = Heading(people[n][last]) - heading;
    view.places.col(n) << static_cast<float>(place.x()), static_cast<float>(place.y()),
        static_cast<float>(near), static_cast<float>(std::sin(facing)),
        static_cast<float>(std::cos(facing));
  }
  Pose pose = turn * (asked.colwise() - asked.col(0));
  pose.col(0) << 0.0, 0.0, asked(2, 0);
  const Pose step = turn * (asked - people[person][last - 1]);
  view.query.resize(kMrtQueryRows);
  view.query << Column(pose).cast<float>(), Column(step).cast<float>();
  return view;
}

Eigen::MatrixXf MrtWays(const BodyMotion& motion, int last) {
  const Eigen::Matrix3d turn = TurnAboutZ(-Heading(motion[last]));
  Eigen::MatrixXf ways(kMrtPoseRows, kMrtFrames);
  for (int t = 0; t < kMrtFrames; ++t) {
    const Pose way = turn * (motion[last + 1 + t] - motion[last]);
    ways.col(t) = Column(way).cast<float>();
  }
  return ways;
}

const Eigen::MatrixXf& MrtWaysMatrix() {
  // The inverse transform, then the sum of all displacements so far.
  static const Eigen::MatrixXf matrix = [] {
    const Eigen::MatrixXd sums =
        Eigen::MatrixXd::Ones(kMrtFrames, kMrtFrames).triangularView<Eigen::Upper>();
    return Eigen::MatrixXf((CosineTransform(kMrtFrames) * sums).cast<float>());
  }();
  return matrix;
}

Eigen::MatrixXf MrtWaysOf(const Eigen::MatrixXf& coefficients) {
  return coefficients * MrtWaysMatrix();
}

Eigen::MatrixXf MrtCoefficientsOf(const Eigen::MatrixXf& ways) {
  static const Eigen::MatrixXf transform = CosineTransform(kMrtFrames).transpose().cast<float>();
  Eigen::MatrixXf steps = ways;
  steps.rightCols(kMrtFrames - 1) -= ways.leftCols(kMrtFrames - 1);
  return steps * transform;
}

MrtView Scaled(const MrtScalings& scalings, MrtView view) {
  Eigen::Map<Eigen::MatrixXf> by_person(view.tokens.data(), kMrtPoseRows * kMrtTokens,
                                        view.num_people());
  by_person = scalings.tokens.Scaled(by_person);
  view.query = scalings.query.Scaled(view.query);
  return view;
}

MrtScalings MrtScalingsOf(const std::vector<std::vector<BodyMotion>>& groups, int stride) {
  std::vector<Eigen::VectorXf> tokens, queries, outputs;
  for (const std::vector<BodyMotion>& people : groups) {
    const int frames = static_cast<int>(people.front().size());
    for (int last = kMrtGiven - 1; last + kMrtFrames < frames; last += stride) {
      for (int n = 0; n < static_cast<int>(people.size()); ++n) {
        const MrtView view = MrtViewOf({people[n]}, last, 0);
        tokens.push_back(Flat(view.tokens));
        queries.push_back(view.query);
        outputs.push_back(Flat(MrtCoefficientsOf(MrtWays(people[n], last))));
      }
    }
  }
  const auto scaling = [](const std::vector<Eigen::VectorXf>& columns) {
    if (columns.empty()) return Scaling();
    Eigen::MatrixXf all(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
    for (size_t i = 0; i < columns.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = columns[i];
    constexpr float kSmallestStep = 1e-4f;  // m
    return ScalingOf(all, kSmallestStep);
  };
  return {scaling(tokens), scaling(queries), scaling(outputs)};
}

}  // namespace pushid
