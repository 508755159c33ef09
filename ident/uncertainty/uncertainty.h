// ident: how sure: standard errors naive and clustered by recording, null directions, correlations.
//
// Covariances as covariance.h defines them, with Student's t of G - 1 degrees of freedom for G
// recordings. Naive errors are up to 20 times too small here. A null direction of the scaled
// Jacobian has no finite error: every parameter it touches is unidentifiable, but combinations
// orthogonal to it are reported.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/problem/fit_point.h"
#include "models/enum_names.h"
#include "models/options.h"
#include "models/parameters.h"

namespace pushid {

struct Covariance;
class FitProblem;

enum class EstimateStatus { kIdentified, kWeak, kUnidentifiable, kAtBound, kFixed };
constexpr EnumNames<EstimateStatus, 5> Names(EstimateStatus) {
  return {{{"identified", EstimateStatus::kIdentified},
           {"weak", EstimateStatus::kWeak},
           {"unidentifiable", EstimateStatus::kUnidentifiable},
           {"at bound", EstimateStatus::kAtBound},
           {"fixed", EstimateStatus::kFixed}}};
}

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
  bool clustered = false;         // false with a single recording: naive errors lead
  double sigma = 0.0;             // residual standard deviation, in sigmas
  int freedom = 1;                // degrees of freedom of Student's t
  double t_quantile = 0.0;        // of the 95 % interval
  double condition_number = 0.0;  // of the scaled Jacobian, without null directions
  // Fewer clusters than shared parameters and one: their clustered covariance has no full rank, so
  // correlations are the naive ones, and nothing is called identified.
  bool too_few_clusters = false;
  bool full_hessian = false;        // whether the covariance knows second derivatives
  std::vector<Estimate> estimates;  // in the order of FitPoint::Flat
  Eigen::MatrixXd covariance;       // clustered (or naive), fitted scale, same order
  Eigen::MatrixXd correlation;      // of that covariance
  std::vector<NullDirection> null_directions;
};

// Fitted scale, in the order of FitPoint::Flat.
Covariance CovarianceAt(const FitProblem& problem, const FitPoint& point);

Uncertainty ComputeUncertainty(const FitProblem& problem, const FitPoint& point);

// What the recordings alone leave undetermined at a point, and how badly conditioned the rest is;
// cheaper than all of Uncertainty.
struct Conditioning {
  double condition_number = 0.0;
  std::vector<NullDirection> null_directions;
};
Conditioning ComputeConditioning(const FitProblem& problem, const FitPoint& point);

// A linear combination of natural values of shared parameters, and its error by the delta method.
struct Term {
  Parameter parameter;
  double coefficient;
};
struct CombinationSpec {
  std::string name, unit;
  std::vector<Term> terms;
};
Combination Combine(const FitProblem& problem, const FitPoint& point,
                    const Uncertainty& uncertainty, const CombinationSpec& spec);

// What every result reports beside its parameters: c = mu + Kp, and gains per mass of the reference
// person.
std::vector<CombinationSpec> DerivedCombinations(const ModelOptions& model);

// Two-sided 95 % quantile of Student's t.
double StudentQuantile95(int degrees_of_freedom);

}  // namespace pushid
