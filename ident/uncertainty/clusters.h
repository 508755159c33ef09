// ident: whose errors are independent of each other: the clusters of standard errors.
//
// A person's pushes are answered by the same body and habits: the independent unit is the person.
// Where several people share a recording, errors go two ways: through the person into all of their
// recordings, and through the event (one push, one line of people) into everybody in it. Neither
// lies within the other, so rows are clustered both ways (Cameron, Gelbach and Miller 2011):
//   V = V_people + V_recordings - V_people-in-recordings
// Rejected: one cluster for every set of people who share recordings. Of the published groups eight
// of nine people then make one cluster, and nothing can be said at all.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"

namespace pushid {

struct Clusters {
  ClusterBy by = ClusterBy::kRecording;  // kAuto decided
  bool two_way = false;
  int people = 0;                  // different ones
  bool draws_people = false;       // every cluster is a person: errors are about people like them
  std::vector<std::string> names;  // of the clusters: people or recordings
  // Cluster of every [recording][person].
  std::vector<std::vector<int>> of;

  int count() const { return static_cast<int>(names.size()); }
};

// A person is an id and a mass: who goes by one id with two masses is two people.
std::string PersonKey(const PendulumRecording& recording, int person);

// counts: how often each recording counts; those that do not are of no cluster. Empty: all do.
Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by,
                      const std::vector<int>& counts = {});

// Of fewer clusters the standard errors are uncertain themselves.
inline constexpr int kFewClusters = 10;
// Of fewer people nothing is identified about people like them.
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
RowClusters ClusterByRecording(const JacobianBlocks& score);

// How the rows of data are clustered: one way, or two. recordings: where `first` is people.
struct Clustering {
  RowClusters first, recordings;
  int pooled_units = 0;         // whose deviations are draws
  bool priors_scatter = false;  // centres of priors are draws too, by their own width
  bool two_way = false;
};

// The rows of a problem's data by these clusters.
Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const JacobianBlocks& score);

// J_g'J_g = F_g'F_g and s_g of every cluster that has rows, in the coordinates of `base`'s columns.
// F_g has no more rows than J_g has columns that are not zero: few where units have columns of
// their own.
struct ClusterScores {
  std::vector<Eigen::MatrixXd> factors;
  Eigen::MatrixXd scores;  // a column for each
};
ClusterScores GatherScores(const JacobianBlocks& score, const RowClusters& clusters,
                           const Eigen::MatrixXd& base);

// hessian: of the cost, in the same coordinates. coefficients: rows c whose freedom is asked for.
struct ClusteredCovariance {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd freedom;  // of each coefficient; 1 to G - 1
};
ClusteredCovariance Cr2(const ClusterScores& scores, const Eigen::MatrixXd& hessian,
                        const Eigen::MatrixXd& coefficients);

}  // namespace pushid
