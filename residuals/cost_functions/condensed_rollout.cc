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

// Sums over the rows of a recording by jets, by the columns of `inputs`, which may be none: of each
// person, or of all where there is one sum. False outside the model's domain.
bool SumUpRows(const RolloutProblem& p, const SensitivityInputs& inputs, int columns,
               LaneSums wanted, std::vector<RolloutSums>* sums) {
  // A thread's own, used again: asking the system for them each time costs a tenth of a rollout.
  thread_local std::vector<double> residuals;
  thread_local RowMajorMatrix rows;
  if (!RowsByJets(p, inputs, &residuals, &rows).ok) return false;
  for (RolloutSums& sum : *sums) {
    sum.ok = true;
    sum.plain = sum.robust = NormalEquations(columns);
  }
  int row = 0;
  // weight: on all of the rows, which the robust loss does not see.
  const auto add = [&](int person, int count, double weight) {
    RolloutSums& sum = (*sums)[sums->size() == 1 ? 0 : person];
    const Eigen::Map<const Eigen::VectorXd> r(residuals.data() + row, count);
    Eigen::Map<RowMajorMatrix> by_column(rows.data() + static_cast<size_t>(row) * rows.cols(),
                                         count, rows.cols());
    row += count;
    if (wanted == LaneSums::kSquares) {
      sum.squares += r.squaredNorm();
      return;
    }
    sum.plain.Add(count, by_column.data(), r.data());
    if (wanted != LaneSums::kRobust) return;
    CorrectForRobustLoss(r, weight, p.sigmas.OfFrames(), by_column);
    sum.robust.Add(count, by_column.data(), r.data());
  };
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < p.recording->num_people(); ++n) {
      add(n, kFrameResiduals, p.weight * p.recording->Weight(n, t));
    }
  }
  const std::vector<int> on_plates = p.PeopleOnPlates();
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (int n : on_plates) add(n, kPlateResiduals, p.weight * p.recording->plates[n][t].weight);
  }
  return true;
}

}  // namespace

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

std::vector<RolloutSums> SumUp(const std::vector<SideBySide>& groups,
                               const std::vector<RolloutAt>& rollouts, LaneSums sums) {
  std::vector<RolloutSums> all(rollouts.size());
  for (const SideBySide& group : groups) {
    std::vector<double const* const*> at;
    for (int i : group.members) at.push_back(rollouts[i].blocks.data());
    std::vector<RolloutSums> some = group.lanes.Evaluate(at, sums);
    for (size_t k = 0; k < some.size(); ++k) all[group.members[k]] = std::move(some[k]);
  }
  return all;
}

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
    columns -= p.map.num_weights;  // which are held
    inputs.num_columns = NormalEquations::PaddedSize(columns);
    inputs.weight_column = -1;
  }
  std::vector<RolloutSums> sums(1);
  return SumUpRows(p, inputs, columns, jacobians != nullptr ? LaneSums::kPlain : LaneSums::kSquares,
                   &sums) &&
         FillRows(sums[0], residuals, jacobians);
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

bool CondensedRollout::FillPeople(const std::vector<RolloutSums>& sums, bool robust,
                                  std::vector<PersonRows>* people) const {
  people->clear();
  for (const RolloutSums& sum : sums) {
    if (!sum.ok) return false;
    const int acting = sum.plain.columns();
    const RowMajorMatrix factor = sum.plain.Factor();
    people->push_back({columns_.Expand(factor.leftCols(acting)), factor.col(acting), {}});
    if (!robust) continue;
    people->back().robust_jacobian = columns_.Expand(sum.robust.Factor().leftCols(acting));
  }
  return true;
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  const LaneSums wanted = robust ? LaneSums::kRobust : LaneSums::kPlain;
  if (in_lanes() != nullptr) return FillPeople({Alone(blocks, wanted)}, robust, people);
  const RolloutProblem& p = *problem_;
  std::vector<RolloutSums> sums(num_people());
  return SumUpRows(p, RolloutInputs(p.recording->scene, p.map, p.layout, blocks),
                   p.layout.num_acting(), wanted, &sums) &&
         FillPeople(sums, robust, people);
}

}  // namespace pushid
