// ident: bands and drawn futures, fold by fold.
#include "ident/validation/held_out_spread.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/parameters/json_archive.h"
#include "ident/prediction/evaluation.h"

namespace pushid {
namespace {

// One held-out recording in one fold.
struct HeldScore {
  int recording = 0;
  std::vector<double> values;
};

HeldOutValues MeansOverRepeats(size_t recordings,
                               const std::vector<std::vector<HeldScore>>& by_fold) {
  std::vector<std::vector<const HeldScore*>> repeats(recordings);
  for (const std::vector<HeldScore>& fold : by_fold) {
    for (const HeldScore& held : fold) repeats[held.recording].push_back(&held);
  }
  HeldOutValues means;
  for (size_t i = 0; i < recordings; ++i) {
    if (repeats[i].empty()) continue;
    std::vector<double> mean(repeats[i][0]->values.size(), 0.0);
    const double share = 1.0 / static_cast<double>(repeats[i].size());
    for (const HeldScore* held : repeats[i]) {
      for (size_t k = 0; k < mean.size(); ++k) mean[k] += share * held->values[k];
    }
    means.recording.push_back(static_cast<int>(i));
    means.values.push_back(std::move(mean));
  }
  return means;
}

// visit(fold, recordings to fit, options): the folds run in parallel, each fit on one thread.
template <typename Visit>
void ForEachFold(const std::vector<PendulumRecording>& recordings, const std::vector<Fold>& folds,
                 FitOptions options, int num_threads, const JobProgress& progress, Visit visit) {
  options.num_threads = 1;
  ParallelFor(
      static_cast<int>(folds.size()), num_threads,
      [&](int f) { visit(f, Without(recordings, folds[f].held_out), options); }, progress);
}

}  // namespace

HeldOutFutures CrossValidateFutures(const std::string& name,
                                    const std::vector<PendulumRecording>& recordings,
                                    const std::vector<Fold>& folds, const FitOptions& options,
                                    int draws, uint64_t seed, int num_threads,
                                    const JobProgress& progress) {
  std::vector<std::vector<HeldScore>> by_fold(folds.size());
  std::vector<int> failed(folds.size(), 0);
  std::vector<char> fitted(folds.size(), 0);
  ForEachFold(
      recordings, folds, options, num_threads, progress,
      [&](int f, const std::vector<PendulumRecording>& training, const FitOptions& alone) {
        const Result<IdentifiedModel> solved = SolveModel(training, alone);
        if (!solved.ok()) return;
        fitted[f] = 1;
        const IdentifiedModel& model = solved.value();
        for (int i : folds[f].held_out) {
          const Result<Futures> futures =
              DrawFutures(model, recordings[i], draws, SeedOfRecording(seed, i));
          if (!futures.ok() || futures.value().paths.size() < 2) continue;  // counted below
          failed[f] += futures.value().failed;
          by_fold[f].push_back({i, ScoreFutures(model, recordings[i], futures.value()).Values()});
        }
      });
  HeldOutFutures all;
  all.folds_without_fit = static_cast<int>(std::count(fitted.begin(), fitted.end(), 0));
  all.held_out = MeansOverRepeats(recordings.size(), by_fold);
  int draws_failed = 0;
  for (int of_fold : failed) draws_failed += of_fold;
  const std::vector<PendulumRecording> scored = Picked(recordings, all.held_out.recording);
  all.summary = SummarizeFutures(name, scored, all.held_out.values, draws, draws_failed);
  all.summary.without = static_cast<int>(recordings.size() - scored.size());
  return all;
}

namespace {

// b less a, over the recordings that both have.
std::string DifferenceText(const std::vector<PendulumRecording>& recordings,
                           const HeldOutFutures& a, const HeldOutFutures& b) {
  std::vector<int> both;
  std::vector<std::vector<double>> apart(std::size(kFuturesMetrics));
  for (size_t i = 0; i < a.held_out.recording.size(); ++i) {
    const std::vector<int>& of_b = b.held_out.recording;
    const auto found = std::find(of_b.begin(), of_b.end(), a.held_out.recording[i]);
    if (found == of_b.end()) continue;
    both.push_back(*found);
    for (size_t k = 0; k < apart.size(); ++k) {
      apart[k].push_back(b.held_out.values[found - of_b.begin()][k] - a.held_out.values[i][k]);
    }
  }
  const ScoreClusters clusters = ClustersOf(Picked(recordings, both));
  TextTable table =
      TextTable::OfNumbers({b.summary.name + " less " + a.summary.name, "difference", "+-"});
  for (size_t k = 0; k < apart.size(); ++k) {
    const MeanAndError mean = clusters.Mean(apart[k]);
    table.Add({kFuturesMetrics[k].Title(), Rounded(mean.mean, 3), Rounded(mean.error, 2)});
  }
  return "\n" + table.ToString();
}

}  // namespace

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
  for (size_t k = 1; k < all.size(); ++k) text += DifferenceText(recordings, all[0], all[k]);
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
    json["mean"][kFuturesMetrics[i].Key()] = NumberJson(summary.mean[i].mean);
    json["mean"][kFuturesMetrics[i].ErrorKey()] = NumberJson(summary.mean[i].error);
  }
  return json;
}

namespace {

// The figures of BandCoverage, in the order of a recording's values.
constexpr int kBandFigures = 6;
std::array<MeanAndError*, kBandFigures> FiguresOf(BandCoverage* c) {
  return {&c->inside50[0], &c->inside50[1], &c->inside90[0],
          &c->inside90[1], &c->width90[0],  &c->width90[1]};
}

// Shares of the pushed person alone: bystanders of a single recording stand still, and groups err
// by contact. Empty where a rollout leaves the domain.
std::vector<double> CountInside(const PredictiveBands& bands, const IdentifiedModel& model,
                                const PendulumRecording& recording) {
  const Prediction rollout = Predict(model, recording);
  if (bands.people.empty() || !rollout.status.ok) return {};
  std::vector<double> values(kBandFigures, 0.0);
  const PathBand& band = bands.people[recording.pushed_person];
  const double share = 1.0 / (recording.num_frames() - 1);
  for (int t = 1; t < recording.num_frames(); ++t) {
    const Vector3<double>& hip = recording.hip[recording.pushed_person][t];
    for (int axis : {0, 1}) {
      const auto inside = [&](const auto& lower, const auto& upper) {
        return lower[t][axis] <= hip[axis] && hip[axis] <= upper[t][axis];
      };
      values[axis] += share * inside(band.lower50, band.upper50);
      values[2 + axis] += share * inside(band.lower90, band.upper90);
      values[4 + axis] += share * (band.upper90[t][axis] - band.lower90[t][axis]);
    }
  }
  return values;
}

BandCoverage MeanCoverage(const std::vector<PendulumRecording>& recordings,
                          const HeldOutValues& held, bool model_error) {
  BandCoverage coverage;
  coverage.model_error = model_error;
  coverage.recordings = static_cast<int>(held.recording.size());
  const ScoreClusters clusters = ClustersOf(Picked(recordings, held.recording));
  coverage.clusters = ClustersText(clusters.by, clusters.count);
  const auto figures = FiguresOf(&coverage);
  for (int k = 0; k < kBandFigures; ++k) {
    std::vector<double> column;
    for (const std::vector<double>& values : held.values) column.push_back(values[k]);
    *figures[k] = clusters.Mean(column);
  }
  return coverage;
}

std::string PlusMinus(const MeanAndError& value, double scale, const std::string& unit) {
  return Rounded(scale * value.mean, 3) + " +- " + Rounded(scale * value.error, 2) + " " + unit;
}

}  // namespace

std::vector<BandCoverage> CrossValidateBands(const std::vector<PendulumRecording>& recordings,
                                             const std::vector<Fold>& folds,
                                             const FitOptions& options, const BandOptions& bands,
                                             int num_threads, const JobProgress& progress) {
  // [without, with model error][fold]
  std::vector<std::vector<HeldScore>> by_fold[2];
  for (auto& of_kind : by_fold) of_kind.resize(folds.size());
  ForEachFold(
      recordings, folds, options, num_threads, progress,
      [&](int f, const std::vector<PendulumRecording>& training, FitOptions alone) {
        if (PrepareFit(training, &alone)) return;
        const FitResult result = Fit(training, alone);
        if (!result.ok()) return;
        const auto samples = SampleParameters(result, bands);
        const std::vector<ErrorPath> errors[] = {{}, ErrorPaths(result, training)};
        const IdentifiedModel model = ModelOf(result);
        for (int i : folds[f].held_out) {
          for (int with : {0, 1}) {
            std::vector<double> values = CountInside(
                ComputeBands(result, samples.value(), errors[with], recordings[i], bands.seed),
                model, recordings[i]);
            if (!values.empty()) by_fold[with][f].push_back({i, std::move(values)});
          }
        }
      });
  std::vector<BandCoverage> coverage;
  for (int with : {0, 1}) {
    coverage.push_back(
        MeanCoverage(recordings, MeansOverRepeats(recordings.size(), by_fold[with]), with == 1));
  }
  return coverage;
}

std::string BandCoverageText(const std::vector<BandCoverage>& coverage) {
  TextTable table({"bands of", "axis", "inside 50 %", "inside 90 %", "mean width of 90 %, m"},
                  {true, true, false, false, false});
  for (const BandCoverage& c : coverage) {
    for (int axis : {0, 1}) {
      table.Add({c.model_error ? "parameters and model error" : "parameters alone",
                 axis == 0 ? "x" : "y", PlusMinus(c.inside50[axis], 100.0, "%"),
                 PlusMinus(c.inside90[axis], 100.0, "%"), Rounded(c.width90[axis].mean, 3)});
    }
  }
  return table.ToString() + "share of held-out frames of " +
         std::to_string(coverage.empty() ? 0 : coverage[0].recordings) +
         " recordings whose measured hip lies in the predictive bands; standard errors over " +
         (coverage.empty() ? "" : coverage[0].clusters) + "\n";
}

}  // namespace pushid
