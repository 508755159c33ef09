// residuals: rows condensed, of a recording and of each of its people.
#include "residuals/cost_functions/condensed_rollout.h"

#include <cmath>

#include "residuals/jets/autodiff_rollout.h"

namespace pushid {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

// The rows of one frame of one person, of motion or of platforms.
struct FrameRows {
  int person, count;
  double weight;            // on all of them, which the robust loss does not see
  const double* residuals;  // count
  double* by_column;        // count x PaddedSize of the columns; the visitor may change them
};

// By the columns of `inputs`, which may be none.
template <typename Visit>
RolloutStatus VisitRows(const RolloutProblem& p, const SensitivityInputs& inputs,
                        const Visit& visit) {
  // A thread's own, used again: asking the system for them each time costs a tenth of a rollout.
  thread_local std::vector<double> residuals;
  thread_local RowMajorMatrix rows;
  const RolloutStatus status = RowsByJets(p, inputs, &residuals, &rows);
  if (!status.ok) return status;
  int row = 0;
  const auto next = [&](int person, int count, double weight) {
    double* const by_column = rows.data() + static_cast<size_t>(row) * inputs.num_columns;
    visit(FrameRows{person, count, weight, residuals.data() + row, by_column});
    row += count;
  };
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < p.recording->num_people(); ++n) {
      next(n, kFrameResiduals, p.weight * p.recording->Weight(n, t));
    }
  }
  const std::vector<int> on_plates = p.PeopleOnPlates();
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (int n : on_plates) next(n, kPlateResiduals, p.weight * p.recording->plates[n][t].weight);
  }
  return status;
}

}  // namespace

CondensedRollout::CondensedRollout(std::shared_ptr<const RolloutProblem> problem)
    : problem_(std::move(problem)), columns_(problem_->layout) {
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->layout.num_acting() + 1);
}

RolloutSums CondensedRollout::Alone(double const* const* blocks, LaneSums sums) const {
  if (alone_ == nullptr) alone_ = std::make_unique<LaneGroup>(std::vector{problem_.get()});
  return alone_->Evaluate({blocks}, sums)[0];
}

bool CondensedRollout::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  if (in_lanes() != nullptr) {
    const LaneSums wanted = jacobians != nullptr ? LaneSums::kPlain : LaneSums::kSquares;
    return FillRows(Alone(blocks, wanted), residuals, jacobians);
  }
  const RolloutProblem& p = *problem_;
  SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  int columns = p.layout.num_acting();
  if (jacobians == nullptr) {
    columns = inputs.num_columns = 0;
  } else if (p.map.num_weights > 0 && jacobians[p.layout.num_blocks() - 1] == nullptr) {
    columns -= p.map.num_weights;
    inputs.HoldWeights();
  }
  RolloutSums sums;
  sums.plain = NormalEquations(columns);
  sums.ok = VisitRows(p, inputs, [&](const FrameRows& rows) {
              if (jacobians == nullptr) {
                sums.squares += ConstVector(rows.residuals, rows.count).squaredNorm();
              } else {
                sums.plain.Add(rows.count, rows.by_column, rows.residuals);
              }
            }).ok;
  return FillRows(sums, residuals, jacobians);
}

bool CondensedRollout::FillRows(const RolloutSums& sums, double* residuals,
                                double** jacobians) const {
  if (!sums.ok) return false;
  Eigen::Map<Eigen::VectorXd> values(residuals, num_residuals());
  values.setZero();
  if (jacobians == nullptr) {
    values[values.size() - 1] = std::sqrt(sums.squares);
    return true;
  }
  const int acting = sums.plain.columns();
  const RowMajorMatrix factor = sums.plain.Factor();
  values.head(acting) = factor.col(acting).head(acting);
  values[values.size() - 1] = factor(acting, acting);
  RowMajorMatrix condensed = RowMajorMatrix::Zero(num_residuals(), acting);
  condensed.topRows(acting) = factor.topLeftCorner(acting, acting);
  columns_.Scatter(condensed, 0, num_residuals(), jacobians);
  return true;
}

CondensedRollout::PersonRows CondensedRollout::RowsOf(const NormalEquations& plain,
                                                      const NormalEquations* robust) const {
  const int acting = plain.columns();
  const RowMajorMatrix factor = plain.Factor();
  PersonRows rows{columns_.Expand(factor.leftCols(acting)), factor.col(acting), {}};
  if (robust != nullptr) {
    rows.robust_jacobian = columns_.Expand(robust->Factor().leftCols(acting));
  }
  return rows;
}

bool CondensedRollout::FillPeople(const RolloutSums& sums, bool robust,
                                  std::vector<PersonRows>* people) const {
  if (!sums.ok) return false;
  *people = {RowsOf(sums.plain, robust ? &sums.robust : nullptr)};
  return true;
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  if (in_lanes() != nullptr) {
    return FillPeople(Alone(blocks, robust ? LaneSums::kRobust : LaneSums::kPlain), robust, people);
  }
  const RolloutProblem& p = *problem_;
  const int acting = p.layout.num_acting();
  std::vector<NormalEquations> plain(num_people(), NormalEquations(acting));
  std::vector<NormalEquations> corrected(robust ? num_people() : 0, NormalEquations(acting));
  const SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  const RolloutStatus status = VisitRows(p, inputs, [&](const FrameRows& rows) {
    plain[rows.person].Add(rows.count, rows.by_column, rows.residuals);
    if (!robust) return;
    CorrectForRobustLoss(
        ConstVector(rows.residuals, rows.count), rows.weight, p.sigmas.OfFrames(),
        Eigen::Map<RowMajorMatrix>(rows.by_column, rows.count, inputs.num_columns));
    corrected[rows.person].Add(rows.count, rows.by_column, rows.residuals);
  });
  if (!status.ok) return false;
  people->clear();
  for (int n = 0; n < num_people(); ++n) {
    people->push_back(RowsOf(plain[n], robust ? &corrected[n] : nullptr));
  }
  return true;
}

}  // namespace pushid
