// ident: folds, scores of folds, paired differences.
#include "ident/validation/crossvalidation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "datasets/files/random.h"
#include "ident/parameters/option_names.h"

namespace pushid {
namespace {

std::string PushedSubject(const PendulumRecording& recording) {
  return recording.subject_ids[recording.pushed_person];
}

// Fisher and Yates's shuffle.
void Shuffle(std::vector<int>* items, Random* random) {
  for (size_t i = items->size(); i > 1; --i) {
    std::swap((*items)[i - 1], (*items)[random->Fork() % i]);
  }
}

std::vector<Fold> StratifiedFolds(const std::vector<PendulumRecording>& recordings, int num_folds,
                                  int repeats, uint64_t seed) {
  std::map<std::array<std::string, 3>, std::vector<int>> strata;
  for (int i = 0; i < static_cast<int>(recordings.size()); ++i) {
    strata[{recordings[i].setting, recordings[i].magnitude, PushedSubject(recordings[i])}]
        .push_back(i);
  }
  std::vector<Fold> folds;
  Random random(seed);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::vector<Fold> round(num_folds);
    int next = 0;  // carried over from stratum to stratum: folds stay equally large
    for (const auto& [key, members] : strata) {
      std::vector<int> shuffled = members;
      Shuffle(&shuffled, &random);
      for (int index : shuffled) round[next++ % num_folds].held_out.push_back(index);
    }
    for (int f = 0; f < num_folds; ++f) {
      round[f].name = "repeat " + std::to_string(repeat + 1) + " fold " + std::to_string(f + 1);
      std::sort(round[f].held_out.begin(), round[f].held_out.end());
      folds.push_back(round[f]);
    }
  }
  return folds;
}

std::vector<int> Others(const std::vector<int>& held_out, int total) {
  std::vector<int> others;
  for (int i = 0; i < total; ++i) {
    if (!std::binary_search(held_out.begin(), held_out.end(), i)) others.push_back(i);
  }
  return others;
}

}  // namespace

Result<std::vector<Fold>> MakeFolds(const std::vector<PendulumRecording>& recordings,
                                    FoldScheme scheme, int num_folds, int repeats, uint64_t seed) {
  const int total = static_cast<int>(recordings.size());
  if (scheme == FoldScheme::kStratified) {
    if (num_folds < 2 || num_folds > total) {
      return Error{"--folds is " + std::to_string(num_folds) + "; it must lie between 2 and the " +
                   std::to_string(total) + " recordings"};
    }
    if (repeats < 1) return Error{"--repeats must be at least 1"};
    return StratifiedFolds(recordings, num_folds, repeats, seed);
  }
  // One fold per subject or setting; one fold of all strong pushes.
  std::map<std::string, Fold> by_name;
  for (int i = 0; i < total; ++i) {
    const PendulumRecording& recording = recordings[i];
    std::string key = PushedSubject(recording);
    if (scheme == FoldScheme::kSetting) key = recording.setting;
    if (scheme == FoldScheme::kStrong) key = "strong";
    if (scheme == FoldScheme::kStrong && recording.magnitude != "strong") continue;
    by_name[key].name = "without " + key;
    by_name[key].held_out.push_back(i);
  }
  std::vector<Fold> folds;
  for (auto& [name, fold] : by_name) {
    if (static_cast<int>(fold.held_out.size()) < total) folds.push_back(fold);
  }
  if (folds.empty()) {
    return Error{"--scheme=" + NameOf(scheme) +
                 " leaves nothing to fit: it needs recordings of at least two pushed subjects "
                 "(subject), of two settings (setting), or recordings of magnitude 'strong' and "
                 "others (strong)"};
  }
  return folds;
}

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
