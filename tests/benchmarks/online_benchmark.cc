// What a prediction costs that learns from first frames: one frame, one prediction a second ahead,
// of one person and of five in contact; a whole recording.
#include <benchmark/benchmark.h>

#include "ident/prediction/online_predictor.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

constexpr int kFrames = 30, kAhead = 60;

IdentifiedModel ModelOfBenchmark(bool groups) {
  IdentifiedModel model;
  model.parameters = PublishedTailParameters();
  model.forecasts = ForecastRule{};
  if (!groups) return model;
  model.options.interaction.spring = model.options.interaction.damping = true;
  model.parameters[kContactStiffness] = 2900.0, model.parameters[kContactDistance] = 0.42;
  model.parameters[kContactKappa] = 0.41, model.parameters[kContactDamping] = 270.0;
  model.parameters[kContactHeight] = 0.5;
  return model;
}

const PendulumRecording& RecordingOf(bool groups) {
  const BenchmarkRecordings& from = groups ? Groups() : SinglePeople();
  for (const PendulumRecording& recording : from.recordings) {
    if (recording.num_people() == (groups ? 5 : 1) && recording.num_frames() > kFrames + 10) {
      return recording;
    }
  }
  return from.recordings[0];
}

OnlinePredictor Begun(const IdentifiedModel& model, const PendulumRecording& recording) {
  return OnlinePredictor::Make(model, recording, kFrames + kAhead).value();
}

// One frame after the other; predictors are made outside the clock.
void OnlineObserve(benchmark::State& state) {
  const bool groups = state.range(0) > 1;
  const IdentifiedModel model = ModelOfBenchmark(groups);
  const PendulumRecording& recording = RecordingOf(groups);
  OnlinePredictor predictor = Begun(model, recording);
  for (auto _ : state) {
    if (predictor.observed() >= kFrames) {
      state.PauseTiming();
      predictor = Begun(model, recording);
      state.ResumeTiming();
    }
    predictor.Observe(FrameAt(recording, predictor.observed()));
  }
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlineObserve)->Arg(1)->Arg(5)->Unit(benchmark::kMicrosecond);

// A second ahead, after half a second.
void OnlinePredict(benchmark::State& state) {
  const bool groups = state.range(0) > 1;
  const IdentifiedModel model = ModelOfBenchmark(groups);
  const PendulumRecording& recording = RecordingOf(groups);
  OnlinePredictor predictor = Begun(model, recording);
  for (int t = 1; t < kFrames; ++t) predictor.Observe(FrameAt(recording, t));
  for (auto _ : state) benchmark::DoNotOptimize(predictor.Predict());
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlinePredict)->Arg(1)->Arg(5)->Unit(benchmark::kMicrosecond);

// A frame and a second ahead, of an endless predictor that has seen so many frames.
void OnlineFrameAfter(benchmark::State& state) {
  const IdentifiedModel model = ModelOfBenchmark(false);
  const PendulumRecording& recording = RecordingOf(false);
  OnlinePredictor predictor =
      OnlinePredictor::Make(model, recording, OnlinePredictor::kEndless).value();
  const SeenFrame last = FrameAt(recording, kFrames);
  for (int t = 1; t < state.range(0); ++t) {
    predictor.Observe(t < kFrames ? FrameAt(recording, t) : last);
  }
  if (predictor.Next(kAhead).empty()) state.SkipWithError("a rollout left the domain");
  for (auto _ : state) {
    predictor.Observe(last);
    benchmark::DoNotOptimize(predictor.Next(kAhead));
  }
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlineFrameAfter)
    ->Arg(20)
    ->Arg(200)
    ->Arg(2000)
    ->Arg(20000)
    ->Unit(benchmark::kMicrosecond);

// Made, shown its first frames, asked once.
void OnlineRecording(benchmark::State& state) {
  const IdentifiedModel model = ModelOfBenchmark(false);
  const PendulumRecording& recording = RecordingOf(false);
  for (auto _ : state) {
    OnlinePredictor predictor = Begun(model, recording);
    for (int t = 1; t < kFrames; ++t) predictor.Observe(FrameAt(recording, t));
    benchmark::DoNotOptimize(predictor.Predict());
  }
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlineRecording)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pushid
