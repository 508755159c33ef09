// ident: a grid of tails and force times, judged by forecasts; noise by single steps.
#include <algorithm>

#include "ident/observed/learn_forecasts.h"
#include "ident/problem/parallel.h"
#include "models/rollout.h"

namespace pushid {
namespace {

constexpr double kTailStrengths[] = {1.0, 1.5, 2.2}, kTailTimes[] = {1.0, 1.5, 2.2};
constexpr double kForceTimes[] = {0.06, 0.1, 0.2};           // s
constexpr double kChoiceMoments[] = {0.2, 0.33, 0.5, 0.75};  // s after frame 0
constexpr int kChoiceFramesAfter = 5;                        // at least
constexpr size_t kMostRecordings = 24;

std::vector<ForecastStack> Candidates() {
  std::vector<ForecastStack> candidates;
  for (double strength : kTailStrengths) {
    for (double time : kTailTimes) {
      for (double seconds : kForceTimes) {
        ForecastStack& candidate = candidates.emplace_back();
        candidate.tail_strength = strength, candidate.tail_time = time;
        candidate.noise.force_time = seconds;
      }
    }
  }
  return candidates;
}

// The mean distance of the filter's forecasts, m; those that fail count as where nobody moves.
double InputError(const IdentifiedModel& model, const ForecastStack& stack,
                  const PendulumRecording& recording) {
  const int frames = recording.num_frames();
  std::optional<SceneFilter> filter = ForecastFilter(model, stack, recording, frames);
  double sum = 0.0, count = 0.0;
  size_t next = 0;
  for (int t = 1; t + kChoiceFramesAfter < frames && next < std::size(kChoiceMoments); ++t) {
    const SeenFrame frame = FrameAt(recording, t);
    filter->Observe(frame.states, frame.hips.seen);
    if (t * recording.scene.dt < kChoiceMoments[next] - 1e-9) continue;
    ++next;
    RolloutPath<double> path;
    const bool ok = filter->Forecast(&path).ok;
    for (int n = 0; n < recording.num_people(); ++n) {
      const Body& body = recording.scene.people[n].body;
      const Vector3<double> here = recording.hip[n][t];
      const auto moved = [&](int u) -> Vector3<double> {
        if (!ok) return here;
        return here + HipPosition(body, path.At(u, n).q) - HipPosition(body, path.At(t, n).q);
      };
      for (int u = t + 1; u < frames; u += 3) {
        sum += recording.Weight(n, u) * (recording.hip[n][u] - moved(u)).norm();
        count += recording.Weight(n, u);
      }
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

// Some recordings of each fold, evenly.
std::vector<std::pair<int, int>> Judged(const std::vector<FoldModel>& folds) {
  std::vector<std::pair<int, int>> all;  // fold and recording
  for (size_t f = 0; f < folds.size(); ++f) {
    for (int i : folds[f].held_out) all.emplace_back(static_cast<int>(f), i);
  }
  const size_t step = std::max<size_t>(1, (all.size() + kMostRecordings - 1) / kMostRecordings);
  std::vector<std::pair<int, int>> some;
  for (size_t k = 0; k < all.size(); k += step) some.push_back(all[k]);
  return some;
}

}  // namespace

std::vector<ForecastStack> ChooseInputs(const std::vector<PendulumRecording>& recordings,
                                        const std::vector<FoldModel>& folds, int num_threads) {
  const std::vector<ForecastStack> candidates = Candidates();
  std::vector<ForecastStack> chosen(folds.size() + 1);
  if (folds.empty() || folds[0].model.options.learned != nullptr) return chosen;
  const std::vector<std::pair<int, int>> judged = Judged(folds);
  std::vector<std::vector<double>> errors(judged.size());
  ParallelFor(static_cast<int>(judged.size()), num_threads, [&](int k) {
    const auto& [fold, recording] = judged[k];
    for (const ForecastStack& candidate : candidates) {
      errors[k].push_back(InputError(folds[fold].model, candidate, recordings[recording]));
    }
  });
  for (size_t f = 0; f < chosen.size(); ++f) {
    std::vector<double> sums(candidates.size(), 0.0);
    for (size_t k = 0; k < judged.size(); ++k) {
      if (judged[k].first == static_cast<int>(f)) continue;
      for (size_t c = 0; c < sums.size(); ++c) sums[c] += errors[k][c];
    }
    chosen[f] = candidates[std::min_element(sums.begin(), sums.end()) - sums.begin()];
  }
  return chosen;
}

InputNoise LikeliestInput(const IdentifiedModel& model,
                          const std::vector<PendulumRecording>& recordings) {
  InputNoise best;
  if (model.options.learned != nullptr) return best;
  const size_t step = std::max<size_t>(1, recordings.size() / kMostRecordings);
  const auto deviance = [&](const InputNoise& noise) {
    double sum = 0.0;
    for (size_t i = 0; i < recordings.size(); i += step) {
      const PendulumRecording& recording = recordings[i];
      const int frames = recording.num_frames();
      auto filter = UnknownForceFilter(model, noise, recording, frames);
      for (int t = 1; t < frames; ++t) {
        const SeenFrame frame = FrameAt(recording, t);
        if (!filter->Observe(frame.states, frame.hips.seen).ok) break;
      }
      sum += filter->Deviance();
    }
    return sum;
  };
  double least = deviance(best);
  for (int round = 0; round < 2; ++round) {
    const InputNoise from = best;
    for (double InputNoise::*number : {&InputNoise::force, &InputNoise::force_time,
                                       &InputNoise::measured, &InputNoise::measured_time}) {
      for (double factor : {0.1, 0.2, 0.5, 2.0, 5.0}) {
        InputNoise tried = best;
        tried.*number = factor * from.*number;
        const double of_tried = deviance(tried);
        if (of_tried < least) least = of_tried, best = tried;
      }
    }
  }
  return best;
}

}  // namespace pushid
