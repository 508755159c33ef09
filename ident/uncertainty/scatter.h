// ident: what an estimate scatters by, in independent parts, and intervals of their sum.
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
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

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
  // Of a sum of columns: each part by the least freedom of the columns in it.
  ScatterOf Of(const Eigen::VectorXd& coefficients) const;
  ScatterOf OfColumn(Eigen::Index column) const;
};

// A number's error and 95 % interval, natural unit.
struct Interval {
  double standard_error = 0.0;  // a profile has none: half its width over Student's t
  double lower = 0.0, upper = 0.0;
};

}  // namespace pushid
