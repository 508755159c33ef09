// models: ridge regression by its normal equations.
#include "models/generators/ridge_forecast.h"

#include <Eigen/Cholesky>

namespace pushid {
namespace {

// `last`: the column of the last observed frame.
Eigen::VectorXf Features(const Trajectories& motion, Eigen::Index last) {
  const Eigen::Index size = motion.rows();
  Eigen::VectorXf features(size * (1 + kRidgeDisplacements));
  features.head(size) = motion.col(last);
  for (int k = 0; k < kRidgeDisplacements; ++k) {
    features.segment((k + 1) * size, size) = motion.col(last - k) - motion.col(last - k - 1);
  }
  return features;
}

}  // namespace

Trajectories RidgeForecast::Forecast(const Trajectories& observed) const {
  const Eigen::Index last = observed.cols() - 1;
  const Eigen::VectorXf change = weights * Features(observed, last) + bias;
  const Eigen::Map<const Eigen::MatrixXf> frames(change.data(), observed.rows(),
                                                 change.size() / observed.rows());
  return frames.colwise() + observed.col(last);
}

void RidgeFit::Add(const Trajectories& motion, int observed, int frames) {
  const Eigen::Index size = motion.rows(), windows = motion.cols() - observed - frames + 1;
  if (windows <= 0) return;
  const Eigen::Index inputs = size * (1 + kRidgeDisplacements), outputs = size * frames;
  if (count_ == 0.0) {
    features_squared_ = Eigen::MatrixXd::Zero(inputs, inputs);
    targets_by_features_ = Eigen::MatrixXd::Zero(outputs, inputs);
    feature_sum_ = Eigen::VectorXd::Zero(inputs), target_sum_ = Eigen::VectorXd::Zero(outputs);
  }
  Eigen::MatrixXd x(inputs, windows), y(outputs, windows);
  for (Eigen::Index i = 0; i < windows; ++i) {
    const Eigen::Index last = i + observed - 1;
    x.col(i) = Features(motion, last).cast<double>();
    const Eigen::MatrixXf future = motion.middleCols(last + 1, frames).colwise() - motion.col(last);
    y.col(i) = Eigen::Map<const Eigen::VectorXf>(future.data(), outputs).cast<double>();
  }
  features_squared_.noalias() += x * x.transpose();
  targets_by_features_.noalias() += y * x.transpose();
  feature_sum_ += x.rowwise().sum(), target_sum_ += y.rowwise().sum();
  count_ += static_cast<double>(windows);
}

RidgeForecast RidgeFit::Solve(double penalty) const {
  const Eigen::VectorXd mean_x = feature_sum_ / count_, mean_y = target_sum_ / count_;
  Eigen::MatrixXd squared = features_squared_ - count_ * mean_x * mean_x.transpose();
  squared.diagonal().array() += penalty;
  const Eigen::MatrixXd products = targets_by_features_ - count_ * mean_y * mean_x.transpose();
  const Eigen::MatrixXd weights = squared.llt().solve(products.transpose()).transpose();
  return {weights.cast<float>(), (mean_y - weights * mean_x).cast<float>()};
}

}  // namespace pushid
