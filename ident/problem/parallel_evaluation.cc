// ident: evaluating ahead.
#include "ident/problem/parallel_evaluation.h"

#include <algorithm>
#include <map>

#include "ident/problem/parallel.h"
#include "residuals/cost_functions/condensed_rollout.h"

namespace pushid {
namespace {

LaneSums SumsWanted(bool with_jacobians) {
  return with_jacobians ? LaneSums::kPlain : LaneSums::kSquares;
}

}  // namespace

class ParallelEvaluation::Prepared : public ceres::CostFunction {
 public:
  Prepared(std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& blocks)
      : cost_(std::move(cost)),
        rollout_(dynamic_cast<const CondensedRollout*>(cost_.get())),
        blocks_(blocks) {
    set_num_residuals(cost_->num_residuals());
    *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
    residuals_.resize(num_residuals());
    jacobians_.resize(blocks_.size());
  }

  // Evaluates at the blocks' present values; constant blocks get no derivatives.
  void Prepare(bool with_jacobians, const ceres::Problem& problem) {
    if (IsPrepared(with_jacobians)) return;
    if (rollout_ != nullptr) {
      const bool weights_held = problem.IsParameterBlockConstant(blocks_.back());
      return Prepare(rollout_->SumsAt(blocks_.data(), SumsWanted(with_jacobians), weights_held),
                     with_jacobians);
    }
    std::vector<double*> jacobians(blocks_.size(), nullptr);
    for (size_t b = 0; with_jacobians && b < blocks_.size(); ++b) {
      const bool constant = problem.IsParameterBlockConstant(blocks_[b]);
      jacobians_[b].resize(constant ? 0 : num_residuals() * parameter_block_sizes()[b]);
      if (!constant) jacobians[b] = jacobians_[b].data();
    }
    Remember(with_jacobians);
    ok_ = cost_->Evaluate(blocks_.data(), residuals_.data(),
                          with_jacobians ? jacobians.data() : nullptr);
  }
  // A rollout is prepared by its sums; its rows are made when Ceres asks for them.
  void Prepare(RolloutSums sums, bool with_jacobians) {
    sums_ = std::move(sums);
    Remember(with_jacobians);
  }
  bool IsPrepared(bool with_jacobians) const { return Holds(blocks_.data(), with_jacobians); }
  // Null where it is none.
  const RolloutProblem* problem() const {
    return rollout_ != nullptr ? &rollout_->problem() : nullptr;
  }
  const RolloutSums& sums() const { return sums_; }
  double const* const* blocks() const { return blocks_.data(); }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    bool held = Holds(blocks, jacobians != nullptr);
    if (held && rollout_ != nullptr) {
      const bool asks_held = jacobians != nullptr && jacobians[blocks_.size() - 1] != nullptr &&
                             sums_.plain.columns() < problem()->layout.num_acting();
      if (!asks_held) return rollout_->FillRows(sums_, residuals, jacobians);
      held = false;
    }
    for (size_t b = 0; held && jacobians != nullptr && b < blocks_.size(); ++b) {
      held = jacobians[b] == nullptr || !jacobians_[b].empty();
    }
    if (!held) return cost_->Evaluate(blocks, residuals, jacobians);
    std::copy(residuals_.begin(), residuals_.end(), residuals);
    for (size_t b = 0; jacobians != nullptr && b < blocks_.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      std::copy(jacobians_[b].begin(), jacobians_[b].end(), jacobians[b]);
    }
    return ok_;
  }

 private:
  void Remember(bool with_jacobians) {
    has_jacobians_ = with_jacobians;
    point_.clear();
    for (size_t b = 0; b < blocks_.size(); ++b) {
      point_.insert(point_.end(), blocks_[b], blocks_[b] + parameter_block_sizes()[b]);
    }
  }
  bool Holds(double const* const* blocks, bool with_jacobians) const {
    if (point_.empty() || (with_jacobians && !has_jacobians_)) return false;
    auto at = point_.begin();
    for (size_t b = 0; b < blocks_.size(); at += parameter_block_sizes()[b++]) {
      if (!std::equal(at, at + parameter_block_sizes()[b], blocks[b])) return false;
    }
    return true;
  }

  std::unique_ptr<ceres::CostFunction> cost_;
  const CondensedRollout* rollout_;  // the cost, where it is one
  std::vector<double*> blocks_;
  std::vector<double> point_;  // where it was evaluated; empty: nowhere yet
  bool has_jacobians_ = false, ok_ = false;
  std::vector<double> residuals_;
  std::vector<std::vector<double>> jacobians_;  // empty for a constant block
  RolloutSums sums_;                            // of a rollout, in place of these
};

std::unique_ptr<ceres::CostFunction> ParallelEvaluation::Wrap(
    std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& blocks) {
  auto prepared = std::make_unique<Prepared>(std::move(cost), blocks);
  prepared_.push_back(prepared.get());
  return prepared;
}

ParallelEvaluation::ParallelEvaluation(int num_threads) : num_threads_(num_threads) {}
ParallelEvaluation::~ParallelEvaluation() = default;

void ParallelEvaluation::SetTasks() {
  std::map<const RolloutProblem*, Prepared*> in_lanes;
  for (Prepared* prepared : prepared_) {
    if (prepared->problem() != nullptr && HasLanes(*prepared->problem())) {
      in_lanes[prepared->problem()] = prepared;
    } else {
      tasks_.push_back({{prepared}, nullptr});
    }
  }
  for (size_t g = 0; !in_lanes.empty() && g < side_by_side_->size(); ++g) {
    Task& task = tasks_.emplace_back(Task{{}, &(*side_by_side_)[g].lanes});
    for (const RolloutProblem* problem : task.lanes->problems()) {
      task.members.push_back(in_lanes.at(problem));
    }
  }
}

const RolloutProblem* ParallelEvaluation::ProblemOf(const ceres::CostFunction* cost) {
  const auto* const prepared = dynamic_cast<const Prepared*>(cost);
  const RolloutProblem* const problem = prepared != nullptr ? prepared->problem() : nullptr;
  return problem != nullptr && HasLanes(*problem) ? problem : nullptr;
}

const RolloutSums* ParallelEvaluation::SumsOf(const ceres::CostFunction* cost) {
  return ProblemOf(cost) != nullptr ? &static_cast<const Prepared*>(cost)->sums() : nullptr;
}

void ParallelEvaluation::PrepareForEvaluation(bool evaluate_jacobians, bool) {
  ++(evaluate_jacobians ? EvaluationCount::Get().jacobians : EvaluationCount::Get().costs);
  if (tasks_.empty()) SetTasks();
  ParallelFor(static_cast<int>(tasks_.size()), num_threads_, [&](int i) {
    const auto& [members, lanes] = tasks_[i];
    if (lanes == nullptr) return members[0]->Prepare(evaluate_jacobians, *problem_);
    std::vector<double const* const*> blocks;
    bool there = true;
    for (const Prepared* member : members) {
      blocks.push_back(member->blocks());
      there = there && member->IsPrepared(evaluate_jacobians);
    }
    if (there) return;
    std::vector<RolloutSums> sums = lanes->Evaluate(blocks, SumsWanted(evaluate_jacobians));
    for (size_t m = 0; m < members.size(); ++m) {
      members[m]->Prepare(std::move(sums[m]), evaluate_jacobians);
    }
  });
}

}  // namespace pushid
