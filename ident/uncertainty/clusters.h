// ident: whose errors are independent of each other: the clusters of standard errors.
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
  int people = 0;                  // different ones
  bool draws_people = false;       // every cluster is a person: errors are about people like them
  std::vector<std::string> names;  // of the clusters: people or recordings
  // Cluster of every [recording][person].
  std::vector<std::vector<int>> of;
  // Line-up of every recording; the recordings themselves where line-ups are too few.
  std::vector<int> line_up;

  int count() const { return static_cast<int>(names.size()); }
};

// counts: how often each recording counts; those that do not are of no cluster. Empty: all do.
Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by,
                      const std::vector<int>& counts = {});

// With fewer clusters the standard errors are uncertain themselves.
inline constexpr int kFewClusters = 10;
// From fewer people nothing is identified about people like them.
inline constexpr int kFewestPeople = 4;

// The covariance that clusters of rows leave, and how well it is itself known.
//
// With s_g = J_g' r_g the score of cluster g, H the Hessian of the cost at its minimum and
// M_g = H^-1/2 J_g'J_g H^-1/2:
//   CR2     V = sum over g of D_g D_g', D_g centred,  D_g = H^-1/2 (1 - M_g)^-1/2 H^-1/2 s_g
//           (Bell & McCaffrey 2002; Pustejovsky & Tipton 2018, with the identity as working model)
//   df_c    Satterthwaite's degrees of freedom of c'Vc: with p_g = (1 - P_gg)^-1/2 J_g H^-1 c and
//           W_gh = p_g' (1 - P)_gh p_h,  P = J H^-1 J':  df = (sum W_gg)^2 / sum W_gh^2, at most
//           G - 1, as centred D_g have
// It assumes that clusters are independent and the rest of the model right on average. A
// coefficient that leans on few of the clusters has few degrees of freedom, however many clusters
// there are.
//
// Rejected, by the share of 95 % intervals that held the truth where recordings differ
// (tests/studies/coverage_study.cc): J'J alone for H, which the robust loss makes too large (73 to
// 88 %); the jackknife CR3 (96 to 98 %); the clusters' own second derivatives in M_g, which may
// leave H - H_g nearly singular (98 to 100 %).

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

// J_g'J_g = F_g'F_g and s_g of every cluster that has rows, in the coordinates of `base`'s columns.
// F_g has no more rows than J_g has columns that are not zero: few where units have columns of
// their own.
struct ClusterScores {
  std::vector<Eigen::MatrixXd> factors;
  Eigen::MatrixXd scores;  // a column for each
};
ClusterScores GatherScores(const ResidualRows& score, const RowClusters& clusters,
                           const Eigen::MatrixXd& base);

// hessian: of the cost, in the same coordinates. coefficients: rows c whose freedom is asked for.
struct ClusteredCovariance {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd freedom;  // of each coefficient; 1 to G - 1
};
ClusteredCovariance Cr2(const ClusterScores& scores, const Eigen::MatrixXd& hessian,
                        const Eigen::MatrixXd& coefficients);

// How much the recordings weigh against what was put in beside them.
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

inline constexpr double kRateWeight = 0.3;

// At a point near the optimum; the options' own where nothing can be told (all rollouts failed).
ResidualSigmas EstimateSigmas(const FitProblem& problem, const FitPoint& point);

// Independent frames a frame, for FitOptions::effective_weight. A single recording cannot tell: it
// counts as one frame. recordings: their sums by that weight, where they are known.
double EstimateEffectiveWeight(const FitProblem& problem, const FitPoint& point,
                               RecordingSums* recordings);

}  // namespace pushid
