// models: rotations fitted to directions.
#include "models/restoration/rotations.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace pushid {
namespace {
constexpr double kNoLength = 1e-9;
}  // namespace

Rotation6d ToRotation6d(const Eigen::Matrix3d& rotation) {
  Rotation6d numbers;
  numbers << rotation.col(0), rotation.col(1);
  return numbers;
}

Eigen::Matrix3d FromRotation6d(const Rotation6d& numbers) {
  const Eigen::Vector3d a = numbers.head<3>(), b = numbers.tail<3>();
  const double length = a.norm();
  if (!(length > kNoLength)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rotation;
  rotation.col(0) = a / length;
  const Eigen::Vector3d square = b - rotation.col(0).dot(b) * rotation.col(0);
  const double rest = square.norm();
  if (!(rest > kNoLength)) return Eigen::Matrix3d::Identity();
  rotation.col(1) = square / rest;
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  return rotation;
}

Eigen::Matrix3d SwingBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  if (!(from.norm() > kNoLength) || !(to.norm() > kNoLength)) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

Eigen::Matrix3d FitRotation(const std::vector<Eigen::Vector3d>& from,
                            const std::vector<Eigen::Vector3d>& to) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < from.size(); ++i) covariance += to[i] * from[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign.z() = -1.0;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace pushid
