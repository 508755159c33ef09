// ident: clusters of scores.
#include "ident/prediction/score_clusters.h"

#include <cmath>
#include <map>
#include <numeric>

namespace pushid {

double ScoreClusters::ErrorOfMean(const std::vector<double>& deviations) const {
  if (count < 2) return 0.0;
  std::vector<double> sums(count, 0.0);
  for (size_t i = 0; i < deviations.size(); ++i) sums[of[i]] += deviations[i];
  double squares = 0.0;
  for (double sum : sums) squares += sum * sum;
  return std::sqrt(squares * count / (count - 1.0));
}

ScoreClusters ClustersOf(const std::vector<std::string>& pushed) {
  ScoreClusters clusters;
  std::map<std::string, int> people;
  for (const std::string& person : pushed) {
    clusters.of.push_back(people.emplace(person, static_cast<int>(people.size())).first->second);
  }
  clusters.count = static_cast<int>(people.size());
  if (clusters.count > 1 && people.size() < pushed.size()) {
    clusters.by = ClusterBy::kSubject;
    return clusters;
  }
  clusters.count = static_cast<int>(pushed.size());
  std::iota(clusters.of.begin(), clusters.of.end(), 0);
  return clusters;
}

std::string ClustersText(ClusterBy by, int count) {
  const bool people = by == ClusterBy::kSubject;
  const char* const what =
      people ? (count == 1 ? " person" : " people") : (count == 1 ? " recording" : " recordings");
  return std::to_string(count) + what;
}

}  // namespace pushid
