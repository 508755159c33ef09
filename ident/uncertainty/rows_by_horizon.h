// ident: residuals and Jacobian of a fit by its estimates and by what it takes as known
// (assumptions.h), in parts of each recording. Those of jacobian_blocks.h know neither parts nor
// anything but estimates.
#pragma once

#include <vector>

#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/assumptions.h"

namespace pushid {

// Columns: the estimates in the order of FitPoint::Flat, then the assumptions. Rows: of each person
// of a recording in each part, condensed (residuals/normal_equations.h), with the weight of the
// robust loss, so that J'r is the gradient of the cost; then priors, demands and pooling; then what
// is stated of each assumption.
struct RowsByHorizon {
  JacobianBlocks rows;
  // The first horizon that holds the row's frames; as many as there are horizons: none of them; -1
  // of rows that are no data.
  std::vector<int> part_of_row;
  int num_estimates = 0;  // 0: some rollout fails
};

// By forward differences: of rollouts without derivatives, one for each column and each recording
// that it moves. horizons: frames from the first push on, ascending.
RowsByHorizon EvaluateByHorizon(const FitProblem& problem, const FitPoint& point,
                                const std::vector<Assumption>& assumptions,
                                const std::vector<int>& horizons);

}  // namespace pushid
