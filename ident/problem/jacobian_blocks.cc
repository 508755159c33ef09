// ident: evaluating a problem block by block.
#include "ident/problem/jacobian_blocks.h"

#include <map>
#include <set>
#include <utility>

#include "ident/problem/fit_problem.h"
#include "ident/problem/work.h"
#include "residuals/cost_functions/condensed_rollout.h"
#include "residuals/cost_functions/likelihood_residual.h"

namespace pushid {

namespace {

using PersonRows = CondensedRows::PersonRows;

// A cost function's own rows.
bool EvaluateRows(const ceres::CostFunction& cost, const std::vector<const double*>& at,
                  PersonRows* rows) {
  const int n = cost.num_residuals();
  std::vector<RowMajorMatrix> by_block;
  std::vector<double*> pointers;
  int columns = 0;
  for (int size : cost.parameter_block_sizes()) {
    by_block.emplace_back(n, size);
    columns += size;
  }
  for (RowMajorMatrix& jacobian : by_block) pointers.push_back(jacobian.data());
  rows->residuals.resize(n);
  if (!cost.Evaluate(at.data(), rows->residuals.data(), pointers.data())) return false;
  rows->jacobian.resize(n, columns);
  int column = 0;
  for (const RowMajorMatrix& jacobian : by_block) {
    rows->jacobian.middleCols(column, jacobian.cols()) = jacobian;
    column += static_cast<int>(jacobian.cols());
  }
  return true;
}

// Puts rows, and whose they are, under each other.
class Gatherer {
 public:
  Gatherer(const FitProblem::Built& built, bool robust, JacobianBlocks* score)
      : built_(built), robust_(robust), score_(*score) {
    for (double* block : built.parameter_blocks) {
      column_of_[block] = columns_;
      columns_ += built.problem->ParameterBlockSize(block);
    }
  }

  // sums: of all rollouts that go side by side.
  void Add(const FitProblem::Built::Block& block, const std::vector<RolloutSums>& sums) {
    std::vector<double*> on;
    built_.problem->GetParameterBlocksForResidualBlock(block.id, &on);
    const std::vector<const double*> at(on.begin(), on.end());
    const auto* rollout = dynamic_cast<const CondensedRows*>(block.cost);
    const auto* recording = dynamic_cast<const CondensedRollout*>(block.cost);
    std::vector<PersonRows> people(1);
    // A block that cannot be evaluated here was left out by Build; skip it all the same.
    const bool told = recording != nullptr && recording->in_lanes() != nullptr
                          ? recording->FillPeople(sums[block.cluster], robust_, &people)
                      : rollout != nullptr ? rollout->EvaluatePeople(at.data(), robust_, &people)
                                           : EvaluateRows(*block.cost, at, &people[0]);
    if (!told) return;
    const bool data = block.cluster >= 0;
    const auto* steps = dynamic_cast<const LikelihoodResidual*>(block.cost);
    for (size_t n = 0; n < people.size(); ++n) {
      const Eigen::Index count = people[n].residuals.size();
      for (Eigen::Index row = 0; row < count; ++row) {
        score_.cluster_of_row.push_back(block.cluster);
        score_.person_of_row.push_back(rollout != nullptr ? static_cast<int>(n)
                                       : steps != nullptr ? steps->PersonOfRow(row)
                                                          : -1);
      }
      if (robust_ && rollout == nullptr) {  // a likelihood has no robust loss
        people[n].robust_jacobian = people[n].jacobian;
        if (!data) people[n].robust_jacobian.setZero();
      }
    }
    if (data) {
      present_.insert(block.cluster);
      score_.num_data_rows +=
          rollout != nullptr ? rollout->num_rows() : block.cost->num_residuals();
    }
    parts_.push_back({std::move(on), std::move(people)});
  }

  void Finish() {
    const Eigen::Index rows = static_cast<Eigen::Index>(score_.cluster_of_row.size());
    score_.residuals.resize(rows);
    score_.jacobian.setZero(rows, columns_);
    if (robust_) score_.robust_jacobian.setZero(rows, columns_);
    Eigen::Index row = 0;
    for (const auto& [on, people] : parts_) {
      for (const PersonRows& person : people) {
        const Eigen::Index count = person.residuals.size();
        score_.residuals.segment(row, count) = person.residuals;
        Eigen::Index from = 0;
        for (double* block : on) {
          const int to = column_of_.at(block), size = built_.problem->ParameterBlockSize(block);
          score_.jacobian.block(row, to, count, size) = person.jacobian.middleCols(from, size);
          if (robust_) {
            score_.robust_jacobian.block(row, to, count, size) =
                person.robust_jacobian.middleCols(from, size);
          }
          from += size;
        }
        row += count;
      }
    }
    score_.clusters.assign(present_.begin(), present_.end());
  }

 private:
  const FitProblem::Built& built_;
  const bool robust_;
  JacobianBlocks& score_;
  std::map<const double*, int> column_of_;
  int columns_ = 0;
  std::set<int> present_;
  std::vector<std::pair<std::vector<double*>, std::vector<PersonRows>>> parts_;
};

}  // namespace

JacobianBlocks EvaluateJacobianBlocks(const FitProblem::Built& built, bool robust) {
  CountEvaluations({1, 0});
  JacobianBlocks score;
  Gatherer gatherer(built, robust, &score);
  const std::vector<RolloutSums> sums =
      SumUp(*built.side_by_side, built.rollouts, robust ? LaneSums::kRobust : LaneSums::kPlain);
  for (const FitProblem::Built::Block& block : built.blocks) gatherer.Add(block, sums);
  gatherer.Finish();
  return score;
}

std::vector<int> JacobianBlocks::RowsOf(int cluster) const {
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(cluster_of_row.size()); ++row) {
    if (cluster_of_row[row] == cluster) rows.push_back(row);
  }
  return rows;
}

void AddCurvature(const FitProblem::Built& built, const Eigen::VectorXd& steps, bool both_sides,
                  JacobianBlocks* score) {
  ceres::Problem::EvaluateOptions by_all;
  by_all.parameter_blocks = built.parameter_blocks;
  const Eigen::Index size = score->jacobian.cols();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index column = 0;
  std::vector<double> above(size), below(size);  // without the other side: at the point
  Eigen::VectorXd::Map(below.data(), size) = score->jacobian.transpose() * score->residuals;
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
      for (Eigen::Index row = 0; row < size; ++row) {
        hessian(row, column) = (above[row] - below[row]) / (both_sides ? 2.0 * step : step);
      }
    }
  }
  score->curvature =
      0.5 * (hessian + hessian.transpose()) - score->jacobian.transpose() * score->jacobian;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (steps[i] != 0.0) continue;
    score->curvature.row(i).setZero();
    score->curvature.col(i).setZero();
  }
}

ResidualSigmas PlainSigmas(const FitProblem& problem) {
  ResidualSigmas plain = problem.options().sigmas;
  plain.robust = 0.0;
  return plain;
}

std::vector<std::vector<double>> ResidualsOf(const std::vector<RolloutAt>& rollouts) {
  std::vector<RolloutSums> sums = SumUp(PutSideBySide(rollouts), rollouts, LaneSums::kNone);
  std::vector<std::vector<double>> raw(rollouts.size());
  for (size_t i = 0; i < rollouts.size(); ++i) {
    const RolloutProblem* const problem = rollouts[i].problem.get();
    raw[i] = std::move(sums[i].residuals);
    if (problem == nullptr || HasLanes(*problem)) continue;
    raw[i].resize(problem->num_residuals());
    if (!RolloutResiduals(*problem, rollouts[i].blocks.data(), raw[i].data())) raw[i].clear();
  }
  return raw;
}

ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  const std::vector<bool>& wanted) {
  FitPoint copy = point;
  const ResidualSigmas plain = PlainSigmas(problem);
  std::vector<RolloutAt> rollouts(problem.recordings().size());
  for (int i = 0; i < static_cast<int>(rollouts.size()); ++i) {
    if (!wanted.empty() && !wanted[i]) continue;
    rollouts[i] = {MakeRolloutProblem(problem.recordings()[i], problem.options().model,
                                      problem.map(), plain, 1.0, 0),
                   problem.RecordingBlocks(&copy, i)};
  }
  return ResidualsOf(rollouts);
}

}  // namespace pushid
