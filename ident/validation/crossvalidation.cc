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
      sum.hip_ade += score.hip_ade;
      sum.hip_fde += score.hip_fde;
      sum.propagation.Add(score.propagation);
      propagation.push_back(&score.propagation);
      fold.hip_ade += score.hip_ade;
      fold.hip_fde += score.hip_fde;
    }
    if (scored > 0) {
      fold.hip_ade /= scored;
      fold.hip_fde /= scored;
    }
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
      mean[i].hip_ade /= count[i];
      mean[i].hip_fde /= count[i];
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
  std::vector<double> ade, fde;
  for (const RecordingScore& score : b.summary.recordings) {
    const auto found = of_a.find(score.id);
    if (found == of_a.end() || !score.failure.empty() || !found->second->failure.empty()) continue;
    ade.push_back(score.hip_ade - found->second->hip_ade);
    fde.push_back(score.hip_fde - found->second->hip_fde);
  }
  auto mean_and_error = [](const std::vector<double>& values, double* mean, double* error) {
    const double n = static_cast<double>(values.size());
    for (double value : values) *mean += value / n;
    double squares = 0.0;
    for (double value : values) squares += (value - *mean) * (value - *mean);
    *error = n > 1 ? std::sqrt(squares / (n - 1.0) / n) : 0.0;
  };
  difference.recordings = static_cast<int>(ade.size());
  mean_and_error(ade, &difference.hip_ade, &difference.hip_ade_error);
  mean_and_error(fde, &difference.hip_fde, &difference.hip_fde_error);
  return difference;
}

}  // namespace pushid
