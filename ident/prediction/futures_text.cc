// ident: drawn futures and their scores in words and files.
#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/files/atomic_file.h"
#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/prediction/futures.h"
#include "ident/uncertainty/bootstrap.h"

namespace pushid {
namespace {

// "0: 0.05, 1: 0.62, 2: 0.33"
std::string StepShares(const Futures& futures, size_t person) {
  std::map<int, int> counts;
  for (const std::vector<int>& draw : futures.steps) ++counts[draw[person]];
  std::string text;
  for (const auto& [steps, count] : counts) {
    text += (text.empty() ? "" : ", ") + std::to_string(steps) + ": " +
            Rounded(count / static_cast<double>(futures.steps.size()), 2);
  }
  return text;
}

}  // namespace

std::string LastFrameText(const Futures& futures) {
  std::vector<std::string> titles = {"person", "x m", "5 %", "95 %", "y m", "5 %", "95 %"};
  std::vector<bool> left(titles.size(), false);
  if (!futures.steps.empty()) titles.push_back("steps: share"), left.push_back(true);
  TextTable table(titles, left);
  if (futures.paths.empty()) return "";
  for (size_t n = 0; n < futures.paths[0].size(); ++n) {
    std::vector<std::string> row = {std::to_string(n)};
    for (int axis : {0, 1}) {
      std::vector<double> values;
      for (const auto& draw : futures.paths) values.push_back(draw[n].back()[axis]);
      for (double share : {0.5, 0.05, 0.95}) row.push_back(Rounded(Quantile(values, share), 3));
    }
    if (!futures.steps.empty()) row.push_back(StepShares(futures, n));
    table.Add(row);
  }
  return table.ToString();
}

MaybeError WriteFuturesCsv(const std::string& file, const Futures& futures) {
  std::string text = "draw,frame,person,hip_x,hip_y,hip_z,theta,phi\n";
  for (size_t d = 0; d < futures.paths.size(); ++d) {
    for (size_t n = 0; n < futures.paths[d].size(); ++n) {
      for (size_t t = 0; t < futures.paths[d][n].size(); ++t) {
        text += std::to_string(d) + "," + std::to_string(t) + "," + std::to_string(n);
        for (double value : futures.paths[d][n][t]) text += "," + DoubleText(value);
        text += "\n";
      }
    }
  }
  return WriteFileAtomically(file, text);
}

std::string FuturesText(const std::vector<FuturesSummary>& summaries) {
  std::vector<std::string> titles = {"drawn futures"};
  std::vector<bool> left = {true};
  for (const FuturesSummary& summary : summaries) {
    titles.push_back(summary.name);
    titles.push_back("+-");
    left.insert(left.end(), 2, false);
  }
  TextTable table(titles, left);
  for (size_t i = 0; i < std::size(kFuturesMetrics); ++i) {
    const bool known = std::any_of(
        summaries.begin(), summaries.end(),
        [i](const FuturesSummary& summary) { return !std::isnan(summary.mean[i].mean); });
    if (!known) continue;  // the deviance of who draws nothing but supports
    std::vector<std::string> row = {kFuturesMetrics[i].Title()};
    for (const FuturesSummary& summary : summaries) {
      row.push_back(Rounded(summary.mean[i].mean, 3));
      row.push_back(Rounded(summary.mean[i].error, 2));
    }
    table.Add(row);
  }
  std::string text = table.ToString();
  for (const FuturesSummary& summary : summaries) {
    text += (summary.name.empty() ? "" : summary.name + ": ") + std::to_string(summary.draws) +
            " draws for each of " + std::to_string(summary.recordings) + " recordings, errors by " +
            summary.clusters;
    if (summary.failed > 0) {
      text += "; " + std::to_string(summary.failed) + " draws left the model's domain";
    }
    if (summary.without > 0) {
      text += "; " + std::to_string(summary.without) +
              " recordings have fewer than two draws that stay in it, and are left out";
    }
    text += "\n";
  }
  return text +
         "inside: share of frames within the central 50 or 90 %; crps, energy: the less the "
         "better;\ndeviance: -2 log innovation likelihood of one measured number\n";
}

}  // namespace pushid
