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

#include <string>
#include <vector>

#include "ident/uncertainty/covariance.h"

namespace pushid {

struct Clusters {
  ClusterBy by = ClusterBy::kRecording;  // kAuto decided
  bool two_way = false;
  std::vector<std::string> names;  // of the clusters: people or recordings
  // Cluster of every [recording][person].
  std::vector<std::vector<int>> of;

  int count() const { return static_cast<int>(names.size()); }
};

// The same of a problem's rows of data.
Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const JacobianBlocks& score);

// A person is an id and a mass: who goes by one id with two masses is two people.
std::string PersonKey(const PendulumRecording& recording, int person);

Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by);

}  // namespace pushid
