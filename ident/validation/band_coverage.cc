// ident: do predictive bands hold what was not fitted?
#include <algorithm>
#include <cmath>

#include "datasets/files/number_text.h"
#include "ident/figures/text_table.h"
#include "ident/fit/fit.h"
#include "ident/prediction/evaluation.h"
#include "ident/prediction/predictive_bands.h"
#include "ident/prediction/score_groups.h"
#include "ident/problem/time_series.h"
#include "ident/uncertainty/clusters.h"

namespace pushid {
namespace {

// Of one held-out recording.
struct HeldCoverage {
  bool ok = false;
  double inside50[2] = {0.0, 0.0}, inside90[2] = {0.0, 0.0}, width90[2] = {0.0, 0.0};
  double median_ade = 0.0, rollout_ade = 0.0;
};

// Of the pushed person: bystanders of a single recording stand still, and groups err by contact.
HeldCoverage CountInside(const PredictiveBands& bands, const IdentifiedModel& model,
                         const PendulumRecording& recording) {
  HeldCoverage held;
  const Prediction rollout = Predict(model, recording);
  if (bands.people.empty() || !rollout.status.ok) return held;
  held.ok = true;
  held.median_ade = ScoreHip(recording, MedianHip(bands)).hip_ade;
  held.rollout_ade = ScoreHip(recording, rollout.hip).hip_ade;
  const PathBand& band = bands.people[recording.pushed_person];
  const double share = 1.0 / (recording.num_frames() - 1);
  for (int t = 1; t < recording.num_frames(); ++t) {
    const Vector3<double>& hip = recording.hip[recording.pushed_person][t];
    for (int axis : {0, 1}) {
      const auto inside = [&](const auto& lower, const auto& upper) {
        return lower[t][axis] <= hip[axis] && hip[axis] <= upper[t][axis];
      };
      held.inside50[axis] += share * inside(band.lower50, band.upper50);
      held.inside90[axis] += share * inside(band.lower90, band.upper90);
      held.width90[axis] += share * (band.upper90[t][axis] - band.lower90[t][axis]);
    }
  }
  return held;
}

BandCoverage MeanCoverage(const std::vector<PendulumRecording>& recordings,
                          const std::vector<std::vector<HeldCoverage>>& by_recording,
                          bool model_error) {
  BandCoverage coverage;
  coverage.model_error = model_error;
  std::vector<double> inside50[2], inside90[2], width[2], median, rollout;
  std::vector<std::string> pushed;
  for (size_t i = 0; i < by_recording.size(); ++i) {
    const std::vector<HeldCoverage>& repeats = by_recording[i];
    if (repeats.empty()) continue;
    pushed.push_back(PersonKey(recordings[i], recordings[i].pushed_person));
    ++coverage.recordings;
    const double share = 1.0 / static_cast<double>(repeats.size());
    median.push_back(0.0);
    rollout.push_back(0.0);
    for (const HeldCoverage& held : repeats) {
      median.back() += share * held.median_ade;
      rollout.back() += share * held.rollout_ade;
    }
    for (int axis : {0, 1}) {
      double a = 0.0, b = 0.0, c = 0.0;
      for (const HeldCoverage& held : repeats) {
        a += share * held.inside50[axis];
        b += share * held.inside90[axis];
        c += share * held.width90[axis];
      }
      inside50[axis].push_back(a);
      inside90[axis].push_back(b);
      width[axis].push_back(c);
    }
  }
  const ScoreClusters clusters = ClustersOf(pushed);
  coverage.clusters = ClustersText(clusters.by, clusters.count);
  const auto mean_of = [&clusters](const std::vector<double>& values) {
    MeanAndError m = MeanOf(values);
    std::vector<double> deviations;
    for (double value : values) {
      deviations.push_back((value - m.mean) / static_cast<double>(values.size()));
    }
    m.error = clusters.ErrorOfMean(deviations);
    return m;
  };
  for (int axis : {0, 1}) {
    const MeanAndError a = mean_of(inside50[axis]), b = mean_of(inside90[axis]);
    coverage.inside50[axis] = a.mean;
    coverage.inside50_error[axis] = a.error;
    coverage.inside90[axis] = b.mean;
    coverage.inside90_error[axis] = b.error;
    coverage.width90[axis] = MeanOf(width[axis]).mean;
  }
  const MeanAndError of_median = mean_of(median), of_rollout = mean_of(rollout);
  coverage.median_ade = of_median.mean;
  coverage.median_ade_error = of_median.error;
  coverage.rollout_ade = of_rollout.mean;
  coverage.rollout_ade_error = of_rollout.error;
  return coverage;
}

}  // namespace

std::vector<BandCoverage> CrossValidateBands(const std::vector<PendulumRecording>& recordings,
                                             const std::vector<Fold>& folds,
                                             const FitOptions& options, const BandOptions& bands,
                                             int num_threads, const JobProgress& progress) {
  FitOptions alone = options;
  alone.num_threads = 1;  // the folds run in parallel
  // [fold][without, with model error][held out]
  std::vector<std::vector<HeldCoverage>> without(folds.size()), with(folds.size());
  ParallelFor(
      static_cast<int>(folds.size()), num_threads,
      [&](int f) {
        std::vector<PendulumRecording> training;
        for (int i = 0; i < static_cast<int>(recordings.size()); ++i) {
          const auto& out = folds[f].held_out;
          if (std::find(out.begin(), out.end(), i) == out.end()) training.push_back(recordings[i]);
        }
        without[f].resize(folds[f].held_out.size());
        with[f].resize(folds[f].held_out.size());
        FitOptions prepared = alone;
        if (PrepareFit(training, &prepared)) return;
        const FitResult result = Fit(training, prepared);
        if (!result.ok()) return;
        const auto samples = SampleParameters(result, bands);
        const std::vector<ErrorPath> errors = ErrorPaths(result, training);
        const IdentifiedModel model = ModelOf(result);
        for (size_t k = 0; k < folds[f].held_out.size(); ++k) {
          const PendulumRecording& held = recordings[folds[f].held_out[k]];
          without[f][k] =
              CountInside(ComputeBands(result, samples.value(), {}, held, bands.seed), model, held);
          with[f][k] = CountInside(ComputeBands(result, samples.value(), errors, held, bands.seed),
                                   model, held);
        }
      },
      progress);
  std::vector<BandCoverage> coverage;
  for (const auto* held : {&without, &with}) {
    std::vector<std::vector<HeldCoverage>> by_recording(recordings.size());
    for (size_t f = 0; f < folds.size(); ++f) {
      for (size_t k = 0; k < folds[f].held_out.size(); ++k) {
        if ((*held)[f][k].ok) by_recording[folds[f].held_out[k]].push_back((*held)[f][k]);
      }
    }
    coverage.push_back(MeanCoverage(recordings, by_recording, held == &with));
  }
  return coverage;
}

std::string BandCoverageText(const std::vector<BandCoverage>& coverage) {
  TextTable table({"bands of", "axis", "inside 50 %", "inside 90 %", "mean width of 90 %, m"},
                  {true, true, false, false, false});
  const auto percent = [](double share, double error) {
    return Rounded(100.0 * share, 3) + " +- " + Rounded(100.0 * error, 2) + " %";
  };
  for (const BandCoverage& c : coverage) {
    for (int axis : {0, 1}) {
      table.Add({c.model_error ? "parameters and model error" : "parameters alone",
                 axis == 0 ? "x" : "y", percent(c.inside50[axis], c.inside50_error[axis]),
                 percent(c.inside90[axis], c.inside90_error[axis]), Rounded(c.width90[axis], 3)});
    }
  }
  std::string text =
      table.ToString() + "share of held-out frames of " +
      std::to_string(coverage.empty() ? 0 : coverage[0].recordings) +
      " recordings whose measured hip lies in the predictive bands; standard errors over " +
      (coverage.empty() ? "" : coverage[0].clusters) + "\n";
  for (const BandCoverage& c : coverage) {
    if (!c.model_error) continue;
    text += kHipMetrics[0].name + std::string(" of their median ") + Rounded(c.median_ade, 3) +
            " +- " + Rounded(c.median_ade_error, 2) + " m, of the rollout at the estimate " +
            Rounded(c.rollout_ade, 3) + " +- " + Rounded(c.rollout_ade_error, 2) + " m\n";
  }
  return text;
}

}  // namespace pushid
