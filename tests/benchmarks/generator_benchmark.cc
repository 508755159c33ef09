// What forecasts cost: 25 frames of 25 particles after 25 observed ones, by one network, on one
// core; alone, and 64 windows together; and one sample of a group of 5 and of 13 people by
// diffusion, 96 frames in 25 steps. The weights are random: they take as long as trained ones.
#include <benchmark/benchmark.h>

#include "tests/models/generators/diffusion_samples.h"
#include "tests/models/generators/generator_samples.h"

namespace pushid {
namespace {

constexpr int kParticles = 25, kFrames = 25;

ParticleNetwork Network() {
  Random random(1);
  const int size = 3 * kParticles;
  ParticleNetwork network;
  network.pose_mean = Eigen::VectorXf::Zero(size);
  network.pose_spread = Eigen::VectorXf::Constant(size, 0.1f);
  network.step_spread = Eigen::VectorXf::Constant(size, 0.01f);
  network.input =
      RandomLayer(network.structure.NumGates(), network.structure.NumInputs(size), 0.05, &random);
  network.recurrent = RandomLayer(network.structure.NumGates(), kParticleHidden, 0.05, &random);
  network.drift = RandomLayer(size, kParticleHidden, 0.03, &random);
  network.noise = RandomLayer(size, kParticleHidden, 0.03, &random);
  network.skip = RandomLayer(size, kSkipSteps * size, 0.01, &random).weights;
  return network;
}

void BM_Forecast(benchmark::State& state) {
  const ParticleNetwork network = Network();
  const std::vector<ObservedMotion> people(
      static_cast<size_t>(state.range(0)),
      {Trajectories(0.1f * Trajectories::Random(3 * kParticles, kFrames))});
  for (auto _ : state) {
    ParticleRollout rollout(network, people);
    for (int t = 0; t < kFrames; ++t) benchmark::DoNotOptimize(rollout.Step().data());
  }
  state.counters["per_window"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * state.iterations(),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Forecast)->Arg(1)->Arg(64)->Unit(benchmark::kMillisecond);

void BM_DiffusionSample(benchmark::State& state) {
  constexpr int kGroupFrames = 96;
  std::vector<ObservedMotion> people = PushedGroup(static_cast<int>(state.range(0)), kGroupFrames);
  for (ObservedMotion& person : people) person.frames = Trajectories(person.frames.leftCols(1));
  DiffusionGeneratorOptions one;
  one.averaged = 1;
  const DiffusionGenerator generator({}, {RandomDiffusion(1)}, 1.0 / 60.0, one, SeededNoise());
  for (auto _ : state) {
    const auto sample = generator.Forecast(people, kGroupFrames - 1);
    benchmark::DoNotOptimize(sample[0].data());
  }
}
BENCHMARK(BM_DiffusionSample)->Arg(5)->Arg(13)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pushid
