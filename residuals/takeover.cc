// residuals: regressions of learned forces.
#include "residuals/takeover.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "models/decompositions.h"
#include "models/interaction.h"
#include "models/learned_terms.h"
#include "models/neighbours.h"
#include "models/self_force.h"

namespace pushid {
namespace {

// Weighted least squares of forces (kForces numbers a frame) on those of kGains gains of one unit.
template <int kGains, int kForces>
class ForceRegression {
 public:
  using UnitForces = Eigen::Matrix<double, kGains, kForces>;
  using Force = Eigen::Matrix<double, kForces, 1>;

  void Add(const UnitForces& unit, const Force& force, double weight) {
    gram_ += weight * unit * unit.transpose();
    rows_.emplace_back(weight * unit, force);
  }

  Eigen::Matrix<double, kGains, 1> Solve() const {
    const Gram inverse = PseudoInverse(gram_);
    Eigen::Matrix<double, kGains, 1> sum = Eigen::Matrix<double, kGains, 1>::Zero();
    for (const auto& [unit, force] : rows_) sum += (inverse * unit).eval() * force;
    return sum;
  }

 private:
  using Gram = Eigen::Matrix<double, kGains, kGains>;
  Gram gram_ = Gram::Zero();
  std::vector<std::pair<UnitForces, Force>> rows_;
};

using PairForceVector = Eigen::Matrix<double, 8, 1>;

PairForceVector Both(const PairForce<double>& force) {
  PairForceVector both;
  both << force.on_n, force.on_j;
  return both;
}

template <typename Term>
PairForceVector ForcesOf(const Pair& pair, const ParameterSet<double>& p,
                         const PendulumState<double>& n, const PendulumState<double>& j) {
  PairForce<double> force;
  Term::template Add<double>(pair, p, n, j, &force);
  return Both(force);
}

}  // namespace

Takeover TakeoverOf(const std::vector<PendulumRecording>& recordings, const ModelOptions& model) {
  const LearnedTerms& network = *model.learned;
  ForceRegression<3, 4> regression;
  double squares = 0.0, frames = 0.0;
  for (const PendulumRecording& recording : recordings) {
    for (int n = 0; n < recording.num_people(); ++n) {
      const ScenePerson& person = recording.scene.people[n];
      const SelfForce self(model, person.body, person.start.q, recording.scene.dt);
      const double mass = person.body.mass;
      NetworkState<double> memory(network.shape, person.body);
      for (int t = 0; t < recording.num_frames(); ++t) {
        const PendulumState<double>& state = recording.states[n][t];
        const Eigen::Vector2d deviation = state.q.tail<2>() - self.posture;
        ForceRegression<3, 4>::UnitForces unit = ForceRegression<3, 4>::UnitForces::Zero();
        unit(0, 0) = -self.scale.force * state.qd[0];
        unit(0, 1) = -self.scale.force * state.qd[1];
        unit(1, 2) = -self.scale.stiffness * deviation[0];
        unit(2, 2) = -self.scale.damping * state.qd[2];
        SetNetworkInputs<double>(deviation[0], deviation[1], state.qd, &memory);
        const Vector4<double> force =
            StepNetwork(network.shape, network.weights.data(), mass, &memory);
        regression.Add(unit, force, recording.Weight(n, t) * recording.Weight(n, t));
        squares += force.head<2>().squaredNorm() / (mass * mass);
        frames += 1.0;
      }
    }
  }
  const Eigen::Vector3d gains = regression.Solve();
  return {gains[0], gains[1], gains[2], std::sqrt(squares / std::max(1.0, frames))};
}

ContactTakeover ContactTakeoverOf(const std::vector<PendulumRecording>& recordings,
                                  const ModelOptions& model, const ParameterSet<double>& contact) {
  const LearnedTerms& learned = *model.learned;
  const double* const weights = learned.weights.data() + learned.pair_at();
  ParameterSet<double> unit = contact;
  unit[kContactStiffness] = unit[kContactDamping] = 1.0;
  ForceRegression<2, 8> regression;
  double squares = 0.0, touches = 0.0;
  for (const PendulumRecording& recording : recordings) {
    for (int t = 0; t < recording.num_frames(); ++t) {
      for (int n = 0; n < recording.num_people(); ++n) {
        for (int j = n + 1; j < recording.num_people(); ++j) {
          const double seen = std::pow(recording.Weight(n, t) * recording.Weight(j, t), 2);
          if (seen == 0.0) continue;
          const Pair pair = PairOf(recording.scene, n, j);
          const PendulumState<double>&at_n = recording.states[n][t], &at_j = recording.states[j][t];
          if (!(PairGate<double>(learned.pair, pair, contact, at_n.q, at_j.q) > 0.0)) continue;
          ForceRegression<2, 8>::UnitForces by_unit;
          by_unit.row(0) = ForcesOf<ContactTerm<true, false>>(pair, unit, at_n, at_j);
          by_unit.row(1) = ForcesOf<ContactTerm<false, true>>(pair, unit, at_n, at_j);
          PairForce<double> force;
          AddLearnedPair(learned.pair, weights, pair, contact, at_n, at_j, &force);
          regression.Add(by_unit, Both(force), seen);
          squares += (force.on_n.head<2>() / pair.body_n.mass).squaredNorm() +
                     (force.on_j.head<2>() / pair.body_j.mass).squaredNorm();
          touches += 2.0;
        }
      }
    }
  }
  const Eigen::Vector2d gains = regression.Solve();
  return {gains[0], gains[1], std::sqrt(squares / std::max(1.0, touches))};
}

}  // namespace pushid
