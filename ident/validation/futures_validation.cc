// ident: drawn futures fold by fold.
#include "ident/validation/futures_validation.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/model/json_pieces.h"
#include "ident/prediction/score_groups.h"
#include "ident/problem/time_series.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

struct HeldScore {
  int recording = 0, failed = 0;
  FuturesScore score;
};

std::vector<PendulumRecording> AllBut(const std::vector<PendulumRecording>& recordings,
                                      const std::vector<int>& out) {
  std::vector<PendulumRecording> rest;
  for (int i = 0; i < static_cast<int>(recordings.size()); ++i) {
    if (std::find(out.begin(), out.end(), i) == out.end()) rest.push_back(recordings[i]);
  }
  return rest;
}

FuturesScore Mean(const std::vector<HeldScore>& repeats) {
  FuturesScore mean;
  const double share = 1.0 / static_cast<double>(repeats.size());
  for (const HeldScore& held : repeats) {
    for (int i = 0; i < 4; ++i) {
      mean.inside50[i] += share * held.score.inside50[i];
      mean.inside90[i] += share * held.score.inside90[i];
      mean.crps[i] += share * held.score.crps[i];
    }
    mean.energy += share * held.score.energy;
    mean.deviance += share * held.score.deviance;
  }
  return mean;
}

}  // namespace

HeldOutFutures CrossValidateFutures(const std::string& name,
                                    const std::vector<PendulumRecording>& recordings,
                                    const std::vector<Fold>& folds, const FitOptions& options,
                                    int draws, uint64_t seed, int num_threads,
                                    const JobProgress& progress) {
  FitOptions alone = options;
  alone.num_threads = 1;  // the folds run in parallel
  std::vector<std::vector<HeldScore>> by_fold(folds.size());
  std::vector<char> fitted(folds.size(), 0);
  ParallelFor(
      static_cast<int>(folds.size()), num_threads,
      [&](int f) {
        const Result<SolvedModel> solved = SolveModel(AllBut(recordings, folds[f].held_out), alone);
        if (!solved.ok()) return;
        fitted[f] = 1;
        for (int i : folds[f].held_out) {
          const Result<Futures> futures =
              DrawFutures(solved.value().model, recordings[i], draws, SeedOfRecording(seed, i));
          if (!futures.ok() || futures.value().paths.size() < 2) continue;  // counted below
          by_fold[f].push_back(
              {i, futures.value().failed,
               ScoreFutures(solved.value().model, recordings[i], futures.value())});
        }
      },
      progress);
  HeldOutFutures all;
  int failed = 0;
  std::vector<std::vector<HeldScore>> by_recording(recordings.size());
  for (size_t f = 0; f < folds.size(); ++f) {
    all.folds_without_fit += fitted[f] == 0;
    for (const HeldScore& held : by_fold[f]) {
      by_recording[held.recording].push_back(held);
      failed += held.failed;
    }
  }
  std::vector<PendulumRecording> scored;
  for (size_t i = 0; i < recordings.size(); ++i) {
    if (by_recording[i].empty()) continue;
    scored.push_back(recordings[i]);
    all.recording.push_back(static_cast<int>(i));
    all.held_out.push_back(Mean(by_recording[i]));
  }
  all.summary = SummarizeFutures(name, scored, all.held_out, draws, failed);
  all.summary.without = static_cast<int>(recordings.size() - scored.size());
  return all;
}

std::string HeldOutFuturesText(const std::vector<PendulumRecording>& recordings,
                               const std::vector<HeldOutFutures>& all) {
  std::vector<FuturesSummary> summaries;
  for (const HeldOutFutures& one : all) summaries.push_back(one.summary);
  std::string text = FuturesText(summaries);
  for (const HeldOutFutures& one : all) {
    if (one.folds_without_fit == 0) continue;
    text += one.summary.name + ": " + std::to_string(one.folds_without_fit) +
            " folds had no fit and are left out\n";
  }
  for (size_t k = 1; k < all.size(); ++k) {
    std::vector<PendulumRecording> both;
    std::vector<FuturesScore> first, other;
    for (size_t i = 0; i < all[0].recording.size(); ++i) {
      const auto& of = all[k].recording;
      const auto found = std::find(of.begin(), of.end(), all[0].recording[i]);
      if (found == of.end()) continue;
      both.push_back(recordings[*found]);
      first.push_back(all[0].held_out[i]);
      other.push_back(all[k].held_out[found - of.begin()]);
    }
    std::vector<std::string> pushed;
    for (const PendulumRecording& r : both) pushed.push_back(PersonKey(r, r.pushed_person));
    const ScoreClusters clusters = ClustersOf(pushed);
    TextTable table = TextTable::OfNumbers(
        {all[k].summary.name + " less " + all[0].summary.name, "difference", "+-"});
    for (const FuturesMetric& metric : kFuturesMetrics) {
      std::vector<double> apart, deviations;
      for (size_t i = 0; i < both.size(); ++i) {
        apart.push_back(metric.value(other[i]) - metric.value(first[i]));
      }
      const double mean = MeanOf(apart).mean;
      for (double value : apart) deviations.push_back((value - mean) / apart.size());
      table.Add({metric.Title(), Rounded(mean, 3), Rounded(clusters.ErrorOfMean(deviations), 2)});
    }
    text += "\n" + table.ToString();
  }
  return text;
}

nlohmann::ordered_json ToJson(const FuturesSummary& summary) {
  nlohmann::ordered_json json = {{"name", summary.name},
                                 {"recordings", summary.recordings},
                                 {"draws", summary.draws},
                                 {"failed", summary.failed},
                                 {"recordings_left_out", summary.without},
                                 {"clusters", summary.clusters}};
  for (size_t i = 0; i < std::size(kFuturesMetrics); ++i) {
    json["mean"][kFuturesMetrics[i].Key()] = NumberJson(summary.mean[i]);
    json["mean"][kFuturesMetrics[i].ErrorKey()] = NumberJson(summary.error[i]);
  }
  return json;
}

}  // namespace pushid
