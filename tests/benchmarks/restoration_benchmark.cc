// What whole bodies cost: 13 people over 120 frames, restored and post-processed, on one core; the
// counter per_frame is for all 13. The weights are random: they take as long as trained ones.
#include <benchmark/benchmark.h>

#include "models/restoration/postprocess.h"
#include "tests/models/body_samples.h"

namespace pushid {
namespace {

constexpr int kPeople = 13, kFrames = 120;

std::vector<RestorationInput> Diamond() {
  std::vector<RestorationInput> people;
  for (int n = 0; n < kPeople; ++n) {
    people.push_back(MovingPerson(Placed(StandingPose(), 0.05 * n, {0.45 * n, 0.0, 0.0}),
                                  60.0 + 3 * n, kFrames));
  }
  return people;
}

void Restore(benchmark::State& state, const Restoration& restoration, bool finish) {
  const std::vector<RestorationInput> people = Diamond();
  for (auto _ : state) {
    std::vector<BodyMotion> bodies = restoration.Restore(people);
    for (int n = 0; finish && n < kPeople; ++n) {
      Finish(people[n], PostprocessOptions(), &bodies[n]);
    }
    benchmark::DoNotOptimize(bodies);
  }
  state.counters["per_frame"] =
      benchmark::Counter(kFrames * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void RestoreRigid(benchmark::State& state) { Restore(state, RigidRestoration(), true); }
void RestoreWindow(benchmark::State& state) {
  Restore(state, WindowRestoration(RandomWindow()), true);
}
void RestoreWindowBare(benchmark::State& state) {
  Restore(state, WindowRestoration(RandomWindow()), false);
}
void RestoreCvae(benchmark::State& state) { Restore(state, CvaeRestoration(RandomCvae()), true); }
BENCHMARK(RestoreRigid)->Unit(benchmark::kMillisecond);
BENCHMARK(RestoreWindow)->Unit(benchmark::kMillisecond);
BENCHMARK(RestoreWindowBare)->Unit(benchmark::kMillisecond);
BENCHMARK(RestoreCvae)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pushid
