// ident: how sure: standard errors naive and clustered by recording, null directions, correlations.
//
// At the optimum, with H = J'J over all residuals and s_g = J_g' r_g the score of recording g:
//   naive      sigma^2 H^-1, sigma^2 = |r|^2 / (N - P): frames taken as independent, which they are
//   not clustered  sum over g of D_g D_g' (G - 1) / G,  D_g = (H - H_g)^-1 s_g centred:
// what leaving out recording g would move, to first order (the CR3 jackknife; Bell & McCaffrey
// 2002), with Student's t of G - 1 degrees of freedom. Naive errors are up to 20 times too small
// here. A null direction of the scaled Jacobian has no finite error: every parameter it touches is
// unidentifiable, but combinations orthogonal to it are reported.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/fit_problem.h"

namespace pushid {

enum class EstimateStatus { kIdentified, kWeak, kUnidentifiable, kAtBound, kFixed };

// One fitted number: a shared parameter, a subject's deviation or an initial velocity.
struct Estimate {
  std::string name;
  std::string unit;
  double value = 0.0;                 // natural unit
  double standard_error = 0.0;        // clustered, natural unit; infinity when unidentifiable
  double standard_error_naive = 0.0;  // natural unit
  double lower95 = 0.0, upper95 = 0.0;
  EstimateStatus status = EstimateStatus::kIdentified;
};

// A sum of parameters, by natural values.
struct Combination {
  std::string name;  // "mu + Kp_x"
  std::string unit;
  double value = 0.0, standard_error = 0.0, lower95 = 0.0, upper95 = 0.0;
};

struct NullDirection {
  std::vector<std::string> parameters;  // those it touches
  std::vector<double> coefficients;     // in units of each parameter's scale, largest 1
  std::vector<Combination> identified;  // combinations that it leaves alone
  std::string sentence;
};

struct Uncertainty {
  int num_residuals = 0;  // of data
  int num_clusters = 0;
  bool clustered = false;           // false with a single recording: naive errors lead
  double sigma = 0.0;               // residual standard deviation, in sigmas
  double t_quantile = 0.0;          // of the 95 % interval
  double condition_number = 0.0;    // of the scaled Jacobian, without null directions
  std::vector<Estimate> estimates;  // in the order of FitPoint::Flat
  Eigen::MatrixXd covariance;       // clustered (or naive), fitted scale, same order
  Eigen::MatrixXd correlation;      // of that covariance
  std::vector<NullDirection> null_directions;
};

Uncertainty ComputeUncertainty(const FitProblem& problem, const FitPoint& point);

// A linear combination of natural values of shared parameters with its error (delta method).
struct Term {
  Parameter parameter;
  double coefficient;
};
Combination Combine(const FitProblem& problem, const FitPoint& point,
                    const Uncertainty& uncertainty, const std::vector<Term>& terms,
                    const std::string& name, const std::string& unit);

// Two-sided 95 % quantile of Student's t.
double StudentQuantile95(int degrees_of_freedom);

}  // namespace pushid
