// ident: scores of folds, paired differences.
#include "ident/validation/crossvalidation.h"

#include <algorithm>
#include <cmath>

namespace pushid {

CrossValidation CrossValidate(const std::vector<PendulumRecording>& recordings,
                              const std::vector<Fold>& folds, const Predictor& predictor,
                              int num_threads, const JobProgress& progress) {
  const int total = static_cast<int>(recordings.size());
  std::vector<FoldPrediction> predictions(folds.size());
  ParallelFor(
      static_cast<int>(folds.size()), num_threads,
      [&](int f) {
        predictions[f] =
            predictor.FitAndScore(recordings, Others(folds[f].held_out, total), folds[f].held_out);
      },
      progress);

  CrossValidation result;
  result.predictor = predictor.name;
  std::vector<RecordingScore> mean(total);
  std::vector<int> count(total, 0);
  for (size_t f = 0; f < folds.size(); ++f) {
    FoldScore fold;
    fold.name = folds[f].name;
    fold.held_out = static_cast<int>(folds[f].held_out.size());
    int scored = 0;
    std::vector<const PropagationScore*> propagation;
    for (size_t k = 0; k < predictions[f].scores.size(); ++k) {
      const RecordingScore& score = predictions[f].scores[k];
      RecordingScore& sum = mean[folds[f].held_out[k]];
      sum.id = score.id;
      sum.frames = score.frames;
      sum.fell = sum.fell || score.fell;
      fold.falls += score.fell;
      fold.falls_harder += score.fell_harder;
      if (!score.failure.empty()) {
        ++fold.failures;
        sum.failure = score.failure;
        continue;
      }
      ++scored;
      ++count[folds[f].held_out[k]];
      for (const HipMetric& metric : kHipMetrics) {
        sum.*metric.value += score.*metric.value;
        fold.*metric.value += score.*metric.value;
      }
      sum.propagation.Add(score.propagation);
      propagation.push_back(&score.propagation);
    }
    for (const HipMetric& metric : kHipMetrics) fold.*metric.value /= std::max(1, scored);
    fold.propagation = SummarizePropagation(propagation);
    fold.behaviour = predictions[f].behaviour;
    if (fold.behaviour) {
      ++result.fits;
      result.settling += fold.behaviour->settles;
      result.harder_farther += fold.behaviour->harder_moves_farther;
      for (const SettlingSimulation& d : fold.behaviour->simulations) {
        result.slowest_to_settle = std::max(result.slowest_to_settle, d.speed);
      }
    }
    result.failures += fold.failures;
    result.falls += fold.falls;
    result.falls_harder += fold.falls_harder;
    result.folds.push_back(fold);
  }

  std::vector<PendulumRecording> held;
  std::vector<RecordingScore> held_scores;
  for (int i = 0; i < total; ++i) {
    if (count[i] == 0 && mean[i].failure.empty()) continue;  // never held out
    if (count[i] > 0) {
      for (const HipMetric& metric : kHipMetrics) mean[i].*metric.value /= count[i];
      mean[i].propagation.Divide(count[i]);
    }
    held.push_back(recordings[i]);
    held_scores.push_back(mean[i]);
  }
  result.summary = Summarize(held, held_scores);
  return result;
}

PairedDifference Compare(const CrossValidation& a, const CrossValidation& b) {
  PairedDifference difference;
  difference.a = a.predictor;
  difference.b = b.predictor;
  std::map<std::string, const RecordingScore*> of_a;
  for (const RecordingScore& score : a.summary.recordings) of_a[score.id] = &score;
  std::vector<HipMetrics> pairs;
  for (const RecordingScore& score : b.summary.recordings) {
    const auto found = of_a.find(score.id);
    if (found == of_a.end() || !score.failure.empty() || !found->second->failure.empty()) continue;
    HipMetrics pair;
    for (const HipMetric& metric : kHipMetrics) {
      pair.*metric.value = score.*metric.value - found->second->*metric.value;
    }
    pairs.push_back(pair);
  }
  difference.recordings = static_cast<int>(pairs.size());
  const double n = static_cast<double>(pairs.size());
  for (const HipMetric& metric : kHipMetrics) {
    double mean = 0.0, squares = 0.0;
    for (const HipMetrics& pair : pairs) mean += pair.*metric.value / n;
    for (const HipMetrics& pair : pairs) {
      squares += (pair.*metric.value - mean) * (pair.*metric.value - mean);
    }
    difference.*metric.value = mean;
    difference.error.*metric.value = n > 1 ? std::sqrt(squares / (n - 1.0) / n) : 0.0;
  }
  return difference;
}

}  // namespace pushid
