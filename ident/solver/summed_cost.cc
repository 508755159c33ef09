// ident: rows of all residual blocks, summed up.
#include "ident/solver/summed_cost.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace pushid {

using Eigen::VectorXd;

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
  std::set<ceres::ResidualBlockId> of_recordings;
  for (const FitProblem::Built::Block& block : built_.blocks) {
    if (block.cluster >= 0) of_recordings.insert(block.id);
  }
  std::vector<ceres::ResidualBlockId> all;
  problem.GetResidualBlocks(&all);
  for (ceres::ResidualBlockId id : all) {
    std::vector<double*> on;
    problem.GetParameterBlocksForResidualBlock(id, &on);
    Part part{problem.GetCostFunctionForResidualBlock(id),
              of_recordings.count(id) > 0,
              {on.begin(), on.end()},
              {},
              nullptr,
              {}};
    for (double* block : on) {
      const auto found = column_of.find(block);
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

void SummedCost::AddSums(const Part& part, SecondOrder* sum) {
  const RowMajorMatrix& gram = part.sums->plain.information();
  const size_t acting = part.of_acting.size();
  for (size_t a = 0; a < acting; ++a) {
    for (int i : part.of_acting[a]) {
      sum->gradient[i] += part.sums->plain.gradient()[a];
      for (size_t b = 0; b < acting; ++b) {
        const double product = gram(std::min(a, b), std::max(a, b));
        for (int j : part.of_acting[b]) sum->information(i, j) += product;
      }
    }
  }
}

bool SummedCost::AddPart(const Part& part, double* squares, SecondOrder* sum) const {
  if (part.sums != nullptr) {
    *squares += part.sums->squares;
    if (part.sums->ok && sum != nullptr) AddSums(part, sum);
    return part.sums->ok;
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

// Where demands alone cost more than all did where derivatives were asked for last, the step is
// refused, whatever the recordings say: nobody rolls them out. By more than any tolerance, so that
// no solver takes it for an end.
bool SummedCost::RefusedByDemands(double* residuals) const {
  constexpr double kClearly = 1.1;
  double squares = 0.0;
  if (!(squares_ > 0.0) || !AddParts(false, &squares, nullptr)) return false;
  if (!(squares > kClearly * squares_) || !std::isfinite(squares)) return false;
  Eigen::Map<VectorXd> values(residuals, num_residuals());
  values.setZero();
  values[values.size() - 1] = std::sqrt(squares);
  return true;
}

bool SummedCost::Evaluate(double const* const* x, double* residuals, double** jacobians) const {
  const int columns = parameter_block_sizes()[0];
  Eigen::Map<VectorXd> values(residuals, columns + 1);
  const Eigen::Map<const VectorXd> at(x[0], columns);
  const bool derivatives = jacobians != nullptr && jacobians[0] != nullptr;
  const bool known = derivatives && recordings_.AreAt(at);
  SetValues(x[0]);
  if (!derivatives && RefusedByDemands(residuals)) return true;
  // Demands alone are few: they go without threads, and count as no evaluation.
  if (built_.evaluation != nullptr && !known) {
    built_.evaluation->PrepareForEvaluation(derivatives, true);
  }
  if (!derivatives) {
    double squares = 0.0;
    if (!AddParts(true, &squares, nullptr) || !AddParts(false, &squares, nullptr)) return false;
    if (!std::isfinite(squares)) return false;
    values.setZero();
    values[columns] = std::sqrt(squares);
    return true;
  }
  if (!known) {
    RecordingSums here{at, 0.0, SecondOrder::Zero(columns)};
    if (!AddParts(true, &here.squares, &here.sums)) return false;
    if (!here.sums.information.allFinite()) return false;
    recordings_ = std::move(here);
  }
  SecondOrder linear = SecondOrder::Zero(columns);
  double squares = recordings_.squares;
  if (!AddParts(false, &squares, &linear)) return false;
  if (!std::isfinite(squares) || !linear.information.allFinite()) return false;
  squares_ = squares;
  secants_.Add(at, 0.5 * squares, recordings_.sums, linear);
  const RowMajorMatrix rows = secants_.Rows();
  values = rows.col(columns);
  Eigen::Map<RowMajorMatrix>(jacobians[0], columns + 1, columns) = rows.leftCols(columns);
  return true;
}

}  // namespace pushid
