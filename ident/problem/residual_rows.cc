// ident: rows of built problems, and rows by differences of rollouts.
#include "ident/problem/residual_rows.h"

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <set>

#include "ident/problem/parallel.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/cost_functions/likelihood_residual.h"
#include "residuals/jets/autodiff_rollout.h"
#include "residuals/normal_equations.h"
#include "residuals/plate_residual.h"

namespace pushid {
namespace {

using Eigen::Index;

// Rows of one cost function by the columns that move it.
struct RowBlock {
  int cluster;
  std::vector<Index> columns;  // of the whole Jacobian, one for each of these rows
  std::vector<PersonRows> people;
  std::vector<int> person_of_row;
  int num_rows = 0;  // before they were condensed

  bool is_data() const { return cluster >= 0; }
};

ResidualRows Stack(const std::vector<RowBlock>& blocks, Index columns, bool robust) {
  ResidualRows rows;
  std::set<int> present;
  for (const RowBlock& block : blocks) {
    rows.cluster_of_row.insert(rows.cluster_of_row.end(), block.person_of_row.size(),
                               block.cluster);
    rows.person_of_row.insert(rows.person_of_row.end(), block.person_of_row.begin(),
                              block.person_of_row.end());
    if (!block.is_data()) continue;
    present.insert(block.cluster);
    rows.num_data_rows += block.num_rows;
  }
  const Index size = static_cast<Index>(rows.cluster_of_row.size());
  rows.residuals.resize(size);
  rows.jacobian.setZero(size, columns);
  if (robust) rows.robust_jacobian.setZero(size, columns);
  Index row = 0;
  for (const RowBlock& block : blocks) {
    for (const PersonRows& person : block.people) {
      const auto own = Eigen::seqN(row, person.residuals.size());
      rows.residuals(own) = person.residuals;
      rows.jacobian(own, block.columns) = person.jacobian;
      if (robust && block.is_data()) {
        rows.robust_jacobian(own, block.columns) = person.robust_jacobian;
      }
      row += person.residuals.size();
    }
  }
  rows.clusters.assign(present.begin(), present.end());
  return rows;
}

// The cost function's own rows.
bool EvaluateOwnRows(const ceres::CostFunction& cost, const std::vector<const double*>& at,
                     PersonRows* rows) {
  const int n = cost.num_residuals();
  std::vector<RowMajorMatrix> by_block;
  std::vector<double*> pointers;
  Index columns = 0;
  for (int size : cost.parameter_block_sizes()) {
    by_block.emplace_back(n, size);
    columns += size;
  }
  for (RowMajorMatrix& jacobian : by_block) pointers.push_back(jacobian.data());
  rows->residuals.resize(n);
  if (!cost.Evaluate(at.data(), rows->residuals.data(), pointers.data())) return false;
  rows->jacobian.resize(n, columns);
  Index column = 0;
  for (const RowMajorMatrix& jacobian : by_block) {
    rows->jacobian.middleCols(column, jacobian.cols()) = jacobian;
    column += jacobian.cols();
  }
  rows->robust_jacobian = rows->jacobian;  // other cost functions have no robust loss
  return true;
}

std::vector<RowBlock> RowBlocksOf(const BuiltProblem& built, bool robust) {
  ++EvaluationCount::Get().jacobians;
  std::map<const double*, Index> first_column;
  Index next = 0;
  for (double* block : built.parameter_blocks) {
    first_column[block] = next;
    next += built.problem->ParameterBlockSize(block);
  }
  const auto sums = SumUp(*built.side_by_side, built.rollouts,
                          robust ? LaneSums::kRobust : LaneSums::kPlain, true);
  std::vector<RowBlock> blocks;
  for (const BuiltProblem::Block& from : built.blocks) {
    std::vector<double*> on;
    built.problem->GetParameterBlocksForResidualBlock(from.id, &on);
    const std::vector<const double*> at(on.begin(), on.end());
    const auto* rollout = dynamic_cast<const CondensedRollout*>(from.cost);
    const auto* steps = dynamic_cast<const LikelihoodResidual*>(from.cost);
    RowBlock block{from.cluster, {}, std::vector<PersonRows>(1), {}};
    if (rollout != nullptr) {
      block.people = rollout->RowsOf(sums[from.cluster]);
      block.num_rows = rollout->problem().num_residuals();
    } else {
      if (!EvaluateOwnRows(*from.cost, at, &block.people[0])) continue;
      block.num_rows = from.cost->num_residuals();
    }
    if (block.people.empty()) continue;
    for (size_t n = 0; n < block.people.size(); ++n) {
      for (Index row = 0; row < block.people[n].residuals.size(); ++row) {
        block.person_of_row.push_back(rollout != nullptr ? static_cast<int>(n)
                                      : steps != nullptr ? steps->PersonOfRow(row)
                                                         : -1);
      }
    }
    for (double* parameters : on) {
      const Index first = first_column.at(parameters);
      for (Index c = 0; c < built.problem->ParameterBlockSize(parameters); ++c) {
        block.columns.push_back(first + c);
      }
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace

Eigen::MatrixXd ResidualRows::Information(const std::vector<int>& rows) const {
  const Eigen::MatrixXd own = jacobian(rows, Eigen::all);
  return own.transpose() * own;
}

Eigen::VectorXd ResidualRows::Gradient(const std::vector<int>& rows) const {
  return jacobian(rows, Eigen::all).transpose() * residuals(rows);
}

ResidualRows EvaluateRows(const BuiltProblem& built, bool robust) {
  Index columns = 0;
  for (double* block : built.parameter_blocks) columns += built.problem->ParameterBlockSize(block);
  return Stack(RowBlocksOf(built, robust), columns, robust);
}

ResidualRows EvaluateRows(const FitProblem& problem, FitPoint point, bool robust) {
  return EvaluateRows(problem.Build(&point, 0), robust);
}

void AddCurvature(const BuiltProblem& built, const Eigen::VectorXd& steps, bool both_sides,
                  ResidualRows* rows) {
  ceres::Problem::EvaluateOptions by_all;
  by_all.parameter_blocks = built.parameter_blocks;
  const Index size = rows->jacobian.cols();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  Index column = 0;
  std::vector<double> above(size), below(size);  // without the other side: at the point
  Eigen::VectorXd::Map(below.data(), size) = rows->jacobian.transpose() * rows->residuals;
  for (double* block : built.parameter_blocks) {
    for (int k = 0; k < built.problem->ParameterBlockSize(block); ++k, ++column) {
      const double step = steps[column], value = block[k];
      if (step == 0.0) continue;
      block[k] = value + step;
      bool told = built.problem->Evaluate(by_all, nullptr, nullptr, &above, nullptr);
      block[k] = value - step;
      if (both_sides) told &= built.problem->Evaluate(by_all, nullptr, nullptr, &below, nullptr);
      block[k] = value;
      if (!told) return;
      for (Index row = 0; row < size; ++row) {
        hessian(row, column) = (above[row] - below[row]) / (both_sides ? 2.0 * step : step);
      }
    }
  }
  rows->curvature =
      0.5 * (hessian + hessian.transpose()) - rows->jacobian.transpose() * rows->jacobian;
  for (Index i = 0; i < size; ++i) {
    if (steps[i] != 0.0) continue;
    rows->curvature.row(i).setZero();
    rows->curvature.col(i).setZero();
  }
}

namespace {

constexpr double kStep = 1e-5;  // of a column's unit

// Raw residuals by rollout: empty if it leaves the domain, or has no problem.
ResidualsByRecording ResidualsOf(const std::vector<RolloutAt>& rollouts) {
  auto sums = SumUp(PutSideBySide(rollouts), rollouts, LaneSums::kNone);
  ResidualsByRecording raw(rollouts.size());
  for (size_t i = 0; i < rollouts.size(); ++i) {
    if (!sums[i].empty() && sums[i][0].ok) raw[i] = std::move(sums[i][0].residuals);
  }
  return raw;
}

Eigen::Map<const Eigen::VectorXd> Mapped(const std::vector<double>& values) {
  return {values.data(), static_cast<Index>(values.size())};
}

bool IsRate(Index row) {
  const Index channel = row % kFrameResiduals;
  return channel == 3 || channel == 4 || channel >= 7;
}

// Raw residuals of whole steps, from those of two halves of each. Rates are between frames, the
// means of both; the rest of motion is at the end of the second half, and platforms measure at the
// start of the first.
std::vector<double> OfWholeSteps(const std::vector<double>& halves, Index motion, Index steps) {
  using Halves = Eigen::Map<const Eigen::MatrixXd>;  // a column each
  if (halves.empty()) return {};
  std::vector<double> whole(halves.size() / 2);
  const Index plates = static_cast<Index>(whole.size()) - motion;
  const Halves moved(halves.data(), motion / steps, 2 * steps);
  const Halves pressed(halves.data() + 2 * motion, plates / steps, 2 * steps);
  Eigen::Map<Eigen::MatrixXd> of_motion(whole.data(), motion / steps, steps);
  of_motion = moved(Eigen::all, Eigen::seqN(1, steps, 2));
  for (Index row = 0; row < of_motion.rows(); ++row) {
    if (!IsRate(row)) continue;
    of_motion.row(row) += moved(row, Eigen::seqN(0, steps, 2));
    of_motion.row(row) *= 0.5;
  }
  Eigen::Map<Eigen::MatrixXd>(whole.data() + motion, plates / steps, steps) =
      pressed(Eigen::all, Eigen::seqN(0, steps, 2));
  return whole;
}

// Raw residuals of a recording, and their derivatives.
struct RawRows {
  Eigen::VectorXd residuals;   // empty: the rollout fails
  std::vector<Index> columns;  // those that move the recording: estimates, then assumptions
  Eigen::MatrixXd by_column;
};

// A problem as a point, its model and its parameters have it.
struct Seen {
  ModelOptions model;
  ParameterMap map;
  FitPoint point;
};

// A recording's rollout without the robust loss, and as it weighs by itself.
RolloutAt RawRollout(const FitProblem& problem, const PendulumRecording& recording, int index,
                     Seen* seen) {
  ResidualSigmas sigmas = problem.options().sigmas;
  sigmas.robust = 0.0;
  return {MakeRolloutProblem(recording, seen->model, seen->map, sigmas, 1.0, 0),
          problem.RecordingBlocks(&seen->point, index)};
}

class RowsOfRecordings {
 public:
  // The arguments must outlive it.
  RowsOfRecordings(const FitProblem& problem, const FitPoint& point,
                   const std::vector<Assumption>& assumptions)
      : problem_(problem),
        here_{problem.options().model, problem.map(), point},
        unit_(Units(FittedColumns(problem, point))) {
    Index next = 0;
    FitPoint::ForBlocks(here_.point, [this, &next](const std::vector<double>& block) {
      first_[block.data()] = next;
      next += static_cast<Index>(block.size());
    });
    const std::vector<double> flat = point.Flat();
    for (size_t c = 0; c < flat.size(); ++c) {
      std::vector<double> moved = flat;
      columns_.push_back({here_, kStep * unit_[static_cast<Index>(c)], nullptr});
      moved[c] += columns_.back().step;
      columns_.back().seen.point.SetFlat(moved);
    }
    for (const Assumption& assumption : assumptions) {
      columns_.push_back({here_, assumption.step, &assumption});
      Seen& seen = columns_.back().seen;
      for (const auto& [index, shift] : assumption.along) seen.point.shared[index] += shift;
      if (assumption.of_options == nullptr) continue;
      FitOptions options = problem.options();
      assumption.of_options(assumption.step, &options);
      seen.model = options.model;
      seen.map.values = options.table.Values();
    }
  }

  Index num_estimates() const { return unit_.size(); }

  // From any thread.
  RawRows Of(int index) {
    const RolloutAt here = RawRollout(problem_, problem_.recordings()[index], index, &here_);
    RawRows rows;
    if (!HasLanes(*here.problem)) {
      rows = BySensitivities(here);
      if (rows.residuals.size() == 0) return rows;
    }
    AddDifferences(here, index, &rows);
    return rows;
  }

 private:
  // One step along it. assumption: null for an estimate.
  struct Column {
    Seen seen;
    double step;
    const Assumption* assumption;
  };

  // Columns of the fit, each with its place among those of the recording's blocks; none on bounds.
  std::vector<std::pair<Index, Index>> OwnColumns(const RolloutAt& here) const {
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

  RawRows BySensitivities(const RolloutAt& here) const {
    const RolloutProblem& problem = *here.problem;
    RawRows rows;
    std::vector<double> residuals;
    RowMajorMatrix by_acting;
    const SensitivityInputs inputs =
        RolloutInputs(problem.recording->scene, problem.map, problem.layout, here.blocks.data());
    if (!RowsByJets(problem, inputs, &residuals, &by_acting).ok) return {};
    rows.residuals = Mapped(residuals);
    const RowMajorMatrix by_blocks = ActingColumns(problem.layout).Expand(by_acting);
    std::vector<Index> in_blocks;
    for (const auto& [column, in_block] : OwnColumns(here)) {
      rows.columns.push_back(column);
      in_blocks.push_back(in_block);
    }
    rows.by_column = by_blocks(Eigen::all, in_blocks);
    return rows;
  }

  // Columns that *rows does not hold yet. One whose changed rollout fails is left out.
  void AddDifferences(const RolloutAt& here, int index, RawRows* rows) {
    const bool none = rows->residuals.size() == 0;
    std::vector<RolloutAt> rollouts;
    std::vector<Index> columns;
    if (none) {
      rollouts.push_back(here);
      for (const auto& [column, in_blocks] : OwnColumns(here)) columns.push_back(column);
    }
    for (Index c = num_estimates(); c < static_cast<Index>(columns_.size()); ++c) {
      columns.push_back(c);
    }
    std::list<PendulumRecording> changed;
    for (Index c : columns) {
      const PendulumRecording* seen = &problem_.recordings()[index];
      const Assumption* const assumption = columns_[c].assumption;
      if (assumption != nullptr && assumption->of_recording != nullptr) {
        assumption->of_recording(assumption->step, &changed.emplace_back(*seen));
        seen = &changed.back();
      }
      rollouts.push_back(RawRollout(problem_, *seen, index, &columns_[c].seen));
    }
    ResidualsByRecording there = ResidualsOf(rollouts);
    if (none) {
      rows->residuals = Mapped(there[0]);
      there.erase(there.begin());
      if (rows->residuals.size() == 0) return;
    }
    Index next = rows->by_column.cols();
    rows->by_column.conservativeResize(rows->residuals.size(),
                                       next + static_cast<Index>(there.size()));
    for (size_t j = 0; j < there.size(); ++j) {
      const Column& column = columns_[columns[j]];
      if (column.assumption != nullptr && column.assumption->halves_steps) {
        there[j] = OfWholeSteps(there[j], static_cast<Index>(problem_.NumMotionRows(index)),
                                problem_.recordings()[index].num_frames() - 1);
      }
      if (static_cast<Index>(there[j].size()) != rows->residuals.size()) continue;
      auto by = rows->by_column.col(next++);
      by = (Mapped(there[j]) - rows->residuals) / column.step;
      if (column.assumption != nullptr) Correct(*column.assumption, index, *rows, by);
      rows->columns.push_back(columns[j]);
    }
    rows->by_column.conservativeResize(Eigen::NoChange, next);
  }

  // The column of an assumption, of which the estimates' columns are known.
  void Correct(const Assumption& assumption, int index, const RawRows& rows,
               Eigen::Ref<Eigen::VectorXd> column) const {
    // With d(model - (1 + eta) measured) = d(model) - measured, the column holds the noise of what
    // was measured, which the residual holds as well: their product is no longer zero on average.
    // Less by the residual it is that of d(model / (1 + eta) - measured) = d(model) - model.
    const Index motion = static_cast<Index>(problem_.NumMotionRows(index));
    for (Index k = 0; assumption.of_rates && k < motion; ++k) {
      if (IsRate(k)) column[k] -= rows.residuals[k];
    }
    // The estimates are taken to have stayed where they are.
    for (const auto& [of, shift] : assumption.along) {
      const auto found =
          std::find(rows.columns.begin(), rows.columns.end(), static_cast<Index>(of));
      if (found == rows.columns.end()) continue;
      column -= shift / assumption.step * rows.by_column.col(found - rows.columns.begin());
    }
  }

  const FitProblem& problem_;
  Seen here_;
  std::map<const double*, Index> first_;  // column of each block of here_
  Eigen::VectorXd unit_;                  // of the estimates; 0: on a bound
  std::vector<Column> columns_;           // estimates, then assumptions
};

// A recording's rows, one person after the other, and its parts.
struct Condensed {
  RowBlock block;
  std::vector<DataPart> parts;
};

// Raw rows become those of the cost, and add up, part by part.
Condensed Condense(const FitProblem& problem, const RawRows& raw, Index num_all,
                   const std::vector<int>& horizons, int recording) {
  const PendulumRecording& r = problem.recordings()[recording];
  const FitOptions& options = problem.options();
  const int columns = static_cast<int>(raw.columns.size()), begin = PushFrame(r);
  const int num_parts = static_cast<int>(horizons.size()) + 1;
  const NormalEquations nothing(columns);
  const RolloutSums none{true, 0.0, nothing, nothing, {}};
  std::vector<RolloutSums> sums(static_cast<size_t>(r.num_people() * num_parts), none);
  std::vector<double> residuals(raw.residuals.data(), raw.residuals.data() + raw.residuals.size());
  RowMajorMatrix rows =
      RowMajorMatrix::Zero(raw.by_column.rows(), NormalEquations::PaddedSize(columns));
  rows.leftCols(columns) = raw.by_column;
  const auto of_frame = [&](int person, int frame) {
    const auto part = std::lower_bound(horizons.begin(), horizons.end(), frame - begin);
    return &sums[static_cast<size_t>(person * num_parts + (part - horizons.begin()))];
  };
  AddUpRows(*MakeRolloutProblem(r, options.model, problem.map(), options.sigmas,
                                problem.Weight(recording, 0), 0),
            true, LaneSums::kRobust, of_frame, &residuals, &rows);
  Condensed condensed{{recording, raw.columns, {}, {}, static_cast<int>(residuals.size())}, {}};
  for (int n = 0; n < r.num_people(); ++n) {
    RolloutSums all = none;
    for (int part = 0; part < num_parts; ++part) {
      const RolloutSums& some = sums[static_cast<size_t>(n * num_parts + part)];
      all.Add(some);
      const RowMajorMatrix gram = some.robust.information().topLeftCorner(columns, columns);
      DataPart& of =
          condensed.parts.emplace_back(DataPart{recording, n, part, Eigen::VectorXd::Zero(num_all),
                                                Eigen::MatrixXd::Zero(num_all, num_all)});
      of.score(raw.columns) = some.plain.gradient().head(columns);
      of.information(raw.columns, raw.columns) =
          Eigen::MatrixXd(gram.selfadjointView<Eigen::Upper>());
    }
    condensed.block.people.push_back(FewestRows(all));
    condensed.block.person_of_row.insert(condensed.block.person_of_row.end(),
                                         static_cast<size_t>(columns + 1), n);
  }
  return condensed;
}

}  // namespace

ResidualRows EvaluateRows(const FitProblem& problem, const FitPoint& point,
                          const std::vector<Assumption>& assumptions,
                          const std::vector<int>& horizons) {
  const int recordings = static_cast<int>(problem.recordings().size());
  RowsOfRecordings of(problem, point, assumptions);
  const Index estimates = of.num_estimates();
  const Index all = estimates + static_cast<Index>(assumptions.size());
  std::vector<RowBlock> blocks(recordings);
  std::vector<std::vector<DataPart>> parts(recordings);
  ParallelFor(recordings, problem.options().num_threads, [&](int i) {
    if (problem.Count(i) == 0) return;
    const RawRows raw = of.Of(i);
    if (raw.residuals.size() == 0) return;
    Condensed condensed = Condense(problem, raw, all, horizons, i);
    blocks[i] = std::move(condensed.block);
    parts[i] = std::move(condensed.parts);
  });
  for (int i = 0; i < recordings; ++i) {
    if (problem.Count(i) > 0 && blocks[i].num_rows == 0) return {};
  }
  blocks.erase(std::remove_if(blocks.begin(), blocks.end(),
                              [](const RowBlock& block) { return block.num_rows == 0; }),
               blocks.end());
  FitPoint copy = point;
  for (RowBlock& block : RowBlocksOf(problem.WithoutRecordings().Build(&copy, 0), false)) {
    blocks.push_back(std::move(block));
  }
  for (size_t k = 0; k < assumptions.size(); ++k) {
    const double sigma = assumptions[k].sigma, stated = sigma > 0.0 ? 1.0 / sigma : 0.0;
    blocks.push_back({FitProblem::kPriorCluster,
                      {estimates + static_cast<Index>(k)},
                      {{RowMajorMatrix::Constant(1, 1, stated), Eigen::VectorXd::Zero(1), {}}},
                      {-1}});
  }
  ResidualRows rows = Stack(blocks, all, true);
  for (std::vector<DataPart>& own : parts) {
    for (DataPart& part : own) rows.parts.push_back(std::move(part));
  }
  return rows;
}

ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  bool counted_only) {
  Seen here{problem.options().model, problem.map(), point};
  std::vector<RolloutAt> rollouts(problem.recordings().size());
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    if (counted_only && problem.Count(i) == 0) continue;
    rollouts[i] = RawRollout(problem, problem.recordings()[i], i, &here);
  }
  return ResidualsOf(rollouts);
}

std::vector<FittedColumn> FittedColumns(const FitProblem& problem, const FitPoint& point) {
  std::vector<FittedColumn> columns;
  const ParameterTable& table = problem.options().table;
  const auto& fitted = problem.map().fitted;
  for (size_t i = 0; i < fitted.size(); ++i) {
    const ParameterSpec& spec = problem.Spec(i);
    FittedColumn c{spec.name, spec.unit, spec.transform, spec.scale};
    c.width = spec.prior ? spec.prior->sigma : spec.scale;
    c.fitted = point.shared[i];
    c.natural = ToNatural(spec.transform, c.fitted);
    const auto [lower, upper] = problem.Bounds(i);
    const double margin = 1e-6 * (upper - lower);
    c.at_bound = c.fitted < lower + margin || c.fitted > upper - margin;
    columns.push_back(c);
  }
  for (const auto& [unit, values] : point.unit) {
    for (const FittedParameter& f : fitted) {
      if (f.deviation < 0) continue;
      const ParameterSpec& spec = table[f.parameter];
      const bool plain = f.transform == Transform::kIdentity;
      FittedColumn c{spec.name + "[" + unit + "] deviation", plain ? spec.unit : "1"};
      c.scale = c.width = plain ? spec.scale : 1.0;
      c.fitted = c.natural = values[f.deviation];
      columns.push_back(c);
    }
  }
  static const char* const kVelocityNames[] = {"xd", "yd", "thetad", "phid"};
  for (const auto& [recording, values] : point.velocity) {
    for (size_t k = 0; k < values.size(); ++k) {
      FittedColumn c{"initial " + std::string(kVelocityNames[k % 4]) + "[" +
                         problem.recordings()[recording].id +
                         (values.size() > 4 ? ":" + std::to_string(k / 4) : "") + "]",
                     k % 4 < 2 ? "m/s" : "rad/s"};
      c.scale = c.width = 0.1;
      c.fitted = c.natural = values[k];
      columns.push_back(c);
    }
  }
  for (size_t i = 0; i < point.weights.size(); ++i) {
    FittedColumn c{"network weight " + std::to_string(i), "1"};
    c.fitted = c.natural = point.weights[i];
    columns.push_back(c);
  }
  return columns;
}

Eigen::VectorXd Units(const std::vector<FittedColumn>& columns) {
  Eigen::VectorXd unit(columns.size());
  for (size_t i = 0; i < columns.size(); ++i) {
    const FittedColumn& c = columns[i];
    unit[static_cast<Index>(i)] =
        c.at_bound ? 0.0 : c.scale / TransformSlope(c.transform, c.natural);
  }
  return unit;
}

}  // namespace pushid
