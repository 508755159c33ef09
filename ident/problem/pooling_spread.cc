// ident: fixed-point steps on the normal approximation of the posterior.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"
#include "models/decompositions.h"

namespace pushid {
namespace {

constexpr int kMaxSteps = 200;
constexpr double kSmallChange = 1e-3;       // of a spread, that ends the steps
constexpr double kLeastInformation = 1e-6;  // units' worth; below it nothing is known of a spread

// Hessian and gradient of the cost less the pooling priors, by deviation; everything else is
// integrated out.
struct DeviationPosterior {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient, at;  // the gradient at these deviations
};

DeviationPosterior IntegrateOut(const FitProblem& problem, const FitPoint& point,
                                const Eigen::VectorXd& pooling_precision) {
  FitPoint copy = point;
  const JacobianBlocks blocks = EvaluateJacobianBlocks(problem.Build(&copy, 0));
  const std::vector<double> flat = point.Flat();
  const Eigen::Index shared = static_cast<Eigen::Index>(point.shared.size());
  const Eigen::Index deviations = pooling_precision.size();
  const Eigen::Index size = static_cast<Eigen::Index>(flat.size());
  // Deviations first, then the rest.
  Eigen::MatrixXd jacobian(blocks.jacobian.rows(), size);
  jacobian << blocks.jacobian.middleCols(shared, deviations), blocks.jacobian.leftCols(shared),
      blocks.jacobian.rightCols(size - shared - deviations);
  const Eigen::MatrixXd hessian = jacobian.transpose() * jacobian;
  const Eigen::VectorXd gradient = jacobian.transpose() * blocks.residuals;

  const Eigen::Index rest = size - deviations;
  Eigen::MatrixXd nuisance = hessian.bottomRightCorner(rest, rest);
  nuisance.diagonal() *= 1.0 + 1e-12;  // a direction that nothing determines
  const Eigen::MatrixXd cross = hessian.bottomLeftCorner(rest, deviations);
  DeviationPosterior p;
  p.at = Eigen::Map<const Eigen::VectorXd>(flat.data() + shared, deviations);
  p.hessian = hessian.topLeftCorner(deviations, deviations) -
              cross.transpose() * SolveSymmetric(nuisance, cross) -
              Eigen::MatrixXd(pooling_precision.asDiagonal());
  p.gradient = gradient.head(deviations) -
               cross.transpose() * SolveSymmetric(nuisance, Eigen::VectorXd(gradient.tail(rest))) -
               pooling_precision.cwiseProduct(p.at);
  return p;
}

}  // namespace

double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, CostWeights* weights) {
  const ParameterMap& map = problem.map();
  if (map.num_deviations == 0 || problem.options().pooling_sigma) return 0.0;
  const Eigen::Index parameters = map.num_deviations;
  const Eigen::Index units = static_cast<Eigen::Index>(point.unit.size());
  Eigen::VectorXd typical(parameters), sigma(parameters);  // in PoolingSigma's units; fitted scale
  std::vector<Parameter> ids(parameters);
  for (const FittedParameter& f : map.fitted) {
    if (f.deviation < 0) continue;
    ids[f.deviation] = f.parameter;
    const ParameterSpec& spec = problem.options().table[f.parameter];
    sigma[f.deviation] = PoolingSigma(spec);
    typical[f.deviation] = PoolingSigma(spec) / spec.pooling_sigma;
  }
  const Eigen::VectorXd before = sigma;
  const auto precision = [&sigma, units]() -> Eigen::VectorXd {
    return sigma.array().square().inverse().matrix().replicate(units, 1);
  };
  const DeviationPosterior p = IntegrateOut(problem, point, precision());

  double change = 1.0;
  for (int step = 0; step < kMaxSteps && change > kSmallChange; ++step) {
    const Eigen::VectorXd prior = precision();
    const Eigen::MatrixXd hessian = p.hessian + Eigen::MatrixXd(prior.asDiagonal());
    const Eigen::MatrixXd covariance = SolveSymmetric(
        hessian, Eigen::MatrixXd(Eigen::MatrixXd::Identity(hessian.rows(), hessian.rows())));
    const Eigen::VectorXd mean = p.at - covariance * (p.gradient + prior.cwiseProduct(p.at));
    const Eigen::VectorXd last = sigma;
    for (Eigen::Index k = 0; k < parameters; ++k) {
      double squares = 0.0, known = 0.0;
      for (Eigen::Index u = 0; u < units; ++u) {
        const Eigen::Index i = u * parameters + k;
        squares += mean[i] * mean[i];
        known += 1.0 - covariance(i, i) * prior[i];
      }
      if (!(known > kLeastInformation) || !std::isfinite(squares)) continue;
      sigma[k] = std::clamp(std::sqrt(squares / known), kLeastPoolingSigma * typical[k],
                            kLargestPoolingSigma * typical[k]);
    }
    change = (sigma.cwiseQuotient(last).array() - 1.0).abs().maxCoeff();
  }
  for (Eigen::Index k = 0; k < parameters; ++k) {
    weights->pooling_sigma[ids[k]] = sigma[k] / typical[k];
  }
  return (sigma.cwiseQuotient(before).array() - 1.0).abs().maxCoeff();
}

}  // namespace pushid
