// What a prediction costs that learns from first frames: one frame, one prediction, a recording.
#include <benchmark/benchmark.h>

#include "ident/prediction/online_predictor.h"
#include "tests/benchmarks/benchmark_recordings.h"

namespace pushid {
namespace {

constexpr int kFrames = 30;

IdentifiedModel TailModel() {
  IdentifiedModel model;
  model.parameters = PublishedTailParameters();
  model.recording_effect = RecordingEffect{};
  model.recording_effect->spread = 0.4;
  model.recording_effect->blend_rate = 1.0;
  return model;
}

// One frame after the other; predictors are made outside the clock.
void OnlineObserve(benchmark::State& state) {
  const IdentifiedModel model = TailModel();
  const PendulumRecording& recording = SinglePeople().recordings[0];
  const int frames = recording.num_frames();
  auto predictor = OnlinePredictor::Make(model, recording, frames).value();
  for (auto _ : state) {
    if (predictor.observed() + 1 >= frames) {
      state.PauseTiming();
      predictor = OnlinePredictor::Make(model, recording, frames).value();
      state.ResumeTiming();
    }
    predictor.Observe(FrameAt(recording, predictor.observed()));
  }
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlineObserve)->Unit(benchmark::kMicrosecond);

void OnlinePredict(benchmark::State& state) {
  const IdentifiedModel model = TailModel();
  const PendulumRecording& recording = SinglePeople().recordings[0];
  auto predictor = OnlinePredictor::Make(model, recording, recording.num_frames()).value();
  for (int t = 1; t < kFrames; ++t) predictor.Observe(FrameAt(recording, t));
  for (auto _ : state) benchmark::DoNotOptimize(predictor.Predict());
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlinePredict)->Unit(benchmark::kMicrosecond);

// Made, shown its first frames, asked once.
void OnlineRecording(benchmark::State& state) {
  const IdentifiedModel model = TailModel();
  const PendulumRecording& recording = SinglePeople().recordings[0];
  for (auto _ : state) {
    auto predictor = OnlinePredictor::Make(model, recording, recording.num_frames()).value();
    for (int t = 1; t < kFrames; ++t) predictor.Observe(FrameAt(recording, t));
    benchmark::DoNotOptimize(predictor.Predict());
  }
  state.SetLabel(SinglePeople().origin);
}
BENCHMARK(OnlineRecording)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace pushid
