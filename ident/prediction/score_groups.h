// ident: whose scores are independent of each other, and the standard errors of their means.
//
// A person answers every push with the same body and habits, and a model misses one person's
// recordings alike. So where people were pushed more than once the clusters of a mean's error are
// the pushed people, otherwise the recordings; within one person they are recordings, which says
// nothing about anybody else. With G clusters and scores of weights w that sum to 1,
//   error = sqrt(G / (G - 1) * sum over clusters of (sum of w (score - mean))^2)
// with Student's t of G - 1 degrees of freedom behind it (CR1; clustered_covariance.h has the
// fit's).
#pragma once

#include <string>
#include <vector>

#include "ident/parameters/fit_options.h"

namespace pushid {

struct ScoreClusters {
  ClusterBy by = ClusterBy::kRecording;  // or kSubject
  int count = 0;
  std::vector<int> of;  // cluster of each score

  // deviations: w (score - mean) of each. 0 of a single cluster.
  double ErrorOfMean(const std::vector<double>& deviations) const;
};

// pushed: who was pushed, for each score (PersonKey, clusters.h).
ScoreClusters ClustersOf(const std::vector<std::string>& pushed);

// "4 people", "32 recordings"
std::string ClustersText(ClusterBy by, int count);

}  // namespace pushid
