// ident: sensitivities and differences of raw residuals.
#include "ident/uncertainty/recording_rows.h"

#include <algorithm>
#include <list>

#include "ident/uncertainty/covariance.h"
#include "residuals/cost_functions/lane_group.h"

namespace pushid {
namespace {

constexpr double kStep = 1e-5;  // of a column's unit

using Eigen::Index;

// With d(model - (1 + eta) measured) = d(model) - measured, the column holds the noise of what was
// measured, which the residual holds as well: their product is no longer zero on average. The same
// model, with d(model / (1 + eta) - measured) = d(model) - model: less by the residual.
void LeaveOutNoiseOfRates(const Eigen::VectorXd& here, Index motion,
                          Eigen::Ref<Eigen::VectorXd> column) {
  for (Index k = 0; k < motion; ++k) {
    const Index channel = k % kFrameResiduals;
    const bool rate = channel == 3 || channel == 4 || channel >= 7;
    if (rate) column[k] -= here[k];
  }
}

Eigen::Map<const Eigen::VectorXd> AsVector(const std::vector<double>& values) {
  return {values.data(), static_cast<Index>(values.size())};
}

}  // namespace

RowsOfRecordings::RowsOfRecordings(const FitProblem& problem, const FitPoint& point,
                                   const std::vector<Assumption>& assumptions)
    : problem_(problem),
      assumptions_(assumptions),
      plain_(PlainSigmas(problem)),
      here_{problem.options().model, problem.map(), point},
      unit_(Units(FittedColumns(problem, point))) {
  Index next = 0;
  const auto add = [this, &next](const std::vector<double>& block) {
    first_[block.data()] = next;
    next += static_cast<Index>(block.size());
  };
  add(here_.point.shared);
  for (const auto& [unit, block] : here_.point.unit) add(block);
  for (const auto& [recording, block] : here_.point.velocity) add(block);
  std::vector<double> flat = point.Flat();
  for (size_t c = 0; c < flat.size(); ++c) {
    Seen& moved = moved_.emplace_back(here_);
    const double value = flat[c];
    flat[c] += kStep * unit_[static_cast<Index>(c)];
    moved.point.SetFlat(flat);
    flat[c] = value;
  }
  for (const Assumption& assumption : assumptions) under_.push_back(Under(assumption));
}

RowsOfRecordings::Seen RowsOfRecordings::Under(const Assumption& assumption) const {
  Seen seen = here_;
  for (const auto& [index, shift] : assumption.along) seen.point.shared[index] += shift;
  if (assumption.of_options == nullptr) return seen;
  FitOptions options = problem_.options();
  assumption.of_options(assumption.step, &options);
  seen.model = options.model;
  seen.map.values = options.table.Values();
  return seen;
}

RolloutAt RowsOfRecordings::Rollout(Seen* seen, const PendulumRecording& recording,
                                    int index) const {
  return {MakeRolloutProblem(recording, seen->model, seen->map, plain_, 1.0, 0),
          problem_.RecordingBlocks(&seen->point, index)};
}

// Of the fit, and among those of the recording's blocks; none on bounds.
std::vector<std::pair<Index, Index>> RowsOfRecordings::OwnColumns(const RolloutAt& here) const {
  std::vector<std::pair<Index, Index>> columns;
  const std::vector<int> sizes = here.problem->layout.BlockSizes();
  Index in_blocks = 0;
  for (size_t b = 0; b < sizes.size(); ++b) {
    const Index first = first_.at(here.blocks[b]);
    for (Index c = first; c < first + sizes[b]; ++c, ++in_blocks) {
      if (unit_[c] > 0.0) columns.emplace_back(c, in_blocks);
    }
  }
  return columns;
}

RecordingRows RowsOfRecordings::BySensitivities(const RolloutAt& here) const {
  const RolloutProblem& problem = *here.problem;
  RecordingRows rows;
  rows.residuals.resize(problem.num_residuals());
  const Index acting = problem.layout.num_acting();
  RowMajorMatrix by_acting(rows.residuals.size(), acting);
  Index row = 0;
  const auto add = [&](int, int, const auto& residual, const auto* by_column) {
    rows.residuals.segment(row, residual.size()) = residual;
    by_acting.middleRows(row, residual.size()) = by_column->leftCols(acting);
    row += residual.size();
  };
  if (!VisitFrames(problem, here.blocks.data(), Derivatives::kAll, add, add).ok) return {};
  const RowMajorMatrix by_blocks = ActingColumns(problem.layout).Expand(by_acting);
  std::vector<Index> in_blocks;
  for (const auto& [column, in_block] : OwnColumns(here)) {
    rows.columns.push_back(column);
    in_blocks.push_back(in_block);
  }
  rows.by_column = by_blocks(Eigen::all, in_blocks);
  return rows;
}

// What `rows` does not hold yet. A column whose changed rollout fails is left out.
RecordingRows RowsOfRecordings::ByDifferences(const RolloutAt& here, int index,
                                              RecordingRows rows) {
  const PendulumRecording& recording = problem_.recordings()[index];
  std::vector<RolloutAt> rollouts;
  std::vector<Index> columns;
  const bool none = rows.residuals.size() == 0;
  if (none) {
    rollouts.push_back(here);
    for (const auto& [column, in_blocks] : OwnColumns(here)) {
      columns.push_back(column);
      rollouts.push_back(Rollout(&moved_[column], recording, index));
    }
  }
  std::list<PendulumRecording> changed;
  for (size_t k = 0; k < assumptions_.size(); ++k) {
    const Assumption& assumption = assumptions_[k];
    const PendulumRecording* seen = &recording;
    if (assumption.of_recording != nullptr) {
      assumption.of_recording(assumption.step, &changed.emplace_back(recording));
      seen = &changed.back();
    }
    columns.push_back(num_estimates() + static_cast<Index>(k));
    rollouts.push_back(Rollout(&under_[k], *seen, index));
  }
  std::vector<std::vector<double>> there = ResidualsOf(rollouts);
  if (none) {
    rows.residuals = AsVector(there[0]);
    there.erase(there.begin());
    if (rows.residuals.size() == 0) return {};
  }
  Index next = rows.by_column.cols();
  rows.by_column.conservativeResize(rows.residuals.size(), next + static_cast<Index>(there.size()));
  for (size_t j = 0; j < there.size(); ++j) {
    const Index column = columns[j], assumed = column - num_estimates();
    if (static_cast<Index>(there[j].size()) != rows.residuals.size()) continue;
    const double step =
        assumed < 0 ? kStep * unit_[column] : assumptions_[static_cast<size_t>(assumed)].step;
    auto by = rows.by_column.col(next);
    by = (AsVector(there[j]) - rows.residuals) / step;
    rows.columns.push_back(column);
    ++next;
    if (assumed < 0) continue;
    const Assumption& assumption = assumptions_[static_cast<size_t>(assumed)];
    if (assumption.of_rates) {
      LeaveOutNoiseOfRates(rows.residuals, static_cast<Index>(problem_.NumMotionRows(index)), by);
    }
    // As if the estimates had stayed where they are.
    for (const auto& [of, shift] : assumption.along) {
      const auto found =
          std::find(rows.columns.begin(), rows.columns.end(), static_cast<Index>(of));
      if (found == rows.columns.end()) continue;
      by -= shift / step * rows.by_column.col(found - rows.columns.begin());
    }
  }
  rows.by_column.conservativeResize(Eigen::NoChange, next);
  return rows;
}

RecordingRows RowsOfRecordings::Of(int index) {
  const RolloutAt here = Rollout(&here_, problem_.recordings()[index], index);
  if (HasLanes(*here.problem)) return ByDifferences(here, index, {});
  RecordingRows rows = BySensitivities(here);
  return rows.residuals.size() == 0 ? rows : ByDifferences(here, index, std::move(rows));
}

}  // namespace pushid
