// ident: scores by label, and whose scores are independent of each other: the standard errors of
// their means.
//
// A person answers every push with the same body and habits, and a model misses one person's
// recordings alike. So where people were pushed more than once the clusters of a mean's error are
// the pushed people, otherwise the recordings; within one person they are recordings, which says
// nothing about anybody else. With G clusters and scores of weights w that sum to 1,
//   error = sqrt(G / (G - 1) * sum over clusters of (sum of w (score - mean))^2)
// with Student's t of G - 1 degrees of freedom (CR1; clusters.h has the fit's).
#pragma once

#include <map>
#include <nlohmann/ordered_map.hpp>
#include <string>
#include <utility>
#include <vector>

#include "datasets/loading/pendulum_recording.h"
#include "ident/parameters/fit_options.h"
#include "ident/problem/statistics.h"

namespace pushid {

struct ScoreClusters {
  ClusterBy by = ClusterBy::kRecording;  // or kSubject
  int count = 0;
  std::vector<int> of;  // cluster of each score

  // deviations: w (score - mean) of each. 0 of a single cluster.
  double ErrorOfMean(const std::vector<double>& deviations) const;
  // Of one value for each score, all of one weight.
  MeanAndError Mean(const std::vector<double>& values) const;
};

// pushed: who was pushed, for each score (PersonKey, clusters.h).
ScoreClusters ClustersOf(const std::vector<std::string>& pushed);
ScoreClusters ClustersOf(const std::vector<PendulumRecording>& recordings);

// "4 people", "32 recordings"
std::string ClustersText(ClusterBy by, int count);

// What scores are grouped by: `subject`, who was pushed, or any label that a manifest gives.
using LabelKeys = std::vector<std::string>;
LabelKeys UsualGroups();  // magnitude, subject, setting
// From "setting,footwear", and back.
LabelKeys ParseLabelKeys(const std::string& list);
std::string LabelKeysText(const LabelKeys& keys);

// Error: a key that is not `subject` and that no recording has; not of the usual ones.
MaybeError CheckGroups(const std::vector<PendulumRecording>& recordings, const LabelKeys& keys);

// What recordings are called by a key, one text each; empty where they have no such label. People
// of one name and two masses are two.
std::vector<std::string> GroupNames(const std::vector<PendulumRecording>& recordings,
                                    const std::string& key);

// A value for each group: [key][text of the label], keys in the order of the list.
template <typename T>
using ByLabel = nlohmann::ordered_map<std::string, std::map<std::string, T>>;

// of: the value of a list of scores. Scores that failed are in no group.
template <typename Score, typename Of>
auto GroupScores(const std::vector<PendulumRecording>& recordings, const std::vector<Score>& scores,
                 const LabelKeys& keys, Of of) {
  using Group = std::vector<const Score*>;
  ByLabel<decltype(of(Group()))> by;
  for (const std::string& key : keys) {
    const std::vector<std::string> names = GroupNames(recordings, key);
    std::map<std::string, Group> groups;
    for (size_t i = 0; i < scores.size(); ++i) {
      if (scores[i].failure.empty() && !names[i].empty()) groups[names[i]].push_back(&scores[i]);
    }
    auto& of_key = by[key];
    for (const auto& [name, group] : groups) of_key[name] = of(group);
  }
  return by;
}

// By key: how many scores are in none of its groups, for want of the label; only where others have
// it. Scores that failed do not count.
using WithoutLabel = std::map<std::string, int>;

template <typename Score>
WithoutLabel CountWithoutLabel(const std::vector<PendulumRecording>& recordings,
                               const std::vector<Score>& scores, const LabelKeys& keys) {
  WithoutLabel counts;
  for (const std::string& key : keys) {
    const std::vector<std::string> names = GroupNames(recordings, key);
    int with = 0, without = 0;
    for (size_t i = 0; i < scores.size(); ++i) {
      if (scores[i].failure.empty()) ++(names[i].empty() ? without : with);
    }
    if (with > 0 && without > 0) counts[key] = without;
  }
  return counts;
}

// A line for each key: "2 recordings have no setting: they are in no group by setting"
std::string WithoutLabelText(const WithoutLabel& counts);

}  // namespace pushid
