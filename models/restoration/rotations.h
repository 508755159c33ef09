// models: rotations fitted to directions, and the six numbers networks describe them by.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

// The first two columns, one after the other (Zhou et al., On the continuity of rotation
// representations in neural networks, CVPR 2019): unlike angles or quaternions without jumps.
using Rotation6d = Eigen::Matrix<double, 6, 1>;
Rotation6d ToRotation6d(const Eigen::Matrix3d& rotation);

// Gram and Schmidt; any six numbers whose columns are not parallel are a rotation. Parallel or
// vanishing columns give the identity.
Eigen::Matrix3d FromRotation6d(const Rotation6d& numbers);

// The smallest rotation that turns direction `from` into direction `to`; the identity where one of
// them has no length. Opposite directions turn about any axis square to them.
Eigen::Matrix3d SwingBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// argmin over R of sum |R from_i - to_i|^2 (Kabsch), a proper rotation.
Eigen::Matrix3d FitRotation(const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to);

}  // namespace pushid
