// ident: cells of the tables of scores.
#include "ident/validation/score_cells.h"

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// A single recording has no error.
std::string ScoreText(double value, double error, const MeanScore& mean) {
  if (mean.recordings == 0) return "-";
  return Rounded(value, 3) + (mean.recordings > 1 ? " +- " + Rounded(error, 2) : "");
}

// None where a baseline failed in all of a group.
MeanScore MeanOfGroup(const std::map<std::string, MeanScore>& groups, const std::string& name) {
  const auto found = groups.find(name);
  return found == groups.end() ? MeanScore() : found->second;
}

// Before the name of a group.
std::string GroupTitle(const std::string& key, const ScoreSummary& summary) {
  if (key == kMagnitudeLabel) return "strength ";
  const bool one_of_several = key == kSubjectUnit && summary.propagation.recordings > 0;
  return (one_of_several ? "pushed person" : key) + " ";
}

}  // namespace

std::vector<std::string> MeanCells(const MeanScore& mean, const ShownMetrics& shown) {
  std::vector<std::string> cells;
  for (const HipMetric& metric : shown) {
    cells.push_back(ScoreText(mean.*metric.value, mean.error.*metric.value, mean));
  }
  return cells;
}

std::vector<std::string> PlainCells(const HipMetrics& metrics, const ShownMetrics& shown,
                                    bool known) {
  std::vector<std::string> cells;
  for (const HipMetric& metric : shown) {
    cells.push_back(known ? Rounded(metrics.*metric.value, 3) : "-");
  }
  return cells;
}

std::vector<std::string> Titles(const ShownMetrics& shown) {
  std::vector<std::string> titles;
  for (const HipMetric& metric : shown) titles.push_back(metric.Title());
  return titles;
}

std::vector<std::string> MetricNames(const ShownMetrics& shown) {
  std::vector<std::string> names;
  for (const HipMetric& metric : shown) names.push_back(metric.name);
  return names;
}

std::string Together(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : " / ") + cell;
  return text;
}

std::string MeanText(const MeanScore& mean, const ShownMetrics& shown) {
  return Together(MeanCells(mean, shown));
}

void Append(const std::vector<std::string>& cells, std::vector<std::string>* row) {
  row->insert(row->end(), cells.begin(), cells.end());
}

std::string ErrorsText(const ScoreSummary& summary) {
  if (summary.mean.clusters < 2) return "";
  const bool people = summary.mean.clustered_by == ClusterBy::kSubject;
  return "+-: standard errors over " +
         ClustersText(summary.mean.clustered_by, summary.mean.clusters) +
         (people ? "; within one person, over recordings" : "") + "\n";
}

TextTable TableOf(const std::vector<std::string>& header, size_t text_from) {
  std::vector<bool> left(header.size(), false);
  for (size_t i = 0; i < left.size(); ++i) left[i] = i == 0 || i >= text_from;
  return TextTable(header, left);
}

std::string ObservedText(const ScoreSummary& summary) {
  if (summary.observed == 0) return "";
  std::string text = "the first " + std::to_string(summary.observed) +
                     (summary.observed == 1 ? " frame was" : " frames were") +
                     " seen, which have no error; after_hipADE: mean over the others";
  if (!summary.bands) return text + "\n";
  const char* const axes[] = {" (x)", " (y)"};
  text += "\n90 % bands hold ";
  for (int i : {0, 1}) {
    const auto value = kBandMetrics[i].value;
    text += (i > 0 ? " and " : "") +
            ScoreText(summary.mean.*value, summary.mean.error.*value, summary.mean) + axes[i];
  }
  return text + " of these frames of the pushed person\n";
}

void AddGroups(const std::vector<const ScoreSummary*>& summaries, const ShownMetrics& shown,
               TextTable* table) {
  for (const auto& [key, groups] : summaries[0]->by) {
    if (groups.size() < 2) continue;
    for (const auto& [name, mean] : groups) {
      std::vector<std::string> row = {GroupTitle(key, *summaries[0]) + name,
                                      std::to_string(mean.recordings)};
      for (const ScoreSummary* one : summaries) {
        row.push_back(MeanText(MeanOfGroup(one->by.at(key), name), shown));
      }
      table->Add(row);
    }
  }
}

}  // namespace pushid
