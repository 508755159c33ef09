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
         a.options.cart_derivative == b.options.cart_derivative &&
         a.layout.first_acting == b.layout.first_acting &&
         a.layout.VelocityColumn() == b.layout.VelocityColumn() &&
         std::equal(a.map.fitted.begin(), a.map.fitted.end(), b.map.fitted.begin(),
                    b.map.fitted.end(), [](const FittedParameter& x, const FittedParameter& y) {
                      return x.parameter == y.parameter;
                    });
}

using ConstVector = Eigen::Map<const Eigen::VectorXd>;

// The rows of one frame of one person, of motion or of platforms.
struct FrameRows {
  int person, count;
  double weight;            // on all of them, which the robust loss does not see
  const double* residuals;  // count
  double* by_column;        // count x PaddedSize of the columns; the visitor may change them
};

// By the columns of `inputs`, which may be none.
template <typename Visit>
RolloutStatus VisitRows(const RolloutProblem& p, const SensitivityInputs& inputs,
                        const Visit& visit) {
  // A thread's own, used again: asking the system for them each time costs a tenth of a rollout.
  thread_local std::vector<double> residuals;
  thread_local RowMajorMatrix rows;
  const RolloutStatus status = RowsByJets(p, inputs, &residuals, &rows);
  if (!status.ok) return status;
  int row = 0;
  const auto next = [&](int person, int count, double weight) {
    double* const by_column = rows.data() + static_cast<size_t>(row) * inputs.num_columns;
    visit(FrameRows{person, count, weight, residuals.data() + row, by_column});
    row += count;
  };
  for (int t = 1; t < p.horizon; ++t) {
    for (int n = 0; n < p.recording->num_people(); ++n) {
      next(n, kFrameResiduals, p.weight * p.recording->Weight(n, t));
    }
  }
  const std::vector<int> on_plates = p.PeopleOnPlates();
  for (int t = 0; t + 1 < p.horizon; ++t) {
    for (int n : on_plates) next(n, kPlateResiduals, p.weight * p.recording->plates[n][t].weight);
  }
  return status;
}

}  // namespace

bool HasLanes(const RolloutProblem& problem) {
  return problem.derivatives == DerivativesBy::kAuto &&
         HasLanes(problem.recording->scene, problem.options) && !problem.recording->HasPlates() &&
         problem.sigmas.loss == FrameLoss::kHip;
}

LaneGroup::LaneGroup(std::vector<const RolloutProblem*> problems, const PersonLanes& lanes)
    : problems_(std::move(problems)),
      tables_(lanes, MostFrames(problems_), MostTails(problems_), MostFrames(problems_)) {
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
  const RolloutProblem& first = *problems_[0];
  const int columns = first.layout.num_acting();
  // A thread's own, used again.
  thread_local std::vector<double> constants, failed, residuals, squares, plain, robust;
  thread_local LaneParameters parameters;
  constants = tables_.constants();
  const int width = tables_.width();
  parameters.Clear(width);
  const bool derivatives = sums != LaneSums::kSquares && sums != LaneSums::kNone;
  for (size_t lane = 0; lane < problems_.size(); ++lane) {
    const RolloutProblem& problem = *problems_[lane];
    const ScenePerson& person = problem.recording->scene.people[0];
    const double* const free = problem.layout.VelocityBlock(blocks[lane]);
    for (int i = 0; i < 4; ++i) {
      constants[(kLaneStart + 4 + i) * width + lane] =
          free != nullptr ? free[i] : person.start.qd[i];
    }
    const auto sets = problem.layout.Parameters<double>(problem.map, blocks[lane]);
    const ParameterSet<double>& p = sets[0];
    parameters.Set(
        static_cast<int>(lane), p,
        derivatives ? problem.layout.Entries(problem.map, p, 0) : std::vector<ColumnEntry>());
  }
  LaneInputs in = tables_.Inputs();
  in.sigmas = first.sigmas;
  in.columns = columns;
  in.velocity_column = first.layout.VelocityColumn();
  parameters.In(&in);
  in.constants = constants.data();
  const int size = (columns + 1) * (columns + 1) * width;
  failed.resize(width);
  squares.resize(width);
  if (sums == LaneSums::kNone) residuals.resize((in.frames - 1) * kFrameResiduals * width);
  plain.resize(size);
  robust.resize(size);
  tables_.Roll(in, sums,
               {failed.data(), residuals.data(), squares.data(), plain.data(), robust.data()});
  std::vector<RolloutSums> results(problems_.size());
  for (size_t lane = 0; lane < results.size(); ++lane) {
    results[lane].ok = failed[lane] == 0.0;
    results[lane].squares = squares[lane];
    if (sums == LaneSums::kSquares || !results[lane].ok) continue;
    if (sums == LaneSums::kNone) {
      const int rows = problems_[lane]->num_motion_rows();
      results[lane].residuals.resize(rows);
      for (int k = 0; k < rows; ++k) results[lane].residuals[k] = residuals[k * width + lane];
      continue;
    }
    results[lane].plain = NormalEquations(columns, plain.data() + lane, width);
    if (sums != LaneSums::kRobust) continue;
    results[lane].robust = NormalEquations(columns, robust.data() + lane, width);
  }
  return results;
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
      const bool full = static_cast<int>(members.size()) == BestPersonLanes().lanes;
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
  RolloutSums sums;
  sums.plain = NormalEquations(columns);
  sums.ok = VisitRows(p, inputs, [&](const FrameRows& rows) {
              if (jacobians == nullptr) {
                sums.squares += ConstVector(rows.residuals, rows.count).squaredNorm();
              } else {
                sums.plain.Add(rows.count, rows.by_column, rows.residuals);
              }
            }).ok;
  return FillRows(sums, residuals, jacobians);
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

CondensedRollout::PersonRows CondensedRollout::RowsOf(const NormalEquations& plain,
                                                      const NormalEquations* robust) const {
  const int acting = plain.columns();
  const RowMajorMatrix factor = plain.Factor();
  PersonRows rows{columns_.Expand(factor.leftCols(acting)), factor.col(acting), {}};
  if (robust != nullptr) {
    rows.robust_jacobian = columns_.Expand(robust->Factor().leftCols(acting));
  }
  return rows;
}

bool CondensedRollout::FillPeople(const RolloutSums& sums, bool robust,
                                  std::vector<PersonRows>* people) const {
  if (!sums.ok) return false;
  *people = {RowsOf(sums.plain, robust ? &sums.robust : nullptr)};
  return true;
}

bool CondensedRollout::EvaluatePeople(double const* const* blocks, bool robust,
                                      std::vector<PersonRows>* people) const {
  if (in_lanes() != nullptr) {
    return FillPeople(Alone(blocks, robust ? LaneSums::kRobust : LaneSums::kPlain), robust, people);
  }
  const RolloutProblem& p = *problem_;
  const int acting = p.layout.num_acting();
  std::vector<NormalEquations> plain(num_people(), NormalEquations(acting));
  std::vector<NormalEquations> corrected(robust ? num_people() : 0, NormalEquations(acting));
  const SensitivityInputs inputs = RolloutInputs(p.recording->scene, p.map, p.layout, blocks);
  const RolloutStatus status = VisitRows(p, inputs, [&](const FrameRows& rows) {
    plain[rows.person].Add(rows.count, rows.by_column, rows.residuals);
    if (!robust) return;
    CorrectForRobustLoss(
        ConstVector(rows.residuals, rows.count), rows.weight, p.sigmas.OfFrames(),
        Eigen::Map<RowMajorMatrix>(rows.by_column, rows.count, inputs.num_columns));
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
