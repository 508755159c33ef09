// models: particles and the bones between them.
#include "models/particles.h"

#include <algorithm>
#include <cmath>

namespace pushid {
namespace {

// The place at which the bone of a particle begins.
Eigen::Vector3f BoneStart(const Eigen::Ref<const Eigen::VectorXf>& pose,
                          const ParticleLayout& layout, int particle) {
  const int parent = layout.parents[particle];
  if (parent == kFixedPoint) return layout.fixed.col(particle);
  return pose.segment<3>(3 * parent);
}

}  // namespace

Trajectories Mirrored(const Trajectories& motion, const ParticleLayout& layout) {
  Trajectories mirrored(motion.rows(), motion.cols());
  for (int i = 0; i < layout.num_particles(); ++i) {
    mirrored.middleRows<3>(3 * i) = motion.middleRows<3>(3 * layout.mirrored[i]);
    mirrored.row(3 * i + layout.mirrored_axis) *= -1.0f;
  }
  return mirrored;
}

Eigen::MatrixXf BoneLengths(const Trajectories& motion, const ParticleLayout& layout) {
  Eigen::MatrixXf lengths = Eigen::MatrixXf::Zero(layout.num_particles(), motion.cols());
  for (int i = 0; i < layout.num_particles(); ++i) {
    if (layout.parents[i] == kNoBone) continue;
    for (int t = 0; t < motion.cols(); ++t) {
      const Eigen::Vector3f end = motion.col(t).segment<3>(3 * i);
      lengths(i, t) = (end - BoneStart(motion.col(t), layout, i)).norm();
    }
  }
  return lengths;
}

Eigen::MatrixXd CosineTransform(int frames) {
  Eigen::MatrixXd transform(frames, frames);
  for (int k = 0; k < frames; ++k) {
    for (int t = 0; t < frames; ++t) {
      transform(k, t) =
          std::sqrt((k == 0 ? 1.0 : 2.0) / frames) * std::cos(M_PI * (t + 0.5) * k / frames);
    }
  }
  return transform;
}

void ProjectBones(const Eigen::VectorXf& like, const ParticleLayout& layout, Trajectories* motion) {
  const Eigen::VectorXf lengths = BoneLengths(like, layout);
  for (int t = 0; t < motion->cols(); ++t) {
    auto pose = motion->col(t);
    for (int i = 0; i < layout.num_particles(); ++i) {
      if (layout.parents[i] == kNoBone) continue;
      const Eigen::Vector3f start = BoneStart(pose, layout, i);
      const Eigen::Vector3f bone = pose.segment<3>(3 * i) - start;
      const float length = bone.norm();
      if (length > 1e-6f) pose.segment<3>(3 * i) = start + bone * (lengths(i) / length);
    }
  }
}

Eigen::VectorXf MeanDistance(const Trajectories& a, const Trajectories& b,
                             const ParticleLayout& layout) {
  const int frames = static_cast<int>(std::min(a.cols(), b.cols()));
  Eigen::VectorXf mean = Eigen::VectorXf::Zero(frames);
  for (int t = 0; t < frames; ++t) {
    for (int i = 0; i < layout.num_particles(); ++i) {
      mean(t) +=
          layout.weights[i] * (a.col(t).segment<3>(3 * i) - b.col(t).segment<3>(3 * i)).norm();
    }
  }
  return mean / static_cast<float>(layout.joints);
}

Eigen::Matrix3d Rodrigues(const Eigen::Vector3d& map) {
  const double angle = map.norm();
  const Eigen::Vector3d axis = map / (angle + 1e-7);
  Eigen::Matrix3d cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * cross +
         (1.0 - std::cos(angle)) * cross * cross;
}

Eigen::Matrix3Xd JointPositions(const JointTree& tree, const Eigen::VectorXd& maps) {
  Eigen::Matrix3Xd positions = tree.offsets;
  std::vector<Eigen::Matrix3d> turns(tree.num_joints());
  for (int i = 0; i < tree.num_joints(); ++i) {
    turns[i] = Rodrigues(maps.segment<3>(3 * i));
    const int parent = tree.parents[i];
    if (parent <= 0) continue;
    turns[i] *= turns[parent];
    positions.col(i) = turns[parent].transpose() * tree.offsets.col(i) + positions.col(parent);
  }
  return positions;
}

Eigen::MatrixXd CountTransitions(const std::vector<Symbols>& people, int num_symbols,
                                 Transitions which) {
  Eigen::MatrixXd counts = Eigen::MatrixXd::Zero(num_symbols, num_symbols);
  for (const Symbols& symbols : people) {
    for (size_t t = 1; t < symbols.size(); ++t) counts(symbols[t - 1], symbols[t]) += 1.0;
  }
  if (which == Transitions::kChanges) counts.diagonal().setZero();
  return counts;
}

std::optional<double> JensenShannon(const Eigen::MatrixXd& p, const Eigen::MatrixXd& q) {
  if (!(p.sum() > 0.0) || !(q.sum() > 0.0)) return std::nullopt;
  double divergence = 0.0;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double a = p.data()[i] / p.sum(), b = q.data()[i] / q.sum(), mean = 0.5 * (a + b);
    if (a > 0.0) divergence += 0.5 * a * std::log(a / mean);
    if (b > 0.0) divergence += 0.5 * b * std::log(b / mean);
  }
  return std::sqrt(std::max(0.0, divergence));  // rounding may leave less than nothing
}

}  // namespace pushid
