// residuals: the rows of a rollout.
#include "residuals/cost_functions/condensed_rollout.h"

#include <cmath>

namespace pushid {
namespace {

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

}  // namespace

CondensedRollout::CondensedRollout(std::shared_ptr<const RolloutProblem> problem)
    : CondensedRows(std::move(problem)) {}

RolloutSums CondensedRollout::Alone(double const* const* blocks, LaneSums sums) const {
  if (alone_ == nullptr) alone_ = std::make_unique<LaneGroup>(std::vector{&problem()});
  return alone_->Evaluate({blocks}, sums)[0];
}

bool CondensedRollout::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  if (in_lanes() == nullptr) return CondensedRows::Evaluate(blocks, residuals, jacobians);
  const LaneSums sums = jacobians != nullptr ? LaneSums::kPlain : LaneSums::kSquares;
  return FillRows(Alone(blocks, sums), residuals, jacobians);
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  if (in_lanes() == nullptr) return CondensedRows::EvaluatePeople(blocks, robust, people);
  return FillPeople(Alone(blocks, robust ? LaneSums::kRobust : LaneSums::kPlain), robust, people);
}

bool CondensedRollout::FillRows(const RolloutSums& sums, double* residuals,
                                double** jacobians) const {
  if (!sums.ok) return false;
  if (jacobians == nullptr) {
    FillSquares(sums.squares, residuals);
  } else {
    CondensedRows::FillRows(sums.plain, residuals, jacobians);
  }
  return true;
}

bool CondensedRollout::FillPeople(const RolloutSums& sums, bool robust,
                                  std::vector<PersonRows>* people) const {
  if (!sums.ok) return false;
  *people = {RowsOf(sums.plain, robust ? &sums.robust : nullptr)};
  return true;
}

RolloutStatus CondensedRollout::Visit(double const* const* blocks, Derivatives derivatives,
                                      const RowsVisitor& visit) const {
  return VisitFrames(
      problem(), blocks, derivatives,
      [&](int frame, int person, const FrameVector<double>& residuals, FrameRows* by_column) {
        visit({person, problem().weight * problem().recording->Weight(person, frame),
               kFrameResiduals, residuals.data(), by_column->data()});
      },
      [&](int frame, int person, const PlateVector<double>& residuals, PlateRows* by_column) {
        const double seen = problem().recording->plates[person][frame].weight;
        visit({person, problem().weight * seen, kPlateResiduals, residuals.data(),
               by_column->data()});
      });
}

CondensedRows::CondensedRows(std::shared_ptr<const RolloutProblem> problem)
    : problem_(std::move(problem)), columns_(problem_->layout) {
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->layout.num_acting() + 1);
}

bool CondensedRows::Evaluate(double const* const* blocks, double* residuals,
                             double** jacobians) const {
  const Derivatives wanted = WantedDerivatives(*problem_, jacobians);
  const int held = wanted == Derivatives::kHeldWeights ? problem_->map.num_weights : 0;
  const int acting = problem_->layout.num_acting() - held;
  NormalEquations equations(wanted == Derivatives::kNone ? 0 : acting);
  double squares = 0.0;
  const RolloutStatus status = Visit(blocks, wanted, [&](const Rows& rows) {
    if (wanted == Derivatives::kNone) {
      squares += ConstVector(rows.residuals, rows.count).squaredNorm();
    } else {
      equations.Add(rows.count, rows.by_column, rows.residuals);
    }
  });
  if (!status.ok) return false;
  if (wanted == Derivatives::kNone) {
    FillSquares(squares, residuals);
  } else {
    FillRows(equations, residuals, jacobians);
  }
  return true;
}

void CondensedRows::FillSquares(double squares, double* residuals) const {
  Eigen::Map<Eigen::VectorXd> values(residuals, num_residuals());
  values.setZero();
  values[values.size() - 1] = std::sqrt(squares);
}

void CondensedRows::FillRows(const NormalEquations& equations, double* residuals,
                             double** jacobians) const {
  const int acting = equations.columns();
  const RowMajorMatrix factor = equations.Factor();
  Eigen::Map<Eigen::VectorXd> values(residuals, num_residuals());
  values.setZero();
  values.head(acting) = factor.col(acting).head(acting);
  values[values.size() - 1] = factor(acting, acting);
  RowMajorMatrix condensed = RowMajorMatrix::Zero(num_residuals(), acting);
  condensed.topRows(acting) = factor.topLeftCorner(acting, acting);
  columns_.Scatter(condensed, 0, num_residuals(), jacobians);
}

CondensedRows::PersonRows CondensedRows::RowsOf(const NormalEquations& plain,
                                                const NormalEquations* robust) const {
  const int acting = plain.columns();
  const RowMajorMatrix factor = plain.Factor();
  PersonRows rows{columns_.Expand(factor.leftCols(acting)), factor.col(acting), {}};
  if (robust != nullptr) {
    rows.robust_jacobian = columns_.Expand(robust->Factor().leftCols(acting));
  }
  return rows;
}

bool CondensedRows::EvaluatePeople(double const* const* blocks, bool robust,
                                   std::vector<PersonRows>* people) const {
  const int acting = problem_->layout.num_acting();
  std::vector<NormalEquations> plain(num_people(), NormalEquations(acting));
  std::vector<NormalEquations> corrected(robust ? num_people() : 0, NormalEquations(acting));
  const RolloutStatus status = Visit(blocks, Derivatives::kAll, [&](const Rows& rows) {
    plain[rows.person].Add(rows.count, rows.by_column, rows.residuals);
    if (!robust) return;
    CorrectForRobustLoss(ConstVector(rows.residuals, rows.count), rows.weight,
                         problem_->sigmas.OfFrames(),
                         Eigen::Map<RowMajorMatrix>(rows.by_column, rows.count,
                                                    NormalEquations::PaddedSize(acting)));
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
