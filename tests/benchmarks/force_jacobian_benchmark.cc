// The derivatives of force terms that are written out for lanes (residuals/lanes) against what a
// formula gives by itself: jets over the term's own inputs. A hand-written one
// stays where this shows that it pays; force_jacobians.h quotes the factors.
//   pushid-benchmarks --benchmark_filter='Jacobian_'
#include <benchmark/benchmark.h>
#include <ceres/jet.h>

#include "datasets/files/random.h"
#include "models/push.h"
#include "models/self_force.h"
#include "residuals/force_jacobians.h"

namespace pushid {
namespace {

constexpr int kSelfParameters = kTailGain;  // friction, balance and linear terms come first
constexpr double kDt = 1.0 / 60.0;

struct Walker {
  ParameterSet<double> p{};
  PendulumState<double> state;
  Vector4<double> previous;

  explicit Walker(int seed) {
    Random random(seed);
    for (double& value : p) value = random.Uniform(0.5, 3.0);
    for (int i = 0; i < 4; ++i) {
      state.q[i] = random.Uniform(-0.3, 0.3);
      state.qd[i] = random.Uniform(-1, 1);
      previous[i] = random.Uniform(-1, 1);
    }
  }
};

void Jacobian_OfSelfForce_Written(benchmark::State& state) {
  Walker walker(1);
  const SelfForce self({}, {80.0, 0.95, 0.0}, Vector4<double>::Zero(), kDt);
  SelfJacobian<double> jacobian;
  for (auto _ : state) {
    benchmark::DoNotOptimize(walker);
    jacobian.by_state.setZero();
    AddFrictionJacobian(self, walker.p, walker.state.qd, &jacobian);
    AddControlJacobian(self, walker.p, walker.state, &jacobian);
    benchmark::DoNotOptimize(jacobian);
  }
}
BENCHMARK(Jacobian_OfSelfForce_Written)->Unit(benchmark::kNanosecond);

// [theta, phi, qd, the cart's velocity before, parameters].
void Jacobian_OfSelfForce_ByJets(benchmark::State& state) {
  Walker walker(1);
  const SelfForce self({}, {80.0, 0.95, 0.0}, Vector4<double>::Zero(), kDt);
  using D = JetOf<double, 8 + kSelfParameters>;
  for (auto _ : state) {
    benchmark::DoNotOptimize(walker);
    ParameterSet<D> p;
    PendulumState<D> at;
    Vector4<D> previous;
    for (int i = 0; i < 2; ++i) at.q[2 + i] = D::Input(walker.state.q[2 + i], i);
    for (int i = 0; i < 4; ++i) at.qd[i] = D::Input(walker.state.qd[i], 2 + i);
    for (int i = 0; i < 2; ++i) previous[i] = D::Input(walker.previous[i], 6 + i);
    for (int i = 0; i < kSelfParameters; ++i) p[i] = D::Input(walker.p[i], 8 + i);
    benchmark::DoNotOptimize(Vector4<D>(self.Friction(p, at.qd) + self.Effort(p, at, previous)));
  }
}
BENCHMARK(Jacobian_OfSelfForce_ByJets)->Unit(benchmark::kNanosecond);

ScenePush NetPush() {
  return MakeScenePush(0, 0, PushKind::kNet,
                       std::vector<Vector4<double>>(6, Vector4<double>(90.0, 10.0, 60.0, -5.0)));
}

void Jacobian_OfTail_Written(benchmark::State& state) {
  Walker walker(2);
  const ScenePush push = NetPush();
  Eigen::Matrix<double, 4, kNumParameters> jacobian;
  jacobian.setZero();
  for (auto _ : state) {
    benchmark::DoNotOptimize(walker);
    const TailOf<double> tail = TailAt(push, 80.0, 12, kDt);
    const double rate = tail.Rate(walker.p);
    AddTailJacobian(tail, walker.p, rate, tail.Decay(rate), &jacobian);
    benchmark::DoNotOptimize(jacobian);
  }
}
BENCHMARK(Jacobian_OfTail_Written)->Unit(benchmark::kNanosecond);

void Jacobian_OfTail_ByJets(benchmark::State& state) {
  Walker walker(2);
  const ScenePush push = NetPush();
  constexpr int kTail = kTailBase - kTailGain + 1;
  using Jet = ceres::Jet<double, kTail>;
  Eigen::Matrix<double, 4, kNumParameters> jacobian;
  jacobian.setZero();
  for (auto _ : state) {
    benchmark::DoNotOptimize(walker);
    ParameterSet<Jet> p;
    for (int i = 0; i < kTail; ++i) p[kTailGain + i] = Jet(walker.p[kTailGain + i], i);
    const Vector4<Jet> force = TailForce(push, 80.0, p, 12, kDt);
    for (int row = 0; row < 4; ++row) {
      jacobian.row(row).segment<kTail>(kTailGain) += force[row].v.transpose();
    }
    benchmark::DoNotOptimize(jacobian);
  }
}
BENCHMARK(Jacobian_OfTail_ByJets)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace pushid
