// ident: evaluating ahead.
#include "ident/problem/parallel_evaluation.h"

#include <algorithm>

#include "ident/problem/parallel.h"

namespace pushid {

class ParallelEvaluation::Prepared : public ceres::CostFunction {
 public:
  Prepared(std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& blocks)
      : cost_(std::move(cost)), blocks_(blocks) {
    set_num_residuals(cost_->num_residuals());
    *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
    residuals_.resize(num_residuals());
    jacobians_.resize(blocks_.size());
  }

  // At the blocks' present values; constant blocks get no derivatives.
  void Prepare(bool with_jacobians, const ceres::Problem& problem) {
    if (Holds(blocks_.data(), with_jacobians)) return;
    std::vector<double*> jacobians(blocks_.size(), nullptr);
    for (size_t b = 0; with_jacobians && b < blocks_.size(); ++b) {
      const bool constant = problem.IsParameterBlockConstant(blocks_[b]);
      jacobians_[b].resize(constant ? 0 : num_residuals() * parameter_block_sizes()[b]);
      if (!constant) jacobians[b] = jacobians_[b].data();
    }
    has_jacobians_ = with_jacobians;
    Remember();
    ok_ = cost_->Evaluate(blocks_.data(), residuals_.data(),
                          with_jacobians ? jacobians.data() : nullptr);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    bool held = Holds(blocks, jacobians != nullptr);
    for (size_t b = 0; held && jacobians != nullptr && b < blocks_.size(); ++b) {
      held = jacobians[b] == nullptr || !jacobians_[b].empty();
    }
    if (!held) return cost_->Evaluate(blocks, residuals, jacobians);
    if (!ok_) return false;
    std::copy(residuals_.begin(), residuals_.end(), residuals);
    for (size_t b = 0; jacobians != nullptr && b < blocks_.size(); ++b) {
      if (jacobians[b] == nullptr) continue;
      std::copy(jacobians_[b].begin(), jacobians_[b].end(), jacobians[b]);
    }
    return true;
  }

 private:
  void Remember() {
    point_.clear();
    for (size_t b = 0; b < blocks_.size(); ++b) {
      point_.insert(point_.end(), blocks_[b], blocks_[b] + parameter_block_sizes()[b]);
    }
  }
  template <typename Blocks>
  bool Holds(Blocks blocks, bool with_jacobians) const {
    if (point_.empty() || (with_jacobians && !has_jacobians_)) return false;
    auto at = point_.begin();
    for (size_t b = 0; b < blocks_.size(); at += parameter_block_sizes()[b++]) {
      if (!std::equal(at, at + parameter_block_sizes()[b], blocks[b])) return false;
    }
    return true;
  }

  std::unique_ptr<ceres::CostFunction> cost_;
  std::vector<double*> blocks_;
  std::vector<double> point_;  // where it was evaluated; empty: nowhere yet
  bool has_jacobians_ = false, ok_ = false;
  std::vector<double> residuals_;
  std::vector<std::vector<double>> jacobians_;  // empty for a constant block
};

std::unique_ptr<ceres::CostFunction> ParallelEvaluation::Wrap(
    std::unique_ptr<ceres::CostFunction> cost, const std::vector<double*>& blocks) {
  auto prepared = std::make_unique<Prepared>(std::move(cost), blocks);
  prepared_.push_back(prepared.get());
  return prepared;
}

void ParallelEvaluation::PrepareForEvaluation(bool evaluate_jacobians, bool) {
  ParallelFor(static_cast<int>(prepared_.size()), num_threads_,
              [&](int i) { prepared_[i]->Prepare(evaluate_jacobians, *problem_); });
}

}  // namespace pushid
