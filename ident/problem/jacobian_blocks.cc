// ident: evaluating a problem block by block.
#include "ident/problem/jacobian_blocks.h"

#include <map>
#include <set>

namespace pushid {

JacobianBlocks EvaluateJacobianBlocks(const FitProblem::Built& built) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::map<const double*, int> column_of;
  int columns = 0, rows = 0;
  for (double* block : built.parameter_blocks) {
    column_of[block] = columns;
    columns += built.problem->ParameterBlockSize(block);
  }
  for (const auto& [id, cluster] : built.blocks) {
    rows += built.problem->GetCostFunctionForResidualBlock(id)->num_residuals();
  }

  JacobianBlocks score;
  score.jacobian = Eigen::MatrixXd::Zero(rows, columns);
  score.residuals.resize(rows);
  std::set<int> present;
  int row = 0;
  for (const auto& [id, cluster] : built.blocks) {
    const ceres::CostFunction* function = built.problem->GetCostFunctionForResidualBlock(id);
    std::vector<double*> blocks;
    built.problem->GetParameterBlocksForResidualBlock(id, &blocks);
    const int n = function->num_residuals();
    std::vector<RowMajor> jacobians;
    std::vector<double*> pointers;
    for (int size : function->parameter_block_sizes()) jacobians.emplace_back(n, size);
    for (RowMajor& jacobian : jacobians) pointers.push_back(jacobian.data());
    // A block that cannot be evaluated here was left out by Build; skip it all the same.
    const std::vector<const double*> inputs(blocks.begin(), blocks.end());
    if (!function->Evaluate(inputs.data(), score.residuals.data() + row, pointers.data())) continue;
    for (size_t b = 0; b < blocks.size(); ++b) {
      score.jacobian.block(row, column_of.at(blocks[b]), n, jacobians[b].cols()) = jacobians[b];
    }
    score.cluster_of_row.insert(score.cluster_of_row.end(), n, cluster);
    for (int k = 0; k < n; ++k) score.row_in_block.push_back(k);
    if (cluster >= 0) {
      present.insert(cluster);
      score.num_data_rows += n;
    }
    row += n;
  }
  score.jacobian.conservativeResize(row, columns);
  score.residuals.conservativeResize(row);
  score.clusters.assign(present.begin(), present.end());
  return score;
}

void CorrectRobustLoss(const FitProblem& problem, JacobianBlocks* score) {
  score->robust_jacobian = score->jacobian;
  if (problem.options().likelihood != Likelihood::kTrajectory) {  // has no robust loss
    for (Eigen::Index row = 0; row < score->jacobian.rows(); ++row) {
      if (score->cluster_of_row[static_cast<size_t>(row)] < 0) {
        score->robust_jacobian.row(row).setZero();
      }
    }
    return;
  }
  const double robust = problem.options().sigmas.robust;
  for (Eigen::Index row = 0; row < score->jacobian.rows();) {
    const int recording = score->cluster_of_row[static_cast<size_t>(row)];
    if (recording < 0) {
      score->robust_jacobian.row(row++).setZero();
      continue;
    }
    const PendulumRecording& r = problem.recordings()[recording];
    const int block = score->row_in_block[static_cast<size_t>(row)] / kFrameResiduals;
    const int frame = 1 + block / r.num_people(), person = block % r.num_people();
    CorrectForRobustLoss(score->residuals.segment<kFrameResiduals>(row),
                         problem.Weight(recording, 0) * r.Weight(person, frame), robust,
                         score->robust_jacobian.middleRows<kFrameResiduals>(row));
    row += kFrameResiduals;
  }
}

std::vector<int> JacobianBlocks::RowsOf(int cluster) const {
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(cluster_of_row.size()); ++row) {
    if (cluster_of_row[row] == cluster) rows.push_back(row);
  }
  return rows;
}

void AddCurvature(const FitProblem::Built& built, const Eigen::VectorXd& steps,
                  JacobianBlocks* score) {
  const Eigen::Index size = score->jacobian.cols();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index column = 0;
  for (double* block : built.parameter_blocks) {
    for (int k = 0; k < built.problem->ParameterBlockSize(block); ++k, ++column) {
      const double step = steps[column];
      if (step == 0.0) continue;
      const double value = block[k];
      block[k] = value + step;
      const JacobianBlocks above = EvaluateJacobianBlocks(built);
      block[k] = value - step;
      const JacobianBlocks below = EvaluateJacobianBlocks(built);
      block[k] = value;
      if (above.cluster_of_row != score->cluster_of_row ||
          below.cluster_of_row != score->cluster_of_row) {
        return;
      }
      hessian.col(column) = (above.jacobian.transpose() * above.residuals -
                             below.jacobian.transpose() * below.residuals) /
                            (2.0 * step);
    }
  }
  score->curvature =
      0.5 * (hessian + hessian.transpose()) - score->jacobian.transpose() * score->jacobian;
}

}  // namespace pushid
