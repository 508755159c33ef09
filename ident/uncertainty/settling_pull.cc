// ident: refitting without the demand to settle.
#include "ident/uncertainty/settling_pull.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ident/problem/behaviour.h"
#include "ident/solver/solver.h"

namespace pushid {
namespace {

// More columns than these make a refit as long as the fit.
constexpr Eigen::Index kMostColumnsToRefit = 60;
constexpr double kFreeTolerance = 1e-6;  // of the cost: a hundredth of an error at most

FitPoint NewtonStep(const FitPoint& point, const Covariance& c) {
  const Eigen::MatrixXd free = c.by_data + c.by_prior + c.by_pooling;
  const Eigen::VectorXd step =
      free.completeOrthogonalDecomposition().solve(c.settling_gradient);
  FitPoint to = point;
  std::vector<double> flat = point.Flat();
  for (size_t i = 0; i < flat.size(); ++i) flat[i] += step[static_cast<Eigen::Index>(i)];
  to.SetFlat(flat);
  return to;
}

}  // namespace

SettlingPull ComputeSettlingPull(const FitProblem& problem, const FitPoint& point,
                                 const Covariance& covariance) {
  const std::vector<double> held = point.Flat();
  SettlingPull pull{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(held.size())), {}};
  if (covariance.settling_gradient.isZero(0.0)) return pull;
  FitPoint free = point;
  if (covariance.settling_gradient.size() > kMostColumnsToRefit) {
    free = NewtonStep(point, covariance);
  } else {
    FitOptions options = problem.options();
    options.settling_weight = options.mode_weight = options.stability_weight = 0.0;
    options.function_tolerance = std::max(kFreeTolerance, options.function_tolerance);
    const FitProblem without(problem.recordings(), options, problem.counts());
    free = Refit(without, point).to;
  }
  pull.demand.binds = true;
  pull.demand.free_seconds = SettlingSeconds(problem.ModelAt(free), problem.Parameters(free, ""));
  const std::vector<double> flat = free.Flat();
  for (size_t i = 0; i < flat.size(); ++i) pull.moved[static_cast<Eigen::Index>(i)] = held[i] - flat[i];
  return pull;
}

}  // namespace pushid
