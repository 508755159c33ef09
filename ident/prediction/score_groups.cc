// ident: groups and clusters of scores.
#include "ident/prediction/score_groups.h"

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "datasets/files/number_text.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {

double ScoreClusters::ErrorOfMean(const std::vector<double>& deviations) const {
  if (count < 2) return 0.0;
  std::vector<double> sums(count, 0.0);
  for (size_t i = 0; i < deviations.size(); ++i) sums[of[i]] += deviations[i];
  double squares = 0.0;
  for (double sum : sums) squares += sum * sum;
  return std::sqrt(squares * count / (count - 1.0));
}

MeanAndError ScoreClusters::Mean(const std::vector<double>& values) const {
  const double mean = MeanOf(values).mean, n = static_cast<double>(values.size());
  std::vector<double> deviations;
  for (double value : values) deviations.push_back((value - mean) / n);
  return {mean, ErrorOfMean(deviations)};
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

ScoreClusters ClustersOf(const std::vector<PendulumRecording>& recordings) {
  std::vector<std::string> pushed;
  for (const PendulumRecording& r : recordings) pushed.push_back(PersonKey(r, r.pushed_person));
  return ClustersOf(pushed);
}

std::string ClustersText(ClusterBy by, int count) {
  const bool people = by == ClusterBy::kSubject;
  const char* const what =
      people ? (count == 1 ? " person" : " people") : (count == 1 ? " recording" : " recordings");
  return std::to_string(count) + what;
}

LabelKeys UsualGroups() { return {kMagnitudeLabel, kSubjectUnit, kSettingLabel}; }

LabelKeys ParseLabelKeys(const std::string& list) {
  LabelKeys keys;
  std::stringstream words(list);
  for (std::string key; std::getline(words, key, ',');) keys.emplace_back(Trimmed(key));
  return keys;
}

std::string LabelKeysText(const LabelKeys& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ",") + key;
  return text;
}

MaybeError CheckGroups(const std::vector<PendulumRecording>& recordings, const LabelKeys& keys) {
  if (keys == UsualGroups()) return std::nullopt;  // any of these may be absent
  std::set<std::string> seen;
  for (const std::string& key : keys) {
    const std::string list = "--group_by=" + LabelKeysText(keys);
    if (key.empty()) return Error{list + " has an empty name; give labels with one comma between"};
    if (!seen.insert(key).second) return Error{list + " names '" + key + "' twice"};
    if (MaybeError error = CheckLabel(recordings, "group_by", key, kSubjectUnit)) return error;
  }
  return std::nullopt;
}

std::string WithoutLabelText(const WithoutLabel& counts) {
  std::string text;
  for (const auto& [key, count] : counts) {
    text += std::to_string(count) + " recording" + (count == 1 ? " has" : "s have") + " no " + key +
            ": " + (count == 1 ? "it is" : "they are") + " in no group by " + key + "\n";
  }
  return text;
}

std::vector<std::string> GroupNames(const std::vector<PendulumRecording>& recordings,
                                    const std::string& key) {
  std::vector<std::string> names;
  if (key != kSubjectUnit) {
    for (const PendulumRecording& r : recordings) names.push_back(r.labels.Of(key));
    return names;
  }
  std::map<std::string, std::set<std::string>> people;
  for (const PendulumRecording& r : recordings) {
    people[r.subject_ids[r.pushed_person]].insert(PersonKey(r, r.pushed_person));
  }
  for (const PendulumRecording& r : recordings) {
    const std::string& name = r.subject_ids[r.pushed_person];
    names.push_back(people[name].size() > 1 ? PersonKey(r, r.pushed_person) + " kg" : name);
  }
  return names;
}

}  // namespace pushid
