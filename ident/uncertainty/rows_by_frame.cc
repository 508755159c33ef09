// ident: differences of raw residuals, weighed as the cost weighs them.
#include "ident/uncertainty/rows_by_frame.h"

#include <algorithm>
#include <cmath>

#include "ident/problem/parallel.h"
#include "ident/uncertainty/fitted_columns.h"
#include "residuals/cost_functions/plate_residual.h"
#include "residuals/frame_residual.h"

namespace pushid {
namespace {

constexpr double kStep = 1e-5;  // of a column's unit

using RawResiduals = std::vector<std::vector<double>>;  // by recording

RawResiduals RawOf(const FitProblem& problem, const FitPoint& point) {
  RawResiduals raw;
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    const int recording = static_cast<int>(i);
    raw.push_back(problem.Count(recording) == 0 ? std::vector<double>()
                                                : problem.RawResiduals(point, recording));
  }
  return raw;
}

FitPoint Moved(const FitPoint& point, int column, double step) {
  std::vector<double> flat = point.Flat();
  flat[static_cast<size_t>(column)] += step;
  FitPoint moved = point;
  moved.SetFlat(flat);
  return moved;
}

RawResiduals RawUnder(const Assumption& assumption, const FitProblem& problem,
                      const FitPoint& point) {
  FitPoint moved = point;
  for (const auto& [index, shift] : assumption.along) moved.shared[index] += shift;
  ChangedProblem changed{problem.recordings(), problem.options()};
  changed.options.model.directions = Directions::kAxes;  // the problem's own are turned already
  assumption.change(assumption.step, &changed);
  return RawOf(FitProblem(changed.recordings, changed.options, problem.counts()), moved);
}

// Into a column; zeros where a changed rollout has another length.
void SetDifferences(const RawResiduals& here, const RawResiduals& there, double step,
                    Eigen::Ref<Eigen::VectorXd> column) {
  Eigen::Index row = 0;
  for (size_t i = 0; i < here.size(); ++i) {
    const bool comparable = there[i].size() == here[i].size();
    for (size_t k = 0; k < here[i].size(); ++k, ++row) {
      column[row] = comparable ? (there[i][k] - here[i][k]) / step : 0.0;
    }
  }
}

// With d(model - (1 + eta) measured) = d(model) - measured, the column holds the noise of what was
// measured, which the residual holds as well: their product is no longer zero on average. The same
// model, with d(model / (1 + eta) - measured) = d(model) - model: less by the residual.
void LeaveOutNoiseOfRates(const FitProblem& problem, const RawResiduals& here,
                          Eigen::Ref<Eigen::VectorXd> column) {
  Eigen::Index row = 0;
  for (size_t i = 0; i < here.size(); ++i) {
    const size_t motion = problem.NumMotionRows(static_cast<int>(i));
    for (size_t k = 0; k < here[i].size(); ++k, ++row) {
      const size_t channel = k % kFrameResiduals;
      const bool rate = channel == 3 || channel == 4 || channel >= 7;
      if (rate && k < motion) column[row] -= here[i][k];
    }
  }
}

// Raw rows, times how much of the frame was seen, become those of the cost: with c = sqrt(1 + |r|^2
// / d^2), residual and Jacobian times weight / sqrt(c); the loss's own Hessian has 1 / c of that
// along r (frame_residual.h).
template <int kRows>
void WeighFrame(const double* raw, double seen, double weight, double robust, Eigen::Index row,
                JacobianBlocks* rows) {
  const Eigen::Map<const Eigen::Matrix<double, kRows, 1>> r(raw);
  const double squared = r.squaredNorm();
  const double whole = seen > 0.0 ? squared / (seen * seen) : 0.0;  // as if all of it counted
  const double c = robust > 0.0 ? std::sqrt(1.0 + whole / (robust * robust)) : 1.0;
  auto jacobian = rows->jacobian.middleRows<kRows>(row);
  jacobian *= weight / std::sqrt(c);
  rows->residuals.segment<kRows>(row) = weight / std::sqrt(c) * r;
  auto own = rows->robust_jacobian.middleRows<kRows>(row);
  own = jacobian;
  if (squared > 0.0) own += (1.0 / c - 1.0) / squared * r * (r.transpose() * jacobian);
}

void WeighFrames(const FitProblem& problem, const RawResiduals& raw, RowsByFrame* result) {
  const double robust = problem.options().sigmas.OfFrames();
  Eigen::Index row = 0;
  for (size_t i = 0; i < raw.size(); ++i) {
    const PendulumRecording& recording = problem.recordings()[i];
    const int people = recording.num_people();
    const double weight = problem.Weight(static_cast<int>(i), 0);
    const auto belong = [&](int rows, int person, int frame) {
      row += rows;
      for (int k = 0; k < rows; ++k) {
        result->rows.cluster_of_row.push_back(static_cast<int>(i));
        result->rows.person_of_row.push_back(person);
        result->frame_of_row.push_back(frame);
      }
    };
    if (raw[i].empty()) continue;
    const int motion = static_cast<int>(problem.NumMotionRows(static_cast<int>(i)));
    for (int slot = 0; slot * kFrameResiduals < motion; ++slot) {
      const double seen = recording.Weight(slot % people, 1 + slot / people);
      WeighFrame<kFrameResiduals>(raw[i].data() + slot * kFrameResiduals, seen, weight, robust, row,
                                  &result->rows);
      belong(kFrameResiduals, slot % people, 1 + slot / people);
    }
    const double* of_plates = raw[i].data() + motion;
    for (int t = 0; t + 1 < recording.num_frames(); ++t) {
      for (int n = 0; n < people; ++n) {
        if (!recording.HasPlates(n)) continue;
        WeighFrame<kPlateResiduals>(of_plates, recording.plates[n][t].weight, weight, robust, row,
                                    &result->rows);
        of_plates += kPlateResiduals;
        belong(kPlateResiduals, n, t);
      }
    }
  }
}

// Rows that are no data.
void AddBeside(const JacobianBlocks& score, const std::vector<Assumption>& assumptions,
               Eigen::Index row, RowsByFrame* result) {
  JacobianBlocks& rows = result->rows;
  const auto next = [&](int cluster) {
    rows.cluster_of_row.push_back(cluster);
    rows.person_of_row.push_back(-1);
    result->frame_of_row.push_back(-1);
    return row++;
  };
  for (size_t i = 0; i < score.cluster_of_row.size(); ++i) {
    if (score.cluster_of_row[i] >= 0) continue;
    const Eigen::Index from = static_cast<Eigen::Index>(i), to = next(score.cluster_of_row[i]);
    rows.jacobian.row(to).head(score.jacobian.cols()) = score.jacobian.row(from);
    rows.residuals[to] = score.residuals[from];
  }
  for (size_t k = 0; k < assumptions.size(); ++k) {
    const Eigen::Index to = next(FitProblem::kPriorCluster);
    const double sigma = assumptions[k].sigma;
    rows.jacobian(to, score.jacobian.cols() + static_cast<Eigen::Index>(k)) =
        sigma > 0.0 ? 1.0 / sigma : 0.0;
  }
}

}  // namespace

RowsByFrame EvaluateByFrame(const FitProblem& problem, const FitPoint& point,
                            const std::vector<Assumption>& assumptions) {
  RowsByFrame result;
  const RawResiduals here = RawOf(problem, point);
  Eigen::Index data = 0;
  for (size_t i = 0; i < here.size(); ++i) {
    if (here[i].empty() && problem.Count(static_cast<int>(i)) > 0) return result;
    data += static_cast<Eigen::Index>(here[i].size());
  }
  FitPoint copy = point;
  const JacobianBlocks score = EvaluateJacobianBlocks(problem.Build(&copy, 0));
  const Eigen::Index estimates = score.jacobian.cols();
  const Eigen::Index columns = estimates + static_cast<Eigen::Index>(assumptions.size());
  const Eigen::Index beside =
      std::count_if(score.cluster_of_row.begin(), score.cluster_of_row.end(),
                    [](int cluster) { return cluster < 0; });
  const Eigen::Index size = data + beside + static_cast<Eigen::Index>(assumptions.size());
  result.num_estimates = static_cast<int>(estimates);
  JacobianBlocks& rows = result.rows;
  rows.clusters = score.clusters;
  rows.num_data_rows = static_cast<int>(data);
  rows.jacobian = Eigen::MatrixXd::Zero(size, columns);
  rows.robust_jacobian = Eigen::MatrixXd::Zero(size, columns);
  rows.residuals = Eigen::VectorXd::Zero(size);

  const Eigen::VectorXd unit = Units(FittedColumns(problem, point));
  ParallelFor(static_cast<int>(columns), problem.options().num_threads, [&](int column) {
    const bool of_estimate = column < estimates;
    const double step =
        of_estimate ? kStep * unit[column] : assumptions[column - result.num_estimates].step;
    if (step == 0.0) return;  // on a bound
    const RawResiduals there =
        of_estimate ? RawOf(problem, Moved(point, column, step))
                    : RawUnder(assumptions[column - result.num_estimates], problem, point);
    SetDifferences(here, there, step, rows.jacobian.col(column).head(data));
    if (!of_estimate && assumptions[column - result.num_estimates].of_rates) {
      LeaveOutNoiseOfRates(problem, here, rows.jacobian.col(column).head(data));
    }
  });
  // As if the estimates had stayed where they are.
  for (size_t k = 0; k < assumptions.size(); ++k) {
    for (const auto& [index, shift] : assumptions[k].along) {
      rows.jacobian.col(estimates + static_cast<Eigen::Index>(k)).head(data) -=
          shift / assumptions[k].step *
          rows.jacobian.col(static_cast<Eigen::Index>(index)).head(data);
    }
  }
  WeighFrames(problem, here, &result);
  AddBeside(score, assumptions, data, &result);
  return result;
}

}  // namespace pushid
