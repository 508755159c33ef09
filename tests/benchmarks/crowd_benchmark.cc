// What a crowd costs: person-steps per second from 100 to 1,000,000 people, and how many times
// faster than real time 60 frames a second are.
//
// People stand 0.45 m apart on a square grid, each with a small velocity, so that
// contacts are loaded everywhere; the parameters are those identified from the published group
// recordings.
#include <benchmark/benchmark.h>

#include <cmath>

#include "datasets/files/random.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "models/formation.h"
#include "models/rollout.h"
#include "models/step.h"

namespace pushid {
namespace {

ParameterSet<double> Identified(Stance stance) {
  ParameterSet<double> p = PublishedStanceParameters();
  if (stance == Stance::kSlide) {
    p = PublishedTailParameters();
    p[kMu] = 21.0, p[kKpTheta] = 2200.0, p[kAx] = -16.0;
  }
  p[kContactStiffness] = 2900.0, p[kContactDistance] = 0.42, p[kContactKappa] = 0.41;
  p[kContactDamping] = 270.0, p[kContactHeight] = 0.5;
  return p;
}

Scene Crowded(int people) {
  Random random(1);
  Scene scene = FormationScene(FormationPositions(FormationShape::kGrid, people, 0.45),
                               {80.0, 0.95, 0.08}, 1.0 / 60.0);
  for (ScenePerson& person : scene.people) {
    person.body.mass = random.Uniform(60.0, 100.0);
    person.start.qd[0] = random.Uniform(-0.3, 0.3);
    person.start.qd[1] = random.Uniform(-0.3, 0.3);
  }
  AddHipPush(0, {80.0, 0.0, 0.2}, &scene);
  return scene;
}

// Argument: people. A second of 60 frames from the same start, so that contacts are as many
// whatever the number of people. Steps as a rollout has them, without its path.
void Second(benchmark::State& state, bool contact, Stance stance = Stance::kSlide) {
  constexpr int kFrames = 60;
  const int people = static_cast<int>(state.range(0));
  const Scene scene = Crowded(people);
  ModelOptions options;
  options.stance = stance;
  options.interaction.spring = options.interaction.damping = contact;
  const std::vector<ParameterSet<double>> parameters = {Identified(stance)};
  for (auto _ : state) {
    state.PauseTiming();
    ModelStep<double> forces(scene, options, parameters);
    std::vector<PendulumState<double>> now;
    for (const ScenePerson& person : scene.people) now.push_back(person.start);
    std::vector<PendulumState<double>> before = now, next = now;
    state.ResumeTiming();
    for (int t = 0; t < kFrames; ++t) {
      forces.Update(now.data());
      forces.PrepareAll();
      for (int n = 0; n < people; ++n) {
        const NetForce<double> force = forces.On(n, t, before[n].qd);
        next[n] = forces.Next(n, forces.AccelerationOf(n, force), force, before[n].qd);
        if (!OutsideDomain(scene.people[n].body, next[n]).empty()) {
          state.SkipWithError("a person falls");
        }
      }
      std::swap(before, now);
      std::swap(now, next);
    }
  }
  const double seconds = static_cast<double>(state.iterations());
  using benchmark::Counter;
  state.counters["person_steps"] = Counter(seconds * kFrames * people, Counter::kIsRate);
  state.counters["times_real_time"] = Counter(seconds, Counter::kIsRate);
}

void CrowdSecond(benchmark::State& state) { Second(state, true); }
BENCHMARK(CrowdSecond)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{100, 1000, 10000, 100000, 1000000}})
    ->ArgNames({"people"});

void CrowdSecondOfSteps(benchmark::State& state) { Second(state, true, Stance::kSteps); }
BENCHMARK(CrowdSecondOfSteps)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{10000}})
    ->ArgNames({"people"});

void CrowdSecondWithoutContact(benchmark::State& state) { Second(state, false); }
BENCHMARK(CrowdSecondWithoutContact)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->ArgsProduct({{10000}})
    ->ArgNames({"people"});

}  // namespace
}  // namespace pushid
