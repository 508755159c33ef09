// ident: differences of raw residuals, weighed as the cost weighs them, and condensed.
#include <algorithm>
#include <cmath>

#include "ident/problem/fit_problem.h"
#include "ident/problem/parallel.h"
#include "ident/problem/raw_residuals.h"
#include "ident/uncertainty/assumptions.h"
#include "ident/uncertainty/covariance.h"
#include "residuals/cost_functions/plate_residual.h"
#include "residuals/frame_residual.h"
#include "residuals/normal_equations.h"

namespace pushid {
namespace {

constexpr double kStep = 1e-5;  // of a column's unit

std::vector<bool> Counting(const FitProblem& problem) {
  std::vector<bool> counting;
  for (size_t i = 0; i < problem.recordings().size(); ++i) {
    counting.push_back(problem.Count(static_cast<int>(i)) > 0);
  }
  return counting;
}

FitPoint Moved(const FitPoint& point, int column, double step) {
  std::vector<double> flat = point.Flat();
  flat[static_cast<size_t>(column)] += step;
  FitPoint moved = point;
  moved.SetFlat(flat);
  return moved;
}

ResidualsByRecording RawUnder(const Assumption& assumption, const FitProblem& problem,
                              const FitPoint& point) {
  FitPoint moved = point;
  for (const auto& [index, shift] : assumption.along) moved.shared[index] += shift;
  ChangedProblem changed{problem.recordings(), problem.options()};
  changed.options.model.directions = Directions::kAxes;  // the problem's own are turned already
  assumption.change(assumption.step, &changed);
  const FitProblem there(changed.recordings, changed.options, problem.counts());
  return RawResiduals(there, moved, Counting(there));
}

// With d(model - (1 + eta) measured) = d(model) - measured, the column holds the noise of what was
// measured, which the residual holds as well: their product is no longer zero on average. The same
// model, with d(model / (1 + eta) - measured) = d(model) - model: less by the residual.
void LeaveOutNoiseOfRates(const std::vector<double>& here, size_t motion,
                          Eigen::Ref<Eigen::VectorXd> column) {
  for (size_t k = 0; k < motion; ++k) {
    const size_t channel = k % kFrameResiduals;
    const bool rate = channel == 3 || channel == 4 || channel >= 7;
    if (rate) column[static_cast<Eigen::Index>(k)] -= here[k];
  }
}

// Differences of one recording by the columns that move it.
struct ColumnDifferences {
  std::vector<Eigen::Index> columns;
  Eigen::MatrixXd by_column;

  Eigen::Index Find(Eigen::Index column) const {
    return std::find(columns.begin(), columns.end(), column) - columns.begin();
  }
};

// All columns beside the residuals here: there[column], step[column].
struct Probes {
  ResidualsByRecording here;
  std::vector<ResidualsByRecording> there;
  std::vector<double> step;
};

// A column whose changed rollout has another length, or which does not reach the recording, is left
// out.
ColumnDifferences DifferencesOf(const FitProblem& problem, const Probes& probes,
                                const std::vector<Assumption>& assumptions, int recording) {
  const std::vector<double>& here = probes.here[recording];
  const Eigen::Index estimates =
      static_cast<Eigen::Index>(probes.there.size() - assumptions.size());
  ColumnDifferences d;
  for (size_t c = 0; c < probes.there.size(); ++c) {
    const bool moves = !probes.there[c].empty() && probes.there[c][recording].size() == here.size();
    if (moves) d.columns.push_back(static_cast<Eigen::Index>(c));
  }
  d.by_column.resize(static_cast<Eigen::Index>(here.size()),
                     static_cast<Eigen::Index>(d.columns.size()));
  const Eigen::Map<const Eigen::VectorXd> from(here.data(), d.by_column.rows());
  for (Eigen::Index j = 0; j < d.by_column.cols(); ++j) {
    const size_t c = static_cast<size_t>(d.columns[j]);
    const Eigen::Map<const Eigen::VectorXd> to(probes.there[c][recording].data(), from.size());
    d.by_column.col(j) = (to - from) / probes.step[c];
    if (d.columns[j] < estimates) continue;
    const Assumption& assumption = assumptions[d.columns[j] - estimates];
    if (assumption.of_rates) {
      LeaveOutNoiseOfRates(here, problem.NumMotionRows(recording), d.by_column.col(j));
    }
    // As if the estimates had stayed where they are.
    for (const auto& [index, shift] : assumption.along) {
      const Eigen::Index of_estimate = d.Find(static_cast<Eigen::Index>(index));
      if (of_estimate == d.by_column.cols()) continue;
      d.by_column.col(j) -= shift / assumption.step * d.by_column.col(of_estimate);
    }
  }
  return d;
}

// The rows of one person in one part, and those with the loss's own Hessian.
struct Condensed {
  NormalEquations plain, robust;
};

// Raw rows, times how much of the frame was seen, become those of the cost: with c = sqrt(1 + |r|^2
// / d^2), residual and Jacobian times weight / sqrt(c); the loss's own Hessian has 1 / c of that
// along r (frame_residual.h).
void AddFrame(const Eigen::Ref<const Eigen::VectorXd>& r,
              const Eigen::Ref<const Eigen::MatrixXd>& by_column, double seen, double weight,
              double robust, Condensed* to) {
  const double squared = r.squaredNorm();
  const double whole = seen > 0.0 ? squared / (seen * seen) : 0.0;  // as if all of it counted
  const double c = robust > 0.0 ? std::sqrt(1.0 + whole / (robust * robust)) : 1.0;
  const int columns = static_cast<int>(by_column.cols()), count = static_cast<int>(r.size());
  RowMajorMatrix rows = RowMajorMatrix::Zero(count, NormalEquations::PaddedSize(columns));
  const double scale = weight / std::sqrt(c);
  rows.leftCols(columns) = scale * by_column;
  rows.col(columns) = scale * r;
  to->plain.Add(count, rows.data());
  if (squared > 0.0) {
    const Eigen::RowVectorXd along = r.transpose() * rows.leftCols(columns);
    rows.leftCols(columns) += (1.0 / c - 1.0) / squared * r * along;
  }
  to->robust.Add(count, rows.data());
}

// By person and part of one recording, people within a part.
std::vector<Condensed> Condense(const FitProblem& problem, const std::vector<double>& raw,
                                const ColumnDifferences& differences,
                                const std::vector<int>& horizons, int recording) {
  const PendulumRecording& r = problem.recordings()[recording];
  const int people = r.num_people(), begin = PushFrame(r);
  const int columns = static_cast<int>(differences.columns.size());
  const double weight = problem.Weight(recording, 0);
  const double robust = problem.options().sigmas.OfFrames();
  std::vector<Condensed> parts((horizons.size() + 1) * people,
                               {NormalEquations(columns), NormalEquations(columns)});
  const Eigen::Map<const Eigen::VectorXd> residuals(raw.data(),
                                                    static_cast<Eigen::Index>(raw.size()));
  Eigen::Index row = 0;
  const auto add = [&](int rows, int person, int frame, double seen) {
    const auto part =
        std::lower_bound(horizons.begin(), horizons.end(), frame - begin) - horizons.begin();
    AddFrame(residuals.segment(row, rows), differences.by_column.middleRows(row, rows), seen,
             weight, robust, &parts[part * people + person]);
    row += rows;
  };
  for (int t = 1; t < r.num_frames(); ++t) {
    for (int n = 0; n < people; ++n) add(kFrameResiduals, n, t, r.Weight(n, t));
  }
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    for (int n = 0; n < people; ++n) {
      if (r.HasPlates(n)) add(kPlateResiduals, n, t, r.plates[n][t].weight);
    }
  }
  return parts;
}

class RowStack {
 public:
  RowStack(Eigen::Index rows, Eigen::Index columns, RowsByHorizon* result) : result_(*result) {
    JacobianBlocks& all = result->rows;
    all.jacobian = all.robust_jacobian = Eigen::MatrixXd::Zero(rows, columns);
    all.residuals = Eigen::VectorXd::Zero(rows);
  }

  Eigen::Index Next(int cluster, int person, int part) {
    result_.rows.cluster_of_row.push_back(cluster);
    result_.rows.person_of_row.push_back(person);
    result_.part_of_row.push_back(part);
    return next_++;
  }

  void Add(const std::vector<Condensed>& parts, const std::vector<Eigen::Index>& columns,
           int recording, int people) {
    const Eigen::Index count = static_cast<Eigen::Index>(columns.size());
    for (size_t p = 0; p < parts.size(); ++p) {
      const RowMajorMatrix plain = parts[p].plain.Factor(), robust = parts[p].robust.Factor();
      for (Eigen::Index k = 0; k <= count; ++k) {
        const int person = static_cast<int>(p) % people, part = static_cast<int>(p) / people;
        const Eigen::Index row = Next(recording, person, part);
        result_.rows.residuals[row] = plain(k, count);
        for (Eigen::Index j = 0; j < count; ++j) {
          result_.rows.jacobian(row, columns[j]) = plain(k, j);
          result_.rows.robust_jacobian(row, columns[j]) = robust(k, j);
        }
      }
    }
  }

 private:
  RowsByHorizon& result_;
  Eigen::Index next_ = 0;
};

// Rows that are no data.
void AddBeside(const JacobianBlocks& score, const std::vector<Assumption>& assumptions,
               RowStack* stack, JacobianBlocks* rows) {
  for (size_t i = 0; i < score.cluster_of_row.size(); ++i) {
    if (score.cluster_of_row[i] >= 0) continue;
    const Eigen::Index from = static_cast<Eigen::Index>(i);
    const Eigen::Index to = stack->Next(score.cluster_of_row[i], -1, -1);
    rows->jacobian.row(to).head(score.jacobian.cols()) = score.jacobian.row(from);
    rows->residuals[to] = score.residuals[from];
  }
  for (size_t k = 0; k < assumptions.size(); ++k) {
    const Eigen::Index to = stack->Next(FitProblem::kPriorCluster, -1, -1);
    const double sigma = assumptions[k].sigma;
    rows->jacobian(to, score.jacobian.cols() + static_cast<Eigen::Index>(k)) =
        sigma > 0.0 ? 1.0 / sigma : 0.0;
  }
}

// The recordings whose residuals a column of estimates moves.
std::vector<bool> MovedBy(const JacobianBlocks& score, Eigen::Index column, size_t recordings) {
  std::vector<bool> moved(recordings, false);
  for (size_t row = 0; row < score.cluster_of_row.size(); ++row) {
    const int recording = score.cluster_of_row[row];
    if (recording < 0 || score.jacobian(static_cast<Eigen::Index>(row), column) == 0.0) continue;
    moved[recording] = true;
  }
  return moved;
}

Probes Probe(const FitProblem& problem, const FitPoint& point,
             const std::vector<Assumption>& assumptions, const JacobianBlocks& score,
             ResidualsByRecording here) {
  const size_t recordings = problem.recordings().size();
  const int estimates = static_cast<int>(score.jacobian.cols());
  const int columns = estimates + static_cast<int>(assumptions.size());
  const Eigen::VectorXd unit = Units(FittedColumns(problem, point));
  Probes probes{std::move(here), std::vector<ResidualsByRecording>(columns),
                std::vector<double>(columns)};
  ParallelFor(columns, problem.options().num_threads, [&](int c) {
    const bool of_estimate = c < estimates;
    const double step = probes.step[c] =
        of_estimate ? kStep * unit[c] : assumptions[c - estimates].step;
    if (step == 0.0) return;  // on a bound
    probes.there[c] =
        of_estimate ? RawResiduals(problem, Moved(point, c, step), MovedBy(score, c, recordings))
                    : RawUnder(assumptions[c - estimates], problem, point);
  });
  return probes;
}

}  // namespace

RowsByHorizon EvaluateByHorizon(const FitProblem& problem, const FitPoint& point,
                                const std::vector<Assumption>& assumptions,
                                const std::vector<int>& horizons) {
  RowsByHorizon result;
  const int recordings = static_cast<int>(problem.recordings().size());
  ResidualsByRecording here = RawResiduals(problem, point, Counting(problem));
  for (int i = 0; i < recordings; ++i) {
    if (here[i].empty() && problem.Count(i) > 0) return result;
    result.rows.num_data_rows += static_cast<int>(here[i].size());
  }
  FitPoint copy = point;
  const JacobianBlocks score = EvaluateJacobianBlocks(problem.Build(&copy, 0));
  result.num_estimates = static_cast<int>(score.jacobian.cols());
  result.rows.clusters = score.clusters;
  const Probes probes = Probe(problem, point, assumptions, score, std::move(here));

  std::vector<std::vector<Condensed>> parts(recordings);
  std::vector<std::vector<Eigen::Index>> columns(recordings);
  ParallelFor(recordings, problem.options().num_threads, [&](int i) {
    if (probes.here[i].empty()) return;
    const ColumnDifferences differences = DifferencesOf(problem, probes, assumptions, i);
    parts[i] = Condense(problem, probes.here[i], differences, horizons, i);
    columns[i] = differences.columns;
  });
  Eigen::Index size = static_cast<Eigen::Index>(assumptions.size()) +
                      std::count_if(score.cluster_of_row.begin(), score.cluster_of_row.end(),
                                    [](int cluster) { return cluster < 0; });
  for (int i = 0; i < recordings; ++i) {
    size += static_cast<Eigen::Index>(parts[i].size() * (columns[i].size() + 1));
  }
  RowStack stack(size, static_cast<Eigen::Index>(probes.there.size()), &result);
  for (int i = 0; i < recordings; ++i) {
    stack.Add(parts[i], columns[i], i, problem.recordings()[i].num_people());
  }
  AddBeside(score, assumptions, &stack, &result.rows);
  return result;
}

}  // namespace pushid
