// residuals: the rows of a rollout, summed up as they come.
#include "residuals/cost_functions/condensed_rollout.h"

#include <algorithm>

#include "residuals/cost_functions/rollout_autodiff.h"

namespace pushid {

CondensedRollout::CondensedRollout(std::shared_ptr<const RolloutProblem> problem,
                                   JacobianMethod method)
    : problem_(std::move(problem)), method_(method), columns_(problem_->layout) {
  if (method == JacobianMethod::kAutodiff) oracle_ = MakeRolloutCost(problem_, method);
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->layout.num_acting() + 1);
}

bool CondensedRollout::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const Derivatives wanted = WantedDerivatives(*problem_, jacobians);
  const int held = wanted == Derivatives::kHeldWeights ? problem_->map.num_weights : 0;
  const int acting = problem_->layout.num_acting() - held;
  NormalEquations equations(wanted == Derivatives::kNone ? 0 : acting);
  double squares = 0.0;
  const RolloutStatus status =
      Visit(blocks, wanted, [&](int, int, const FrameVector<double>& r, FrameRows* by_column) {
        squares += r.squaredNorm();
        if (wanted == Derivatives::kNone) return;
        by_column->col(acting) = r;
        equations.Add(kFrameResiduals, by_column->data());
      });
  if (!status.ok) return false;
  Eigen::Map<Eigen::VectorXd> values(residuals, num_residuals());
  values.setZero();
  if (wanted == Derivatives::kNone) {
    values[values.size() - 1] = std::sqrt(squares);
    return true;
  }
  const RowMajorMatrix factor = equations.Factor();
  values.head(acting) = factor.col(acting).head(acting);
  values[values.size() - 1] = factor(acting, acting);
  RowMajorMatrix rows = RowMajorMatrix::Zero(num_residuals(), acting);
  rows.topRows(acting) = factor.topLeftCorner(acting, acting);
  columns_.Scatter(rows, 0, num_residuals(), jacobians);
  return true;
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  const int acting = problem_->layout.num_acting();
  std::vector<NormalEquations> plain(num_people(), NormalEquations(acting));
  std::vector<NormalEquations> corrected(robust ? num_people() : 0, NormalEquations(acting));
  const RolloutStatus status =
      Visit(blocks, Derivatives::kAll,
            [&](int frame, int person, const FrameVector<double>& r, FrameRows* by_column) {
              by_column->col(acting) = r;
              plain[person].Add(kFrameResiduals, by_column->data());
              if (!robust) return;
              CorrectForRobustLoss(r, problem_->weight * problem_->recording->Weight(person, frame),
                                   problem_->sigmas.OfFrames(), by_column->leftCols(acting));
              corrected[person].Add(kFrameResiduals, by_column->data());
            });
  if (!status.ok) return false;
  people->clear();
  for (int n = 0; n < num_people(); ++n) {
    const RowMajorMatrix factor = plain[n].Factor();
    PersonRows rows{columns_.Expand(factor.leftCols(acting)), factor.col(acting), {}};
    if (robust) rows.robust_jacobian = columns_.Expand(corrected[n].Factor().leftCols(acting));
    people->push_back(std::move(rows));
  }
  return true;
}

RolloutStatus CondensedRollout::Visit(double const* const* blocks, Derivatives derivatives,
                                      const FrameVisitor& visit) const {
  if (oracle_ == nullptr) return VisitFrames(*problem_, blocks, derivatives, visit);
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
  const int columns = NormalEquations::PaddedSize(problem_->layout.num_acting());
  FrameRows by_column(kFrameResiduals, with_rows ? columns : 0);
  for (int row = 0; row < rows; row += kFrameResiduals) {
    if (with_rows) columns_.Gather(by_block, row, &by_column);
    const int at = row / kFrameResiduals;
    visit(1 + at / people, at % people, Eigen::Map<FrameVector<double>>(residuals.data() + row),
          &by_column);
  }
  return {};
}

}  // namespace pushid
