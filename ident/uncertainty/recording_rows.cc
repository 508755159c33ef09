// ident: sensitivities and differences of raw residuals, and their sums by recording, person and
// horizon.
#include "ident/uncertainty/recording_rows.h"

#include <algorithm>
#include <cmath>
#include <list>

#include "ident/problem/parallel.h"
#include "ident/uncertainty/covariance.h"
#include "residuals/cost_functions/lane_tables.h"
#include "residuals/cost_functions/plate_residual.h"
#include "residuals/normal_equations.h"

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

namespace {

using Eigen::Index;

// Of one person.
struct PersonSums {
  NormalEquations plain, robust;  // robust: with the loss's own Hessian
  std::vector<NormalEquations> robust_parts;
  std::vector<Eigen::VectorXd> scores;  // J'r, by part
};

class Condenser {
 public:
  Condenser(const FitProblem& problem, const RecordingRows& rows, size_t num_parts, int recording)
      : columns_(static_cast<int>(rows.columns.size())),
        weight_(problem.Weight(recording, 0)),
        loss_(problem.options().sigmas.OfFrames()),
        rows_(rows),
        frame_(RowMajorMatrix::Zero(kFrameResiduals, NormalEquations::PaddedSize(columns_))) {
    const NormalEquations none(columns_);
    people_.resize(static_cast<size_t>(problem.recordings()[recording].num_people()),
                   {none, none, std::vector(num_parts, none),
                    std::vector<Eigen::VectorXd>(num_parts, Eigen::VectorXd::Zero(columns_))});
  }

  // The next rows, times how much of the frame was seen, become those of the cost: with c = sqrt(1
  // + |r|^2 / d^2), residual and Jacobian times weight / sqrt(c); the loss's own Hessian has 1 / c
  // of that along r (frame_residual.h).
  void AddFrame(Index count, double seen, size_t part, PersonSums* to) {
    const auto r = rows_.residuals.segment(next_, count);
    const double squared = r.squaredNorm();
    const double whole = seen > 0.0 ? squared / (seen * seen) : 0.0;  // as if all of it counted
    const double c = loss_ > 0.0 ? std::sqrt(1.0 + whole / (loss_ * loss_)) : 1.0;
    const double scale = weight_ / std::sqrt(c);
    auto by_column = frame_.topLeftCorner(count, columns_);
    by_column = scale * rows_.by_column.middleRows(next_, count);
    residuals_ = scale * r;
    to->plain.Add(static_cast<int>(count), frame_.data(), residuals_.data());
    if (squared > 0.0) {
      along_.noalias() = r.transpose() * by_column;
      to->scores[part] += scale * along_.transpose();
      along_ *= (1.0 / c - 1.0) / squared;
      for (Index i = 0; i < count; ++i) by_column.row(i) += r[i] * along_;
    }
    to->robust_parts[part].Add(static_cast<int>(count), frame_.data(), residuals_.data());
    next_ += count;
  }

  std::vector<PersonSums>& people() { return people_; }

 private:
  int columns_;
  double weight_, loss_;
  const RecordingRows& rows_;
  Index next_ = 0;
  RowMajorMatrix frame_;  // J, padded
  Eigen::VectorXd residuals_;
  Eigen::RowVectorXd along_;
  std::vector<PersonSums> people_;
};

std::vector<PersonSums> Condense(const FitProblem& problem, const RecordingRows& rows,
                                 const std::vector<int>& horizons, int recording) {
  const PendulumRecording& r = problem.recordings()[recording];
  Condenser condenser(problem, rows, horizons.size() + 1, recording);
  std::vector<PersonSums>& people = condenser.people();
  const int begin = PushFrame(r);
  const auto part_of = [&](int frame) {
    return static_cast<size_t>(std::lower_bound(horizons.begin(), horizons.end(), frame - begin) -
                               horizons.begin());
  };
  for (int t = 1; t < r.num_frames(); ++t) {
    for (int n = 0; n < r.num_people(); ++n) {
      condenser.AddFrame(kFrameResiduals, r.Weight(n, t), part_of(t), &people[n]);
    }
  }
  for (int t = 0; t + 1 < r.num_frames(); ++t) {
    for (int n = 0; n < r.num_people(); ++n) {
      if (!r.HasPlates(n)) continue;
      condenser.AddFrame(kPlateResiduals, r.plates[n][t].weight, part_of(t), &people[n]);
    }
  }
  for (PersonSums& person : people) {
    for (const NormalEquations& part : person.robust_parts) person.robust.Add(part);
  }
  return std::move(people);
}

// The rows of one recording, condensed to one triangle a person.
struct CondensedRecording {
  std::vector<Index> columns;
  std::vector<PersonSums> people;
  int num_rows = 0;  // before they were condensed
};

// Stacks the rows of all recordings, then those of priors and demands.
class RowStack {
 public:
  RowStack(Index rows, Index columns, RowsByHorizon* result) : result_(*result) {
    JacobianBlocks& all = result->rows;
    all.jacobian = all.robust_jacobian = Eigen::MatrixXd::Zero(rows, columns);
    all.residuals = Eigen::VectorXd::Zero(rows);
  }

  void Add(const CondensedRecording& condensed, int recording) {
    const Index count = static_cast<Index>(condensed.columns.size());
    for (int n = 0; n < static_cast<int>(condensed.people.size()); ++n) {
      const PersonSums& person = condensed.people[n];
      const RowMajorMatrix plain = person.plain.Factor(), robust = person.robust.Factor();
      for (Index k = 0; k <= count; ++k) {
        const Index row = Next(recording, n);
        result_.rows.residuals[row] = plain(k, count);
        for (Index j = 0; j < count; ++j) {
          result_.rows.jacobian(row, condensed.columns[j]) = plain(k, j);
          result_.rows.robust_jacobian(row, condensed.columns[j]) = robust(k, j);
        }
      }
      for (size_t part = 0; part < person.scores.size(); ++part) {
        AddPart(condensed, person, {recording, n, static_cast<int>(part), {}, {}});
      }
    }
  }

  void AddBeside(const JacobianBlocks& beside, const std::vector<Assumption>& assumptions) {
    const Index estimates = result_.num_estimates;
    for (size_t i = 0; i < beside.cluster_of_row.size(); ++i) {
      const Index from = static_cast<Index>(i), to = Next(beside.cluster_of_row[i], -1);
      result_.rows.jacobian.row(to).head(estimates) = beside.jacobian.row(from);
      result_.rows.residuals[to] = beside.residuals[from];
    }
    for (size_t k = 0; k < assumptions.size(); ++k) {
      const Index to = Next(FitProblem::kPriorCluster, -1);
      const double sigma = assumptions[k].sigma;
      result_.rows.jacobian(to, estimates + static_cast<Index>(k)) =
          sigma > 0.0 ? 1.0 / sigma : 0.0;
    }
  }

 private:
  Index Next(int cluster, int person) {
    result_.rows.cluster_of_row.push_back(cluster);
    result_.rows.person_of_row.push_back(person);
    return next_++;
  }

  void AddPart(const CondensedRecording& condensed, const PersonSums& person, DataPart part) {
    const Index estimates = result_.num_estimates;
    const auto beyond =
        std::lower_bound(condensed.columns.begin(), condensed.columns.end(), estimates);
    const std::vector<Index> own(condensed.columns.begin(), beyond);
    const Index count = static_cast<Index>(own.size());
    const RowMajorMatrix gram =
        person.robust_parts[part.part].information().topLeftCorner(count, count);
    part.score = Eigen::VectorXd::Zero(estimates);
    part.score(own) = person.scores[part.part].head(count);
    part.information = Eigen::MatrixXd::Zero(estimates, estimates);
    part.information(own, own) = Eigen::MatrixXd(gram.selfadjointView<Eigen::Upper>());
    result_.parts.push_back(std::move(part));
  }

  RowsByHorizon& result_;
  Index next_ = 0;
};

// Priors, demands and pooling.
JacobianBlocks RowsBeside(const FitProblem& problem, FitPoint point) {
  return EvaluateJacobianBlocks(problem.WithoutRecordings().Build(&point, 0));
}

}  // namespace

RowsByHorizon EvaluateByHorizon(const FitProblem& problem, const FitPoint& point,
                                const std::vector<Assumption>& assumptions,
                                const std::vector<int>& horizons) {
  const int recordings = static_cast<int>(problem.recordings().size());
  RowsOfRecordings of(problem, point, assumptions);
  std::vector<CondensedRecording> condensed(recordings);
  ParallelFor(recordings, problem.options().num_threads, [&](int i) {
    if (problem.Count(i) == 0) return;
    RecordingRows rows = of.Of(i);
    condensed[i].num_rows = static_cast<int>(rows.residuals.size());
    if (condensed[i].num_rows == 0) return;
    condensed[i].people = Condense(problem, rows, horizons, i);
    condensed[i].columns = std::move(rows.columns);
  });
  RowsByHorizon result;
  for (int i = 0; i < recordings; ++i) {
    if (problem.Count(i) > 0 && condensed[i].num_rows == 0) return result;
  }
  const JacobianBlocks beside = RowsBeside(problem, point);
  result.num_estimates = static_cast<int>(of.num_estimates());
  Index size = beside.jacobian.rows() + static_cast<Index>(assumptions.size());
  for (const CondensedRecording& one : condensed) {
    size += static_cast<Index>(one.people.size() * (one.columns.size() + 1));
  }
  RowStack stack(size, of.num_estimates() + static_cast<Index>(assumptions.size()), &result);
  for (int i = 0; i < recordings; ++i) {
    if (condensed[i].num_rows == 0) continue;
    result.rows.clusters.push_back(i);
    result.rows.num_data_rows += condensed[i].num_rows;
    stack.Add(condensed[i], i);
  }
  stack.AddBeside(beside, assumptions);
  return result;
}

}  // namespace pushid
