// ident: a path to a pose.
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/forecasts/most_probable_path.h"
#include "models/generators/particle_network.h"

namespace pushid {
namespace {

constexpr double kEndWidth = 0.005;   // m, of every coordinate of the last pose
constexpr double kDifference = 0.05;  // of standard normal noise, which moves poses by millimetres

// The rows of the header over the noise of all frames.
class NoiseAction : public ceres::CostFunction {
 public:
  NoiseAction(const MotionGenerator& generator, const ObservedMotion& person, int frames,
              const Eigen::VectorXf& target)
      : generator_(generator),
        person_(person),
        frames_(frames),
        target_(target),
        size_(frames * generator.layout().num_coordinates()) {
    mutable_parameter_block_sizes()->push_back(size_);
    set_num_residuals(size_ + 1 + static_cast<int>(target.size()));
    // Nothing that is drawn is narrower than this, by what is known of the others
    // (models/generators/particle_network.h).
    shift_ = 1.0 - (kLeastLogNoise + 0.5 * std::log(kOwnNoise)) * size_;
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::VectorXd> noise(blocks[0], size_);
    const bool differ = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::MatrixXf drawn = noise.cast<float>().replicate(1, differ ? 1 + size_ : 1);
    if (differ) drawn.rightCols(size_).diagonal().array() += static_cast<float>(kDifference);
    const std::vector<SampledFuture> futures = generator_.Driven(person_, frames_, drawn);
    Eigen::Map<Eigen::VectorXd> rows(residuals, num_residuals());
    rows = Rows(futures[0], drawn.col(0));
    if (!differ) return rows.allFinite();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], num_residuals(), size_);
    for (int i = 0; i < size_; ++i) {
      jacobian.col(i) = (Rows(futures[1 + i], drawn.col(1 + i)) - rows) / kDifference;
    }
    return rows.allFinite() && jacobian.allFinite();
  }

 private:
  Eigen::VectorXd Rows(const SampledFuture& future, const Eigen::VectorXf& noise) const {
    Eigen::VectorXd rows(num_residuals());
    rows.head(size_) = noise.cast<double>();
    const double log_density =
        -0.5 * rows.head(size_).squaredNorm() - 0.5 * std::log(2.0 * M_PI) * size_;
    rows[size_] = std::sqrt(2.0 * (log_density - future.log_likelihood + shift_));
    rows.tail(target_.size()) = (future.motion.rightCols(1) - target_).cast<double>() / kEndWidth;
    return rows;
  }

  const MotionGenerator& generator_;
  const ObservedMotion& person_;
  int frames_;
  Eigen::VectorXf target_;
  int size_;
  double shift_ = 0.0;
};

double DistanceToEnd(const SampledFuture& future, const Eigen::VectorXf& target,
                     const ParticleLayout& layout) {
  return MeanDistance(future.motion.rightCols(1), target, layout)(0);
}

}  // namespace

Result<PathChoice> MostProbablePath(const std::vector<SampledFuture>& futures,
                                    const Eigen::VectorXf& target, double distance,
                                    const ParticleLayout& layout) {
  PathChoice choice;
  double nearest = HUGE_VAL;
  for (size_t i = 0; i < futures.size(); ++i) {
    const double away = DistanceToEnd(futures[i], target, layout);
    nearest = std::min(nearest, away);
    if (away > distance) continue;
    ++choice.near;
    if (choice.near > 1 && futures[i].log_likelihood <= choice.log_likelihood) continue;
    choice.future = static_cast<int>(i);
    choice.distance = away;
    choice.log_likelihood = futures[i].log_likelihood;
  }
  if (choice.near > 0) return choice;
  return Error{"none of " + std::to_string(futures.size()) + " sampled futures ends within " +
               Rounded(distance, 3) + " m of the target; the nearest is " + Rounded(nearest, 3) +
               " m away: raise --samples"};
}

Result<MinimizedPath> PathToPose(const MotionGenerator& generator, const ObservedMotion& person,
                                 int frames, const Eigen::VectorXf& target) {
  const int size = frames * generator.layout().num_coordinates();
  const auto driven = [&](const Eigen::VectorXd& noise) {
    return generator.Driven(person, frames, noise.cast<float>());
  };
  Eigen::VectorXd noise = Eigen::VectorXd::Zero(size);
  const std::vector<SampledFuture> undriven = driven(noise);
  if (undriven.empty())
    return Error{"generators of this kind have no transition probabilities to weight paths by"};
  ceres::Problem problem;
  problem.AddResidualBlock(new NoiseAction(generator, person, frames, target), nullptr,
                           noise.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 20;
  options.function_tolerance = 1e-3;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    return Error{"no most probable path to the target was found: " + summary.message};
  }
  const SampledFuture found = driven(noise).front();
  return MinimizedPath{found.motion, DistanceToEnd(found, target, generator.layout()),
                       found.log_likelihood, undriven.front().log_likelihood,
                       static_cast<int>(summary.iterations.size()) - 1};
}

}  // namespace pushid
