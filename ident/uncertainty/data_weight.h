// ident: how much the recordings weigh against what was put in beside them.
//
// Sigmas. Each kind of residual (hip, velocity, angles, rates) is counted in its own robust scale:
// with e its d components in one frame, s^2 = median |e|^2 / median of chi-squared with d degrees
// of freedom. Markers are never more exact than their noise. Velocities, angles and rates are made
// of the same markers as the hip's path and repeat much of what it says: they count for 0.3 of it,
// that is their sigma is s / 0.3 (chosen on the folds of the 32 single-person recordings: hipADE
// 0.090 m against 0.095 with all kinds alike; it leaves estimates of a right model unbiased).
//
// Effective frames. The errors of one recording last, and its nine residuals a frame err together,
// so the sum of their log densities is a composite likelihood: its maximum is right and its
// curvature is not. It is scaled as Rotnitzky and Jewell (1990) scale it, so that curvature and
// score variance agree on average (first-moment adjustment; Varin, Reid and Firth 2011, section 3):
//
//   lambda = tr(H^-1 V_s) / tr(H^-1 H_data),   V_s = sum over recordings g of A_g s_g (A_g s_g)'
//
// with A_g s_g the leverage-adjusted scores of CR2 (clusters.h). Data rows are divided
// by sqrt(lambda): then a frame counts as `weight` of an independent one. One factor for all leaves
// an unpenalized optimum where it was, gives priors their true share, and lets exact data outweigh
// any prior. Where sigmas are estimated no frame counts as more than one. It assumes that
// recordings err independently of each other; that people do not is what the standard errors are
// clustered for. Compared to the integrated autocorrelation time of the residuals, it also sees how
// residuals of one frame go together, and how the robust loss counts.
#pragma once

#include "ident/problem/fit_problem.h"

namespace pushid {

inline constexpr double kRateWeight = 0.3;

// At a point near the optimum; the options' own where nothing can be told (all rollouts failed).
ResidualSigmas EstimateSigmas(const FitProblem& problem, const FitPoint& point);

// Independent frames a frame, for FitOptions::effective_weight. A single recording cannot tell: it
// counts as one frame.
double EstimateEffectiveWeight(const FitProblem& problem, const FitPoint& point);

}  // namespace pushid
