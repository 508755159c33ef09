// ident: trials of all forecasters, and what is learned from them.
#include "ident/observed/learn_forecasts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "ident/observed/forecast_stack.h"
#include "ident/problem/parallel.h"

namespace pushid {
namespace {

// s after frame 0.
constexpr double kMoments[] = {0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};
constexpr int kFramesAfter = 5;  // at least

ForecastTrial MakeTrial(const PendulumRecording& recording, const FirstFrames& frames,
                        const HipPaths& rollout) {
  ForecastTrial trial;
  trial.seconds = frames.seconds();
  trial.dt = recording.scene.dt;
  trial.axes = frames.filter().Axes();
  trial.forecasts = frames.Forecasts(rollout);
  trial.from = frames.LastHips();
  const int observed = frames.observed();
  for (int n = 0; n < recording.num_people(); ++n) {
    const auto& hip = recording.hip[n];
    trial.measured.emplace_back(hip.begin() + observed, hip.end());
    trial.seen.emplace_back();
    for (int t = observed; t < recording.num_frames(); ++t) {
      trial.seen[n].push_back(recording.Weight(n, t) > 0.0);
    }
  }
  return trial;
}

std::vector<ForecastTrial> TrialsOf(const IdentifiedModel& model, const ForecastStack& stack,
                                    const PendulumRecording& recording) {
  std::vector<ForecastTrial> trials;
  const int frames = recording.num_frames();
  FirstFrames first(model, stack, recording, frames);
  int moment = 0;
  for (int t = 0; t + kFramesAfter < frames; ++t) {
    if (t > 0) first.Observe(FrameAt(recording, t));
    if (first.seconds() < kMoments[moment] - 1e-9) continue;
    const double effect = first.filter().Effect(*model.recording_effect).mean;
    const HipPaths rollout = HipsOfRollouts(model, recording, {effect}, frames).front();
    trials.push_back(MakeTrial(recording, first, rollout));
    trials.back().moment = moment;
    if (++moment == static_cast<int>(std::size(kMoments))) break;
  }
  return trials;
}

// A mean over what there is.
struct MeanOfSome {
  double sum = 0.0;
  int count = 0;
  void Add(const std::optional<double>& value) {
    if (value) sum += *value, ++count;
  }
  double Mean() const { return count > 0 ? sum / count : std::nan(""); }
};

std::vector<ForecasterErrors> ScoresOf(const std::vector<ForecastTrial>& trials,
                                       const std::vector<HipPaths>& centre) {
  struct Row {
    MeanOfSome seconds, stack;
    std::array<MeanOfSome, kNumForecasters> of;
  };
  std::map<int, Row> rows;
  for (size_t i = 0; i < trials.size(); ++i) {
    const std::optional<double> stack = MeanDistance(trials[i], centre[i]);
    if (!stack) continue;
    Row& row = rows[trials[i].moment];
    row.seconds.Add(trials[i].seconds);
    row.stack.Add(stack);
    for (int c = 0; c < kNumForecasters; ++c) {
      row.of[c].Add(MeanDistance(trials[i], trials[i].forecasts[c]));
    }
  }
  std::vector<ForecasterErrors> scores;
  for (const auto& [moment, row] : rows) {
    ForecasterErrors& score = scores.emplace_back();
    score.seconds = row.seconds.Mean();
    score.stack = row.stack.Mean();
    score.recordings = row.stack.count;
    for (int c = 0; c < kNumForecasters; ++c) score.mean[c] = row.of[c].Mean();
  }
  return scores;
}

// Every fold's forecasts with weights that were learned without it.
std::vector<HipPaths> NestedForecasts(const std::vector<ForecastTrial>& trials, int folds,
                                      const ForecastStack& stack) {
  std::vector<HipPaths> centre(trials.size());
  for (int f = 0; f < std::max(1, folds); ++f) {
    ForecastStack others = stack;
    if (folds > 0) others.logits = LearnLogits(trials, f);
    for (size_t i = 0; i < trials.size(); ++i) {
      const ForecastTrial& trial = trials[i];
      if (trial.fold != f) continue;
      centre[i] =
          Stacked(WeightsAhead(others, trial.forecasts, trial.seconds, trial.dt), trial.forecasts);
    }
  }
  return centre;
}

}  // namespace

std::optional<double> MeanDistance(const ForecastTrial& trial, const HipPaths& hips) {
  double sum = 0.0, count = 0.0;
  for (size_t n = 0; n < hips.size(); ++n) {
    for (size_t t = 0; t < hips[n].size(); ++t) {
      if (!trial.seen[n][t]) continue;
      sum += (hips[n][t] - trial.measured[n][t]).norm();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional<double>(sum / count) : std::nullopt;
}

std::optional<ForecastStack> LearnForecasts(const IdentifiedModel& model,
                                            const std::vector<PendulumRecording>& recordings,
                                            const std::vector<FoldModel>& folds, int num_threads) {
  // Who forecasts what: folds, or the model itself.
  std::vector<FoldModel> forecasters = folds;
  if (folds.empty()) {
    forecasters.push_back({model, std::vector<int>(recordings.size())});
    std::iota(forecasters[0].held_out.begin(), forecasters[0].held_out.end(), 0);
  }
  const int count = static_cast<int>(forecasters.size());
  // The filter's numbers: of each fold by what the others say, and last by all.
  std::vector<ForecastStack> inputs(count + 1);
  if (!folds.empty()) inputs = ChooseInputs(recordings, folds, num_threads);
  std::vector<ForecastTrial> trials;
  for (int f = 0; f < count; ++f) {
    const FoldModel& fold = forecasters[f];
    std::vector<std::vector<ForecastTrial>> made(fold.held_out.size());
    ParallelFor(static_cast<int>(made.size()), num_threads, [&](int i) {
      made[i] = TrialsOf(fold.model, inputs[f], recordings[fold.held_out[i]]);
      for (ForecastTrial& trial : made[i]) trial.fold = f, trial.recording = fold.held_out[i];
    });
    for (auto& of_recording : made) {
      std::move(of_recording.begin(), of_recording.end(), std::back_inserter(trials));
    }
  }
  if (trials.empty()) return std::nullopt;
  ForecastStack stack = inputs[count];
  std::set<int> forecast;
  for (const ForecastTrial& trial : trials) forecast.insert(trial.recording);
  stack.folds = static_cast<int>(folds.size());
  stack.recordings = static_cast<int>(forecast.size());
  stack.likeliest = LikeliestInput(model, recordings);
  const std::vector<HipPaths> centre = NestedForecasts(trials, stack.folds, stack);
  if (!folds.empty()) stack.logits = LearnLogits(trials);
  stack.errors = LearnErrorScales(trials, centre);
  stack.scores = ScoresOf(trials, centre);
  return stack;
}

}  // namespace pushid
