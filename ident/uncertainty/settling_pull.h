// ident: what the demand to settle moved, by the fit without it.
//
// A demand that binds holds a fit on its edge, where its gradient says little: what it moved is the
// difference to the optimum without it, at the same weights of the data. With many columns that
// optimum is one Newton step away instead, (H - H_settling)^-1 g.
#pragma once

#include <Eigen/Core>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/covariance.h"
#include "ident/uncertainty/uncertainty.h"

namespace pushid {

// Fitted scale, in the order of FitPoint::Flat; zeros where the demand does not bind.
struct SettlingPull {
  Eigen::VectorXd moved;
  SettlingDemand demand;
};
SettlingPull ComputeSettlingPull(const FitProblem& problem, const FitPoint& point,
                                 const Covariance& covariance);

}  // namespace pushid
