// ident: residuals and Jacobian of a fit frame by frame, by its estimates and by what it takes as
// known (assumptions.h). Those of jacobian_blocks.h are condensed, and know neither frames nor
// anything but estimates.
#pragma once

#include <vector>

#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/assumptions.h"

namespace pushid {

// Columns: the estimates in the order of FitPoint::Flat, then the assumptions. Rows: frames, with
// the weight of the robust loss, so that J'r is the gradient of the cost; then priors, demands and
// pooling; then what is stated of each assumption.
struct RowsByFrame {
  JacobianBlocks rows;
  std::vector<int> frame_of_row;  // -1 of rows that are no data
  int num_estimates = 0;          // 0: some rollout fails
};

// By forward differences: of rollouts without derivatives, one for each column.
RowsByFrame EvaluateByFrame(const FitProblem& problem, const FitPoint& point,
                            const std::vector<Assumption>& assumptions);

}  // namespace pushid
