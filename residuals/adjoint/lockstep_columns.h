// residuals: people side by side, one column each, over as many steps as each of them has.
//
// Those who go on longest are the first columns, so that a step has the first `active` of them.
// What is kept of every step stands side by side in one matrix of total() columns.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace pushid {

class LockstepColumns {
 public:
  // steps: by person; never increasing.
  explicit LockstepColumns(const std::vector<int>& steps) {
    const int longest = steps.empty() ? 0 : steps.front();
    int active = static_cast<int>(steps.size());
    for (int step = 0; step < longest; ++step) {
      while (steps[active - 1] <= step) --active;
      first_.push_back(first_.back() + active);
    }
  }

  int num_steps() const { return static_cast<int>(first_.size()) - 1; }
  int active(int step) const { return first_[step + 1] - first_[step]; }
  int total() const { return first_.back(); }
  // The columns of a step.
  auto At(Eigen::MatrixXd& of, int step) const { return of.middleCols(first_[step], active(step)); }

 private:
  std::vector<int> first_ = {0};  // column of each step, and the total
};

}  // namespace pushid
