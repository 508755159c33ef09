// ident: covariances of a least-squares estimate from its residuals and Jacobian alone, whatever
// model made them (the NIST reference sets go through here too).
//
// At the optimum, with H the Hessian of the cost, H = J'J + sum r d2r (the second term only where
// it was computed, residual_rows.h):
//   naive      (J'J)^-1 (sigma^2 J_d'J_d + J_b'J_b) (J'J)^-1, sigma^2 = |r_d|^2 / (N - rank): rows
//   of data
//              (d) taken as independent, priors and demands (b) in units of their own
//   clustered  CR2 over clusters of rows (clusters.h). Where rows are clustered two ways,
//              V_first + V_second - V_both. Deviations of pooled units are draws, and what they
//              scatter is a second part, by their own prior's spread: H^-1 J_p'J_p H^-1. So is what
//              a prior's centre scatters: where data say little the error is the prior's width,
//              where they say all it is the sandwich, and where the data's scores scatter as their
//              weight says it is the posterior's, H^-1. How parts go together: below.
// What leaving a recording out would move: H^-1 s_g G / (G - 1), one step with the mean Hessian of
// the rest. Against refits of the 32 single-person recordings it is off by 15 % (root mean square
// over all moves); by H less the recording's own J_g'J_g by 39 %, less its second derivatives too
// by 42 %, by J'J less J_g'J_g by 28 %. By singular values, on the subspace that the rows
// determine; nothing is said of the rest.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/uncertainty/clusters.h"

namespace pushid {

// What an estimate scatters by, in independent parts, and intervals of their sum.
//
// The recordings' part is estimated from G clusters: it has at most G - 1 degrees of freedom,
// whatever lies beside it. The parts of priors and demands are known. With V_k the variance of a
// coefficient by part k, f_k its degrees of freedom and t_k the 95 % quantile of Student's t of
// f_k,
//   half-width = sqrt(sum of t_k^2 V_k),
// which covers at least 95 % whatever the true V_k are (Banerjee 1961, Sankhya 23), and is
// Student's interval where one part is all. Rejected: one t of Welch and Satterthwaite's degrees of
// freedom. They are computed from estimated variances, so that where the scores of two people
// happen to agree, the known part seems to be all of the variance and its many degrees of freedom
// count.
//
// Two targets. "People like them": people are drawn, and a person is a cluster. "These people": the
// people are given, their recordings are drawn, and a recording is a cluster.

// On the fitted scale. quantile: half-width over standard error. freedom: of the part that is known
// worst, of those that matter.
struct ScatterOf {
  double standard_error = 0.0, quantile = 0.0, freedom = 1.0;

  double HalfWidth() const { return quantile * standard_error; }
};

struct Scatter {
  struct Part {
    Eigen::MatrixXd covariance;
    Eigen::VectorXd freedom;  // of each column; infinite: known
  };
  std::vector<Part> parts;

  bool empty() const { return parts.empty(); }
  // One freedom for all columns.
  void Add(const Eigen::MatrixXd& covariance, double freedom);
  Eigen::MatrixXd Covariance() const;
  // The error of a sum of columns: each part by the least freedom of the columns in it.
  ScatterOf Of(const Eigen::VectorXd& coefficients) const;
  ScatterOf OfColumn(Eigen::Index column) const;
};

// A number's error and 95 % interval, natural unit.
struct Interval {
  double standard_error = 0.0;  // a profile has none: half its width over Student's t
  double lower = 0.0, upper = 0.0;
};

inline constexpr double kNullSingularValue = 1e-7;  // relative to the largest one

// Right singular vectors of a Jacobian, those of the null space last.
struct SingularDirections {
  Eigen::VectorXd singular;
  Eigen::MatrixXd v;
  int rank = 0;

  double Condition() const;  // of the first `rank`; infinite when there are none
};
SingularDirections Decompose(const Eigen::MatrixXd& jacobian,
                             double null_value = kNullSingularValue);

struct Covariance {
  SingularDirections directions;  // of the scaled Jacobian
  int naive_freedom = 1;          // rows of data less the rank
  double sigma = 0.0;             // residual standard deviation
  Eigen::MatrixXd inverse_hessian;
  Eigen::MatrixXd curvature;  // ResidualRows::curvature, where full_hessian
  // With second derivatives; J'J alone where they leave no minimum, and where feet step or columns
  // are many, of which they are not computed.
  bool full_hessian = false;
  Eigen::MatrixXd naive;
  // Clustered: recordings first, then priors, then pooled units. `these`: by recording, where
  // people are the clusters. Empty with fewer than two clusters.
  Scatter scatter, these;
  // One column for each of `recordings`: what leaving it out would move.
  Eigen::MatrixXd moves;
  std::vector<int> recordings;
  // Parts of the Hessian without the model's second derivatives, in the columns as they came: of
  // what the recordings say, of priors, of demands on the person, of pooling (and of a network's
  // ridge); the inverse of their sum; and the gradients of the second and third. All are positive,
  // so that they can be compared.
  Eigen::MatrixXd by_data, by_prior, by_settling, by_pooling, inverse_of_parts;
  Eigen::VectorXd prior_gradient, settling_gradient;
};

// unit: the size of one step in each column, for judging what counts as null; 0 holds a column. No
// scatter without clusters.
Covariance ComputeCovariance(const ResidualRows& score, const Eigen::VectorXd& unit,
                             const Clustering& clustering, double null_value = kNullSingularValue);

// The first of it alone: directions, sigma and what rows taken as independent scatter.
Covariance NaiveCovariance(const ResidualRows& score, const Eigen::VectorXd& unit,
                           double null_value = kNullSingularValue);

// The sums of some rows, by the point that they were evaluated at.
RecordingSums SumRows(const ResidualRows& score, const FitPoint& point,
                      const std::vector<int>& rows);

}  // namespace pushid
