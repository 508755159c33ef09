// ident: how far units differ, estimated from the units.
//
// A pooled parameter of unit u is shared + d_u with d_u ~ N(0, s^2). s maximizes the marginal
// likelihood of the data, in which the deviations and the shared values are integrated out
// (empirical Bayes; restricted maximum likelihood, as the shared values are integrated out too).
// By the EM algorithm (Dempster, Laird and Rubin 1977; Laird and Ware 1982):
//   s^2 <- mean over the n units of (E[d_u]^2 + Var[d_u])
// with mean and variance under the data, the other priors and the last s. Its fixed point is
//   s^2 = sum of E[d_u]^2 / sum of (1 - Var[d_u] / s^2)
// and that is what is iterated (MacKay 1992): near no spread EM takes hundreds of steps.
//
// The posterior is taken as normal: cost and J'J at the point (Laplace). With two units, s is known
// to a factor of about two either way; it says how much a unit may differ, no more.
#pragma once

#include "ident/problem/fit_point.h"

namespace pushid {

class FitProblem;
struct CostWeights;

// Bounds of s, in ParameterSpec::pooling_sigma's units: 1 % and a factor of twenty.
inline constexpr double kLeastPoolingSigma = 0.01, kLargestPoolingSigma = 3.0;

// Sets the weights' pooling_sigma of every pooled parameter to the s that the units tell of at a
// point (best the optimum of the cost as the problem weighs it). Returns the largest relative
// change: solve and update until it is small.
double UpdatePoolingSpread(const FitProblem& problem, const FitPoint& point, CostWeights* weights);

}  // namespace pushid
