// residuals: recordings side by side, and rows condensed, of a recording and of each of its people.
#include "residuals/cost_functions/condensed_rollout.h"

#include <algorithm>
#include <cmath>

#include "residuals/jets/autodiff_rollout.h"

namespace pushid {
namespace {

int MostFrames(const std::vector<const RolloutProblem*>& problems) {
  int most = 0;
  for (const RolloutProblem* problem : problems) most = std::max(most, problem->horizon);
  return most;
}

int MostTails(const std::vector<const RolloutProblem*>& problems) {
  int most = 0;
  for (const RolloutProblem* problem : problems) {
    most = std::max(most, NumTails(problem->recording->scene, problem->options));
  }
  return most;
}

// Whether two have the same columns.
bool SameLanes(const RolloutProblem& a, const RolloutProblem& b) {
  return a.options.friction == b.options.friction &&
         a.layout.first_acting == b.layout.first_acting &&
         a.layout.VelocityColumn() == b.layout.VelocityColumn() &&
         std::equal(a.map.fitted.begin(), a.map.fitted.end(), b.map.fitted.begin(),
                    b.map.fitted.end(), [](const FittedParameter& x, const FittedParameter& y) {
                      return x.parameter == y.parameter;
                    });
}

// By the acting columns; of a rollout in no group.
std::vector<RolloutSums> SumUpByJets(const RolloutProblem& p, double const* const* blocks,
                                     LaneSums wanted, bool by_person, bool weights_held) {
  if (wanted == LaneSums::kNone) {
    RolloutProblem raw = p;
    raw.sigmas.robust = 0.0;
    RolloutSums sums;
    sums.residuals.resize(raw.num_residuals());
    sums.ok = RolloutResiduals(raw, blocks, sums.residuals.data());
    return {std::move(sums)};
  }
  // A thread's own, used again: asking the system for them each time costs a tenth of a rollout.
  thread_local std::vector<double> residuals;
  thread_local RowMajorMatrix rows;
  SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  int columns = p.layout.num_acting();
  if (wanted == LaneSums::kSquares) {
    columns = inputs.num_columns = 0;
  } else if (weights_held && p.map.num_weights > 0) {
    columns -= p.map.num_weights;
    inputs.num_columns = NormalEquations::PaddedSize(columns);
    inputs.weight_column = -1;
  }
  RolloutSums none;
  none.ok = RowsByJets(p, inputs, &residuals, &rows).ok;
  none.plain = NormalEquations(columns);
  if (wanted == LaneSums::kRobust) none.robust = none.plain;
  std::vector<RolloutSums> sums(by_person ? p.recording->num_people() : 1, none);
  if (!none.ok) return sums;
  const auto to = [&](int person, int) { return &sums[by_person ? person : 0]; };
  AddUpRows(p, false, wanted, to, &residuals, &rows);
  return sums;
}

}  // namespace

void RolloutSums::Add(const RolloutSums& other) {
  squares += other.squares;
  plain.Add(other.plain);
  robust.Add(other.robust);
}

void AddUpRows(const RolloutProblem& p, bool raw, LaneSums wanted, const SumsOfFrame& to,
               std::vector<double>* residuals, RowMajorMatrix* rows) {
  const double robust = p.sigmas.OfFrames();
  Eigen::Index row = 0;
  // seen: how much of the frame was, which the robust loss does not see.
  const auto add = [&](RolloutSums* sum, int count, double seen) {
    Eigen::Map<Eigen::VectorXd> r(residuals->data() + row, count);
    Eigen::Map<RowMajorMatrix> by_column(rows->data() + row * rows->cols(), count, rows->cols());
    row += count;
    if (raw) ApplyRobustLoss(seen, p.weight, robust, r, by_column);
    sum->squares += r.squaredNorm();
    if (wanted == LaneSums::kSquares) return;
    sum->plain.Add(count, by_column.data(), r.data());
    if (wanted != LaneSums::kRobust) return;
    CorrectForRobustLoss(r, p.weight * seen, robust, by_column);
    sum->robust.Add(count, by_column.data(), r.data());
  };
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < p.recording->num_people(); ++n) {
      add(to(n, t), kFrameResiduals, p.recording->Weight(n, t));
    }
  }
  const std::vector<int> on_plates = p.PeopleOnPlates();
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (int n : on_plates) add(to(n, t), kPlateResiduals, p.recording->plates[n][t].weight);
  }
}

PersonRows FewestRows(const RolloutSums& sums) {
  const int columns = sums.plain.columns();
  const RowMajorMatrix factor = sums.plain.Factor();
  PersonRows rows{factor.leftCols(columns), factor.col(columns), {}};
  if (sums.robust.columns() > 0) rows.robust_jacobian = sums.robust.Factor().leftCols(columns);
  return rows;
}

bool HasLanes(const RolloutProblem& problem) {
  return problem.derivatives == DerivativesBy::kAuto &&
         HasLanes(problem.recording->scene, problem.options) && !problem.recording->HasPlates() &&
         problem.sigmas.loss == FrameLoss::kHip;
}

LaneGroup::LaneGroup(std::vector<const RolloutProblem*> problems, const PersonLanes& lanes)
    : problems_(std::move(problems)), tables_(lanes, MostTails(problems_), MostFrames(problems_)) {
  for (size_t i = 0; i < problems_.size(); ++i) {
    const RolloutProblem& problem = *problems_[i];
    const int lane = static_cast<int>(i);
    tables_.Set(lane, problem.recording->scene, problem.options, problem.horizon);
  }
  const int frames = MostFrames(problems_);
  for (int t = 0; t < frames; ++t) {  // frame by frame, as they lie in memory
    for (size_t i = 0; i < problems_.size(); ++i) {
      const RolloutProblem& problem = *problems_[i];
      if (t >= problem.horizon) continue;
      const PendulumRecording& recording = *problem.recording;
      tables_.SetMeasured(static_cast<int>(i), t, recording.hip[0][t], recording.states[0][t],
                          problem.weight * recording.Weight(0, t));
    }
  }
}

std::vector<RolloutSums> LaneGroup::Evaluate(const std::vector<double const* const*>& blocks,
                                             LaneSums sums) const {
  thread_local LaneResults results;  // a thread's own, used again
  const RolloutProblem& first = *problems_[0];
  const int columns = first.layout.num_acting(), width = tables_.width();
  std::vector<LanePerson> people(problems_.size());
  for (size_t lane = 0; lane < people.size(); ++lane) {
    const RolloutProblem& p = *problems_[lane];
    LanePerson& person = people[lane];
    person.parameters = p.layout.Parameters<double>(p.map, blocks[lane])[0];
    person.velocity = p.layout.VelocityBlock(blocks[lane]);
    if (sums == LaneSums::kSquares || sums == LaneSums::kNone) continue;
    person.entries = p.layout.Entries(p.map, person.parameters, 0);
  }
  tables_.Roll(
      {sums, MostFrames(problems_), columns, first.layout.VelocityColumn(), 0, first.sigmas},
      people, &results);
  std::vector<RolloutSums> all(problems_.size());
  for (size_t lane = 0; lane < all.size(); ++lane) {
    all[lane].ok = results.failed[lane] == 0.0;
    all[lane].squares = results.squares[lane];
    if (sums == LaneSums::kSquares || !all[lane].ok) continue;
    if (sums == LaneSums::kNone) {
      const int rows = problems_[lane]->num_motion_rows();
      for (int k = 0; k < rows; ++k) {
        all[lane].residuals.push_back(results.residuals[k * width + lane]);
      }
      continue;
    }
    all[lane].plain = NormalEquations(columns, results.plain.data() + lane, width);
    if (sums != LaneSums::kRobust) continue;
    all[lane].robust = NormalEquations(columns, results.robust.data() + lane, width);
  }
  return all;
}

std::vector<SideBySide> PutSideBySide(const std::vector<RolloutAt>& rollouts) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    if (rollouts[i].problem != nullptr && HasLanes(*rollouts[i].problem)) order.push_back(i);
  }
  // Neighbours are of about the same length: a group takes as long as its longest.
  std::stable_sort(order.begin(), order.end(), [&rollouts](int i, int j) {
    return rollouts[i].problem->horizon > rollouts[j].problem->horizon;
  });
  std::vector<SideBySide> groups;
  for (size_t first = 0; first < order.size();) {
    const RolloutProblem& of_all = *rollouts[order[first]].problem;
    std::vector<int> members;
    std::vector<const RolloutProblem*> together;
    for (size_t i = first; i < order.size(); ++i) {
      const RolloutProblem* const next = rollouts[order[i]].problem.get();
      const bool full = static_cast<int>(members.size()) == Widest<PersonLanes>().lanes;
      if (full || !SameLanes(of_all, *next)) break;
      members.push_back(order[i]);
      together.push_back(next);
    }
    first += members.size();
    groups.push_back({std::move(members), LaneGroup(std::move(together))});
  }
  return groups;
}

std::vector<std::vector<RolloutSums>> SumUp(const std::vector<SideBySide>& groups,
                                            const std::vector<RolloutAt>& rollouts, LaneSums wanted,
                                            bool by_person) {
  std::vector<std::vector<RolloutSums>> all(rollouts.size());
  for (const SideBySide& group : groups) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(rollouts[i].blocks.data());
    std::vector<RolloutSums> some = group.lanes.Evaluate(at, wanted);
    for (size_t k = 0; k < some.size(); ++k) {
      all[group.members[k]].push_back(std::move(some[k]));
    }
  }
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const auto& [problem, blocks] = rollouts[i];
    if (problem == nullptr || !all[i].empty()) continue;
    all[i] = SumUpByJets(*problem, blocks.data(), wanted, by_person, false);
  }
  return all;
}

CondensedRollout::CondensedRollout(std::shared_ptr<const RolloutProblem> problem)
    : problem_(std::move(problem)), columns_(problem_->layout) {
  for (int size : problem_->layout.BlockSizes()) mutable_parameter_block_sizes()->push_back(size);
  set_num_residuals(problem_->layout.num_acting() + 1);
}

bool CondensedRollout::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const bool derivatives = jacobians != nullptr;
  const bool weights_held = derivatives && jacobians[problem_->layout.num_blocks() - 1] == nullptr;
  return FillRows(SumsAt(blocks, derivatives ? LaneSums::kPlain : LaneSums::kSquares, weights_held),
                  residuals, jacobians);
}

RolloutSums CondensedRollout::SumsAt(double const* const* blocks, LaneSums wanted,
                                     bool weights_held) const {
  if (!HasLanes(*problem_)) {
    return SumUpByJets(*problem_, blocks, wanted, false, weights_held)[0];
  }
  if (alone_ == nullptr) alone_ = std::make_unique<LaneGroup>(std::vector{problem_.get()});
  return alone_->Evaluate({blocks}, wanted)[0];
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

std::vector<PersonRows> CondensedRollout::RowsOf(const std::vector<RolloutSums>& sums) const {
  std::vector<PersonRows> people;
  for (const RolloutSums& sum : sums) {
    if (!sum.ok) return {};
    PersonRows& rows = people.emplace_back(FewestRows(sum));
    rows.jacobian = columns_.Expand(rows.jacobian);
    if (sum.robust.columns() > 0) rows.robust_jacobian = columns_.Expand(rows.robust_jacobian);
  }
  return people;
}

}  // namespace pushid
