// ident: the errors of a fit, by recording and by person.
#include "ident/validation/error_parts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "ident/problem/fit_problem.h"
#include "ident/uncertainty/clusters.h"
#include "ident/uncertainty/covariance.h"

namespace pushid {
namespace {

// Who is pushed in each recording, as consecutive numbers.
std::vector<int> PushedPeople(const std::vector<PendulumRecording>& recordings) {
  std::map<std::string, int> known;
  std::vector<int> people;
  for (const PendulumRecording& r : recordings) {
    people.push_back(
        known.emplace(PersonKey(r, r.pushed_person), static_cast<int>(known.size())).first->second);
  }
  return people;
}

JacobianBlocks Clustered(JacobianBlocks score, const std::vector<int>& cluster_of_recording) {
  for (int& cluster : score.cluster_of_row) {
    if (cluster >= 0) cluster = cluster_of_recording[cluster];
  }
  score.clusters.clear();
  for (int cluster : score.cluster_of_row) {
    if (cluster >= 0) score.clusters.push_back(cluster);
  }
  std::sort(score.clusters.begin(), score.clusters.end());
  score.clusters.erase(std::unique(score.clusters.begin(), score.clusters.end()),
                       score.clusters.end());
  return score;
}

// By the clusters that the rows name.
Covariance ByClusters(const JacobianBlocks& score, const Eigen::VectorXd& unit) {
  return ComputeCovariance(score, unit, {ClusterByRecording(score), {}, 0, false});
}

}  // namespace

ErrorParts ErrorPartsAt(const FitProblem& problem, const FitPoint& estimate) {
  ScoredFit fit = ScoreAt(problem, estimate);
  ErrorParts parts;
  parts.person = PushedPeople(problem.recordings());
  const Covariance by_person = ByClusters(Clustered(fit.score, parts.person), fit.unit);
  std::vector<int> each(parts.person.size());
  std::iota(each.begin(), each.end(), 0);
  parts.score = Clustered(std::move(fit.score), each);
  const Covariance by_recording = ByClusters(parts.score, fit.unit);
  parts.sigma = by_recording.sigma;
  parts.naive = by_recording.naive;
  parts.by_recording = by_recording.clustered;
  parts.by_person = by_person.clustered;
  return parts;
}

}  // namespace pushid
