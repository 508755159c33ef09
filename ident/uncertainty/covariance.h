// ident: clusters of standard errors (whose errors are independent of each other), how much the
// recordings weigh, and the covariance that the clusters leave.
//
// A person's pushes are answered by the same body and habits: the independent unit is the person.
// Where several people share a recording, errors go two ways: through the person into all of their
// recordings, and through the line-up (the same people in the same order), where the same pairs
// touch, into everybody in it. Neither lies within the other, so rows are clustered both ways
// (Cameron, Gelbach and Miller 2011):
//   V = V_people + V_line-ups - V_people-in-line-ups
// Rejected: one cluster for every set of people who share recordings. Of the published groups eight
// of nine people then make one cluster, and nothing can be said at all.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"

namespace pushid {

class FitProblem;
struct FitPoint;
struct RecordingSums;
struct ResidualRows;

// A person is an id, whatever they weighed that day.
struct Clusters {
  ClusterBy by = ClusterBy::kRecording;  // kAuto decided
  bool two_way = false;
  int people = 0;                    // different ones
  bool draws_people = false;         // every cluster is a person: errors are about people like them
  std::vector<std::string> names;    // of the clusters: people or recordings
  std::vector<std::vector<int>> of;  // cluster of every [recording][person]
  std::vector<int> line_up;  // of every recording; the recordings themselves where they are too few

  int count() const { return static_cast<int>(names.size()); }
};

// counts: how often each recording counts; those that do not are of no cluster. Empty: all do.
Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by,
                      const std::vector<int>& counts = {});

// With fewer clusters the standard errors are uncertain themselves.
inline constexpr int kFewClusters = 10;
// From fewer people nothing is identified about people like them.
inline constexpr int kFewestPeople = 4;

// Clusters of rows; -1: in none.
struct RowClusters {
  std::vector<int> of_row;
  int count = 0;
};
RowClusters ClusterByRecording(const ResidualRows& score);

// How the rows of data are clustered: one way, or two. recordings: where `first` is people.
struct Clustering {
  RowClusters first, recordings;
  int pooled_units = 0;         // whose deviations are draws
  bool priors_scatter = false;  // centres of priors are draws too, by their own width
  RowClusters line_ups = {};    // the second way; none: one way
};

// The rows of a problem's data by these clusters.
Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const ResidualRows& score);

// How much the recordings weigh against what was put in beside them.
//
// Sigmas. Each kind of residual (hip, velocity, angles, rates) is counted in its own robust scale:
// with e its d components in one frame, s^2 = median |e|^2 / median of chi-squared with d degrees
// of freedom, and at least the markers' noise. Velocities, angles and rates repeat much of what the
// hip's path says: their sigma is s / kRateWeight (chosen on the folds of the 32 single-person
// recordings: hipADE 0.090 m against 0.095 with all kinds alike; it leaves estimates of a right
// model unbiased).
//
// Effective frames. The errors of one recording last, and its nine residuals a frame err together,
// so the sum of their log densities is a composite likelihood: its maximum is right and its
// curvature is not. Data rows are divided by sqrt(lambda), so that curvature and score variance
// agree on average (first-moment adjustment: Rotnitzky and Jewell 1990; Varin, Reid and Firth 2011,
// section 3):
//   lambda = tr(H^-1 V_s) / tr(H^-1 H_data),   V_s = sum over recordings g of A_g s_g (A_g s_g)'
// with A_g s_g the leverage-adjusted scores of CR2. Where sigmas are estimated no frame counts as
// more than one. It assumes that recordings err independently of each other; that people do not is
// what the standard errors are clustered for.

inline constexpr double kRateWeight = 0.3;

// At a point near the optimum; the options' own where nothing can be told (all rollouts failed).
ResidualSigmas EstimateSigmas(const FitProblem& problem, const FitPoint& point);

// Independent frames a frame, for FitOptions::effective_weight. A single recording cannot tell: it
// counts as one frame. recordings: their sums by that weight, where they are known.
double EstimateEffectiveWeight(const FitProblem& problem, const FitPoint& point,
                               RecordingSums* recordings);

// An estimate scatters in independent parts, each known by its own degrees of freedom.
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

// Covariances of a least-squares estimate from its residuals and Jacobian alone, whatever model
// made them (the NIST reference sets go through here too). With s_g = J_g' r_g the score of cluster
// g, H = J'J + sum r d2r the Hessian of the cost at its minimum (the second term only where it was
// computed, residual_rows.h) and M_g = H^-1/2 J_g'J_g H^-1/2:
//   naive   (J'J)^-1 (sigma^2 J_d'J_d + J_b'J_b) (J'J)^-1, sigma^2 = |r_d|^2 / (N - rank): rows of
//           data (d) taken as independent, priors and demands (b) in units of their own
//   CR2     V = sum over g of D_g D_g', D_g centred,  D_g = H^-1/2 (1 - M_g)^-1/2 H^-1/2 s_g
//           (Bell & McCaffrey 2002; Pustejovsky & Tipton 2018, with the identity as working model)
//   df_c    Satterthwaite's degrees of freedom of c'Vc: with p_g = (1 - P_gg)^-1/2 J_g H^-1 c and
//           W_gh = p_g' (1 - P)_gh p_h,  P = J H^-1 J':  df = (sum W_gg)^2 / sum W_gh^2, at most
//           G - 1, as centred D_g have: few for a coefficient that leans on few of the clusters
//   parts   Deviations of pooled units are draws, and scatter by their own prior's spread:
//           H^-1 J_p'J_p H^-1. So does a prior's centre: where data say little the error is the
//           prior's width, where they say all it is the sandwich, and where the data's scores
//           scatter as their weight says it is the posterior's, H^-1.
//   moves   Leaving a recording out moves the estimate by H^-1 s_g G / (G - 1), one step with the
//           mean Hessian of the rest. Against refits of the 32 single-person recordings it is off
//           by 15 % (root mean square over all moves); by H less the recording's own J_g'J_g by
//           39 %, less its second derivatives too by 42 %, by J'J less J_g'J_g by 28 %.
// All by singular values, on the subspace that the rows determine; nothing is said of the rest. It
// is assumed that clusters are independent and the rest of the model right on average. Rejected, by
// the share of 95 % intervals that held the truth where recordings differ
// (tests/studies/coverage_study.cc): J'J alone for H, which the robust loss makes too large (73 to
// 88 %); the jackknife CR3 (96 to 98 %); the clusters' own second derivatives in M_g, which may
// leave H - H_g nearly singular (98 to 100 %).
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

// The sums of some rows, by the point that they were evaluated at.
RecordingSums SumRows(const ResidualRows& score, const FitPoint& point,
                      const std::vector<int>& rows);

}  // namespace pushid
