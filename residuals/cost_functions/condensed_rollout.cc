// residuals: the rows of a rollout, by sensitivities or by the oracle.
#include "residuals/cost_functions/condensed_rollout.h"

#include "residuals/cost_functions/rollout_autodiff.h"

namespace pushid {

CondensedRollout::CondensedRollout(std::shared_ptr<const RolloutProblem> problem,
                                   JacobianMethod method)
    : CondensedRows(problem), method_(method) {
  if (method == JacobianMethod::kAutodiff) oracle_ = MakeRolloutCost(std::move(problem), method);
}

RolloutSums CondensedRollout::Alone(double const* const* blocks, LaneSums sums) const {
  if (alone_ == nullptr) alone_ = std::make_unique<LaneGroup>(std::vector{&problem()});
  return alone_->Evaluate({blocks}, sums)[0];
}

bool CondensedRollout::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  if (in_lanes() == nullptr) return CondensedRows::Evaluate(blocks, residuals, jacobians);
  const LaneSums sums = jacobians != nullptr ? LaneSums::kPlain : LaneSums::kSquares;
  return Tell(Alone(blocks, sums), residuals, jacobians);
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  if (in_lanes() == nullptr) return CondensedRows::EvaluatePeople(blocks, robust, people);
  return TellPeople(Alone(blocks, robust ? LaneSums::kRobust : LaneSums::kPlain), robust, people);
}

bool CondensedRollout::Tell(const RolloutSums& sums, double* residuals, double** jacobians) const {
  if (!sums.ok) return false;
  if (jacobians == nullptr) {
    TellSquares(sums.squares, residuals);
  } else {
    CondensedRows::Tell(sums.plain, residuals, jacobians);
  }
  return true;
}

bool CondensedRollout::TellPeople(const RolloutSums& sums, bool robust,
                                  std::vector<PersonRows>* people) const {
  if (!sums.ok) return false;
  *people = {RowsOf(sums.plain, robust ? &sums.robust : nullptr)};
  return true;
}

RolloutStatus CondensedRollout::Visit(double const* const* blocks, Derivatives derivatives,
                                      const RowsVisitor& visit) const {
  const auto told = [&](int frame, int person, const double* residuals, FrameRows* by_column) {
    visit({person, problem().weight * problem().recording->Weight(person, frame), kFrameResiduals,
           residuals, by_column->data()});
  };
  if (oracle_ == nullptr) {
    return VisitFrames(problem(), blocks, derivatives,
                       [&told](int frame, int person, const FrameVector<double>& r,
                               FrameRows* by_column) { told(frame, person, r.data(), by_column); });
  }
  const int rows = oracle_->num_residuals(), people = num_people();
  std::vector<double> residuals(rows);
  std::vector<RowMajorMatrix> by_block;
  std::vector<double*> jacobians;
  for (int size : parameter_block_sizes()) by_block.emplace_back(rows, size);
  for (RowMajorMatrix& block : by_block) jacobians.push_back(block.data());
  const bool with_rows = derivatives != Derivatives::kNone;
  if (!oracle_->Evaluate(blocks, residuals.data(), with_rows ? jacobians.data() : nullptr)) {
    return {false, 0, 0, "rollout"};
  }
  const int padded = NormalEquations::PaddedSize(problem().layout.num_acting());
  FrameRows by_column(kFrameResiduals, with_rows ? padded : 0);
  for (int row = 0; row < rows; row += kFrameResiduals) {
    if (with_rows) columns().Gather(by_block, row, &by_column);
    const int at = row / kFrameResiduals;
    told(1 + at / people, at % people, residuals.data() + row, &by_column);
  }
  return {};
}

}  // namespace pushid
