// ident: people and recordings as clusters.
#include "ident/uncertainty/clusters.h"

#include <map>

#include "datasets/files/number_text.h"

namespace pushid {

std::string PersonKey(const PendulumRecording& recording, int person) {
  const double mass = recording.scene.people[person].body.mass;
  return recording.subject_ids[person] + " " + DoubleText(mass);
}

Clusters MakeClusters(const std::vector<PendulumRecording>& recordings, ClusterBy by) {
  std::map<std::string, int> times, index;
  bool repeated = false, shared = false;
  for (const PendulumRecording& r : recordings) {
    shared = shared || r.num_people() > 1;
    for (int n = 0; n < r.num_people(); ++n) repeated = ++times[PersonKey(r, n)] > 1 || repeated;
  }
  Clusters clusters;
  clusters.by = by;
  if (by == ClusterBy::kAuto) {
    clusters.by = repeated && times.size() > 1 ? ClusterBy::kSubject : ClusterBy::kRecording;
  }
  const bool people = clusters.by == ClusterBy::kSubject;
  clusters.two_way = people && shared;
  for (size_t i = 0; i < recordings.size(); ++i) {
    const PendulumRecording& r = recordings[i];
    std::vector<int> of;
    for (int n = 0; n < r.num_people(); ++n) {
      const std::string key = people ? PersonKey(r, n) : std::to_string(i);
      const auto [found, added] = index.emplace(key, clusters.count());
      if (added) clusters.names.push_back(people ? r.subject_ids[n] : r.id);
      of.push_back(found->second);
    }
    clusters.of.push_back(std::move(of));
  }
  return clusters;
}

Clustering ClusterRows(const FitProblem& problem, const Clusters& clusters,
                       const JacobianBlocks& score) {
  Clustering rows;
  rows.priors_scatter = true;
  rows.pooled_units =
      problem.map().num_deviations > 0 ? static_cast<int>(problem.NominalPoint().unit.size()) : 0;
  rows.first.count = clusters.count();
  for (size_t row = 0; row < score.cluster_of_row.size(); ++row) {
    const int recording = score.cluster_of_row[row];
    if (recording < 0) {
      rows.first.of_row.push_back(-1);
      continue;
    }
    rows.first.of_row.push_back(clusters.of[recording][score.person_of_row[row]]);
  }
  if (clusters.two_way) rows.second = ClusterByRecording(score);
  return rows;
}

}  // namespace pushid
