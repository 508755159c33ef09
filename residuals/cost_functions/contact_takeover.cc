// residuals: the regression of a learned interaction on contact.
#include "residuals/cost_functions/contact_takeover.h"

#include <Eigen/Dense>
#include <cmath>

#include "models/neighbours.h"
#include "residuals/sensitivities/learned_pair_jacobian.h"

namespace pushid {
namespace {

const Eigen::Vector2d kTypicalContact(2000.0, 100.0);

// The forces on n and j of contact of unit stiffness, or unit damping.
template <typename Term>
Eigen::Matrix<double, 8, 1> ForcesOf(const Pair& pair, const ParameterSet<double>& p,
                                     const PendulumState<double>& n,
                                     const PendulumState<double>& j) {
  PairForce<double> force;
  Term::template Add<double>(pair, p, n, j, &force);
  Eigen::Matrix<double, 8, 1> both;
  both << force.on_n, force.on_j;
  return both;
}

}  // namespace

ContactTakeoverResidual::ContactTakeoverResidual(const std::vector<PendulumRecording>& recordings,
                                                 const ModelOptions& options,
                                                 const ParameterSet<double>& contact, double weight)
    : learned_(*options.learned), contact_(contact), weight_(weight) {
  mutable_parameter_block_sizes()->push_back(learned_.num_weights());
  set_num_residuals(2);
  ParameterSet<double> unit = contact;
  unit[kContactStiffness] = unit[kContactDamping] = 1.0;
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  for (const PendulumRecording& recording : recordings) {
    for (int t = 0; t < recording.num_frames(); ++t) {
      for (int n = 0; n < recording.num_people(); ++n) {
        for (int j = n + 1; j < recording.num_people(); ++j) {
          const double seen = std::pow(recording.Weight(n, t) * recording.Weight(j, t), 2);
          if (seen == 0.0) continue;
          Touch touch{
              PairOf(recording.scene, n, j), recording.states[n][t], recording.states[j][t], {}};
          if (!(PairGate<double>(touch.pair, contact, touch.n.q, touch.j.q) > 0.0)) continue;
          touch.coefficients.row(0) =
              ForcesOf<ContactTerm<true, false>>(touch.pair, unit, touch.n, touch.j);
          touch.coefficients.row(1) =
              ForcesOf<ContactTerm<false, true>>(touch.pair, unit, touch.n, touch.j);
          gram += seen * touch.coefficients * touch.coefficients.transpose();
          touch.coefficients *= seen;
          touches_.push_back(touch);
        }
      }
    }
  }
  const Eigen::Matrix2d inverse = gram.completeOrthogonalDecomposition().pseudoInverse();
  for (Touch& touch : touches_) touch.coefficients = (inverse * touch.coefficients).eval();
}

Eigen::Vector2d ContactTakeoverResidual::Regress(const double* weights,
                                                 Eigen::Matrix<double, 2, Eigen::Dynamic>* jacobian,
                                                 double* mean_square) const {
  if (jacobian != nullptr) jacobian->setZero(2, learned_.num_weights());
  const double* const own = weights + learned_.pair_at();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0;
  PairJacobian by_states;  // not asked for: the states do not move
  by_states.by_states.setZero();
  by_states.by_parameter.setZero();
  PairByWeight by_weight;
  for (const Touch& touch : touches_) {
    PairForce<double> force;
    AddLearnedPair(learned_.pair, own, touch.pair, contact_, touch.n, touch.j, &force);
    Eigen::Matrix<double, 8, 1> both;
    both << force.on_n, force.on_j;
    sum += touch.coefficients * both;
    squares += (force.on_n.head<2>() / touch.pair.body_n.mass).squaredNorm() +
               (force.on_j.head<2>() / touch.pair.body_j.mass).squaredNorm();
    if (jacobian == nullptr) continue;
    AddLearnedPairJacobian(learned_.pair, own, touch.pair, contact_, touch.n, touch.j, &by_states,
                           &by_weight);
    jacobian->middleCols(learned_.pair_at(), by_weight.cols()) += touch.coefficients * by_weight;
  }
  if (mean_square != nullptr) {
    *mean_square = squares / std::max(1.0, 2.0 * static_cast<double>(touches_.size()));
  }
  return sum;
}

bool ContactTakeoverResidual::Evaluate(double const* const* blocks, double* residuals,
                                       double** jacobians) const {
  Eigen::Matrix<double, 2, Eigen::Dynamic> by_weight;
  const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
  const Eigen::Vector2d taken = Regress(blocks[0], wanted ? &by_weight : nullptr, nullptr);
  const Eigen::Vector2d scale = weight_ * kTypicalContact.cwiseInverse();
  Eigen::Map<Eigen::Vector2d>(residuals, 2) = scale.cwiseProduct(taken);
  if (wanted) {
    using RowMajor = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], 2, learned_.num_weights()) = scale.asDiagonal() * by_weight;
  }
  return true;
}

ContactTakeover ContactTakeoverResidual::Of(const std::vector<double>& weights) const {
  double mean_square = 0.0;
  const Eigen::Vector2d taken = Regress(weights.data(), nullptr, &mean_square);
  return {taken[0], taken[1], std::sqrt(mean_square)};
}

}  // namespace pushid
