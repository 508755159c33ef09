// ident: updates of the curvature, the rows that stand for it, and rows of all residual blocks
// summed up.
#include "ident/solver/structured_secants.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "models/decompositions.h"

namespace pushid {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

// The first S keeps at least so much of J'J: one step tells of one direction.
constexpr double kFirstShare = 0.3;
// S is given up where it is so many times as far as J'J from what a step brought, until it is
// nearer.
constexpr double kClearly = 20.0;
// Least curvature along a step that is learned from, and of B in any direction, to that of J'J.
constexpr double kLeastLearned = 1e-3, kLeastCurvature = 0.1;
constexpr double kLeastPart = 1e-3;    // of S
constexpr double kLeastPivot = 1e-14;  // of a column's own (residuals/normal_equations.h)

}  // namespace

void StructuredSecants::Add(const VectorXd& x, double cost, const SecondOrder& curved,
                            const SecondOrder& linear) {
  if (x_.size() == 0) {
    if (beyond_.size() == 0) beyond_ = MatrixXd::Zero(x.size(), x.size());
  } else if (learns_ && x != x_) {
    const VectorXd step = x - x_;
    Judge(step, cost_ - cost);
    Learn(step, curved, linear);
  }
  x_ = x;
  cost_ = cost;
  curved_gradient_ = curved.gradient;
  gradient_ = curved.gradient + linear.gradient;
  information_ = curved.information + linear.information;
}

// Whether the last step's fall of the cost is as J'J foretold, and nothing like what S did.
void StructuredSecants::Judge(const VectorXd& step, double fall) {
  const double plain = -(gradient_.dot(step) + 0.5 * step.dot(information_ * step));
  const double with = plain - 0.5 * step.dot(beyond_ * step);
  const double off_plain = std::abs(plain - fall), off_with = std::abs(with - fall);
  use_ = beyond_.isZero(0.0) || off_with < (use_ ? kClearly : 1.0) * off_plain;
}

void StructuredSecants::Learn(const VectorXd& step, const SecondOrder& curved,
                              const SecondOrder& linear) {
  const VectorXd by_curved = curved.information * step;
  const VectorXd y = curved.gradient - curved_gradient_;
  const double known = step.dot(by_curved), seen = step.dot(y);
  if (!(known > 0.0)) return;
  if (beyond_.isZero(0.0)) {
    beyond_ = (std::clamp(seen / known, kFirstShare, 1.0) - 1.0) * curved.information;
  } else {
    const double told = std::abs(step.dot(beyond_ * step));
    beyond_ *= told > 0.0 ? std::min(1.0, std::abs(seen - known) / told) : 1.0;
  }
  const VectorXd by_linear = linear.information * step;
  const VectorXd b = by_curved + by_linear + beyond_ * step, turned = y + by_linear;
  const double by_b = step.dot(b), by_turned = step.dot(turned);
  const double least = kLeastLearned * (known + step.dot(by_linear));
  if (by_b < least || by_turned < least) return;
  beyond_ += turned * turned.transpose() / by_turned - b * b.transpose() / by_b;
}

RowMajorMatrix StructuredSecants::Rows() const {
  const Eigen::Index size = x_.size();
  VectorXd length = information_.diagonal().cwiseSqrt();
  length = (length.array() > 0.0).select(length, 1.0);
  const auto scale = length.cwiseInverse().asDiagonal();
  MatrixXd scaled = scale * information_ * scale;
  scaled.diagonal().array() += kLeastPivot;
  MatrixXd root = CholeskyFactor(scaled);
  if (root.size() == 0) {  // rounding
    scaled.diagonal().array() += std::sqrt(kLeastPivot);
    root = CholeskyFactor(scaled);
    CHECK_GT(root.size(), 0);
  }
  const auto lower = root.triangularView<Eigen::Lower>();
  const VectorXd z = lower.solve(scale * gradient_);
  RowMajorMatrix rows = RowMajorMatrix::Zero(size + 1, size + 1);
  const auto set = [&](const MatrixXd& b, const VectorXd& at) {
    rows.topLeftCorner(size, size) = b * length.asDiagonal();
    rows.col(size).head(size) = at;
    rows(size, size) = std::sqrt(std::max(0.0, 2.0 * cost_ - at.squaredNorm()));
  };
  set(root.transpose(), z);
  if (!use_ || beyond_.isZero(0.0)) return rows;
  const MatrixXd half = lower.solve(scale * beyond_ * scale);
  const SymmetricEigen ratio = DecomposeSymmetric(lower.solve(half.transpose()));
  const VectorXd along = ratio.vectors.transpose() * z;
  VectorXd share, turned;
  // The part of S that leaves the cost above nothing: no rows have one below.
  double part = 2.0;
  do {
    part *= 0.5;
    share = (1.0 + part * ratio.values.array()).max(kLeastCurvature).sqrt();
    turned = along.cwiseQuotient(share);
  } while (turned.squaredNorm() > 2.0 * cost_ && part > kLeastPart);
  if (part <= kLeastPart) return rows;
  set(share.asDiagonal() * ratio.vectors.transpose() * root.transpose(), turned);
  return rows;
}

SummedCost::SummedCost(FitProblem::Built* built, StructuredSecants secants, RecordingSums known)
    : built_(*built), secants_(std::move(secants)), recordings_(std::move(known)) {
  const ceres::Problem& problem = *built_.problem;
  std::map<const double*, int> column_of;
  int columns = 0;
  for (double* block : built_.parameter_blocks) {
    if (problem.IsParameterBlockConstant(block)) continue;
    moving_.push_back({block, columns, problem.ParameterBlockSize(block)});
    column_of[block] = columns;
    columns += moving_.back().size;
  }
  mutable_parameter_block_sizes()->push_back(columns);
  set_num_residuals(columns + 1);
  for (const FitProblem::Built::Block& block : built_.blocks) {
    std::vector<double*> on;
    problem.GetParameterBlocksForResidualBlock(block.id, &on);
    Part part{problem.GetCostFunctionForResidualBlock(block.id),
              block.cluster >= 0,
              {on.begin(), on.end()},
              {},
              nullptr,
              {}};
    for (double* values : on) {
      const auto found = column_of.find(values);
      part.columns.push_back(found == column_of.end() ? -1 : found->second);
    }
    part.sums = ParallelEvaluation::SumsOf(part.cost);
    if (part.sums != nullptr) {
      const BlockLayout& layout = ParallelEvaluation::ProblemOf(part.cost)->layout;
      part.of_acting.resize(layout.num_acting());
      auto acting = layout.ActingOfColumns();
      auto next = acting.begin();
      for (size_t b = 0; b < on.size(); ++b) {
        for (int i = 0; i < problem.ParameterBlockSize(on[b]); ++i, ++next) {
          for (int a = next->first; part.columns[b] >= 0 && a <= next->second; ++a) {
            part.of_acting[a].push_back(part.columns[b] + i);
          }
        }
      }
    }
    parts_.push_back(std::move(part));
  }
}

std::vector<double> SummedCost::Values() const {
  std::vector<double> values;
  for (const Block& block : moving_) {
    values.insert(values.end(), block.values, block.values + block.size);
  }
  return values;
}

void SummedCost::SetValues(const double* x) const {
  for (const Block& block : moving_) std::copy_n(x + block.column, block.size, block.values);
}

void SummedCost::SetBounds(ceres::Problem* problem, double* x) const {
  for (const Block& block : moving_) {
    for (int i = 0; i < block.size; ++i) {
      problem->SetParameterLowerBound(x, block.column + i,
                                      built_.problem->GetParameterLowerBound(block.values, i));
      problem->SetParameterUpperBound(x, block.column + i,
                                      built_.problem->GetParameterUpperBound(block.values, i));
    }
  }
}

bool SummedCost::AddPart(const Part& part, double* squares, SecondOrder* sum) {
  if (part.sums != nullptr) {
    const RolloutSums& sums = *part.sums;
    *squares += sums.squares;
    const size_t acting = sums.ok && sum != nullptr ? sums.plain.columns() : 0;
    for (size_t a = 0; a < acting; ++a) {
      for (int i : part.of_acting[a]) {
        sum->gradient[i] += sums.plain.gradient()[a];
        for (size_t b = 0; b < acting; ++b) {
          const double product = sums.plain.information()(std::min(a, b), std::max(a, b));
          for (int j : part.of_acting[b]) sum->information(i, j) += product;
        }
      }
    }
    return sums.ok;
  }
  const int rows = part.cost->num_residuals();
  const std::vector<int>& sizes = part.cost->parameter_block_sizes();
  VectorXd residuals(rows);
  std::vector<RowMajorMatrix> by_block(sizes.size());
  std::vector<double*> pointers(sizes.size(), nullptr);
  for (size_t b = 0; b < sizes.size(); ++b) {
    if (part.columns[b] < 0 || sum == nullptr) continue;
    by_block[b].resize(rows, sizes[b]);
    pointers[b] = by_block[b].data();
  }
  if (!part.cost->Evaluate(part.on.data(), residuals.data(),
                           sum != nullptr ? pointers.data() : nullptr)) {
    return false;
  }
  *squares += residuals.squaredNorm();
  for (size_t b = 0; b < sizes.size(); ++b) {
    if (pointers[b] == nullptr) continue;
    const auto own = by_block[b].transpose();
    sum->gradient.segment(part.columns[b], sizes[b]).noalias() += own * residuals;
    for (size_t c = 0; c < sizes.size(); ++c) {
      if (pointers[c] == nullptr) continue;
      sum->information.block(part.columns[b], part.columns[c], sizes[b], sizes[c]).noalias() +=
          own * by_block[c];
    }
  }
  return true;
}

bool SummedCost::AddParts(bool of_recordings, double* squares, SecondOrder* sum) const {
  return std::all_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    return part.of_recording != of_recordings || AddPart(part, squares, sum);
  });
}

bool SummedCost::SetCost(double squares, double* residuals) const {
  std::fill_n(residuals, num_residuals() - 1, 0.0);
  residuals[num_residuals() - 1] = std::sqrt(squares);
  return std::isfinite(squares);
}

bool SummedCost::Evaluate(double const* const* x, double* residuals, double** jacobians) const {
  constexpr double kClearly = 1.1;
  const int columns = parameter_block_sizes()[0];
  const Eigen::Map<const VectorXd> at(x[0], columns);
  const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
  const bool known = derivatives && recordings_.AreAt(at);
  SetValues(x[0]);
  // The step is refused without a rollout of the recordings if the demands alone cost more than
  // everything did where derivatives were asked for last, by more than any tolerance, so that no
  // solver takes it for an end. Demands are few: they go without threads, and count as no
  // evaluation.
  double squares = 0.0;
  if (!derivatives && squares_ > 0.0 && AddParts(false, &squares, nullptr) &&
      squares > kClearly * squares_ && std::isfinite(squares)) {
    return SetCost(squares, residuals);
  }
  if (built_.evaluation != nullptr && !known) {
    built_.evaluation->PrepareForEvaluation(derivatives, true);
  }
  if (!derivatives) {
    squares = 0.0;
    return AddParts(true, &squares, nullptr) && AddParts(false, &squares, nullptr) &&
           SetCost(squares, residuals);
  }
  if (!known) {
    RecordingSums here{at, 0.0, SecondOrder::Zero(columns)};
    if (!AddParts(true, &here.squares, &here.sums)) return false;
    if (!here.sums.information.allFinite()) return false;
    recordings_ = std::move(here);
  }
  SecondOrder linear = SecondOrder::Zero(columns);
  squares = recordings_.squares;
  if (!AddParts(false, &squares, &linear)) return false;
  if (!std::isfinite(squares) || !linear.information.allFinite()) return false;
  squares_ = squares;
  secants_.Add(at, 0.5 * squares, recordings_.sums, linear);
  const RowMajorMatrix rows = secants_.Rows();
  Eigen::Map<VectorXd>(residuals, columns + 1) = rows.col(columns);
  Eigen::Map<RowMajorMatrix>(jacobians[0], columns + 1, columns) = rows.leftCols(columns);
  return true;
}

}  // namespace pushid
