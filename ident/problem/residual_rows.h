// ident: residuals r and Jacobian J of a fit at a point, by recording and by person. Covariance,
// verdict, horizons, profiles and diagnostics take their rows from here.
//
//   EvaluateRows       rows of the cost: r in sigmas, times the weights of frames, recordings and
//                      the robust loss, so that J'r is the gradient of the cost
//   with assumptions   J also by what the fit takes as known; J'r and J'J of each person's
//                      frames up to each horizon
//   RawResiduals       r of every frame before any weight
//
// Columns: the fitted numbers on their scale, in the order of FitPoint::Flat, then the assumptions.
// Rows: of each person of a recording that is rolled out as many as columns move it, and one
// (residuals/normal_equations.h): every sum of squares and products over a person, a recording or
// all of them is that of all frames. Other cost functions have rows of their own.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

// One person of a recording over some of its frames.
struct DataPart {
  int recording = 0, person = 0;
  int part = 0;                 // the first horizon that holds them; as many as there are: none
  Eigen::VectorXd score;        // J'r by the estimates and the assumptions
  Eigen::MatrixXd information;  // J'J by them, with the robust loss's own Hessian
};

struct ResidualRows {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residuals;
  std::vector<int> cluster_of_row;  // recording, or a cluster of FitProblem
  std::vector<int> person_of_row;   // in the recording; -1 where rows belong to nobody
  std::vector<int> clusters;        // the recordings present, ascending
  int num_data_rows = 0;            // before they were condensed
  // The Jacobian with the robust loss's own Hessian in its J'J (frame_residual.h), rows of
  // recordings only, zeros elsewhere; empty where it was not asked for.
  Eigen::MatrixXd robust_jacobian;
  // The Hessian less J'J: the sum over rows of r times its second derivatives. Empty until
  // AddCurvature.
  Eigen::MatrixXd curvature;
  std::vector<DataPart> parts;  // with horizons

  template <typename OfCluster>
  std::vector<int> RowsWhere(const OfCluster& of_cluster) const {
    std::vector<int> rows;
    for (int row = 0; row < static_cast<int>(cluster_of_row.size()); ++row) {
      if (of_cluster(cluster_of_row[row])) rows.push_back(row);
    }
    return rows;
  }
  std::vector<int> RowsOf(int cluster) const {
    return RowsWhere([cluster](int c) { return c == cluster; });
  }
  std::vector<int> RowsOfData() const {
    return RowsWhere([](int c) { return c >= 0; });
  }
  // J'J and J'r of some rows, and J'J of what is no data: priors, demands, pooling.
  Eigen::MatrixXd Information(const std::vector<int>& rows) const;
  Eigen::VectorXd Gradient(const std::vector<int>& rows) const;
  Eigen::MatrixXd InformationBeside() const {
    return Information(RowsWhere([](int c) { return c < 0; }));
  }
};

// robust: with robust_jacobian. Blocks that cannot be evaluated are left out.
ResidualRows EvaluateRows(const BuiltProblem& built, bool robust = false);
ResidualRows EvaluateRows(const FitProblem& problem, FitPoint point, bool robust = false);

// A number eta that a fit takes as known, 0 as it was taken (uncertainty/model_verdict.h).
struct Assumption {
  std::string name;    // "scale of the pushes"; "Kd_theta"
  std::string unit;    // of eta; empty: a share, or a logarithm of a factor
  double sigma = 0.0;  // standard deviation that is stated of eta; 0: none, it is only tested
  double step = 0.0;   // of differences
  // The changes that eta makes to every recording, or to the options of the fit. Null: none.
  std::function<void(double eta, PendulumRecording*)> of_recording;
  std::function<void(double eta, FitOptions*)> of_options = nullptr;
  // Estimates that go with it to the first order, and how far each shared one does at `step`, on
  // the fitted scale: the column is the difference to the problem in which they do.
  std::vector<std::pair<size_t, double>> along = {};
  // Whether eta scales measured rates. The column then scales what is compared with them instead,
  // because their noise would ask for a smaller eta.
  bool of_rates = false;
  bool halves_steps = false;  // of_recording makes two of every step
};

// With robust_jacobian, parts, and the row 1 / sigma of each assumption after those of the priors.
// horizons: frames from the first push on, ascending. No columns where a rollout fails.
//
// Columns of estimates are the rollout's sensitivities. Those of assumptions, and all of people
// alone, are forward differences of rollouts without derivatives, which go side by side, a column a
// lane, in less time than the sensitivities take.
ResidualRows EvaluateRows(const FitProblem& problem, const FitPoint& point,
                          const std::vector<Assumption>& assumptions,
                          const std::vector<int>& horizons);

// Differences of the gradient J'r, one column at a time, `steps` ahead of the point or to both
// sides of it (0: a column that does not move, and has none). Leaves the curvature empty where some
// residual cannot be evaluated there.
void AddCurvature(const BuiltProblem& built, const Eigen::VectorXd& steps, bool both_sides,
                  ResidualRows* rows);

// By recording, in sigmas without the robust loss: FrameResidual's, by frame from frame 1 on, then
// person; then those of platforms (residuals/plate_residual.h). Empty where a rollout leaves
// the domain, and of recordings that do not count if only the others are wanted.
using ResidualsByRecording = std::vector<std::vector<double>>;
ResidualsByRecording RawResiduals(const FitProblem& problem, const FitPoint& point,
                                  bool counted_only = false);

// A fitted number, besides its estimate.
struct FittedColumn {
  std::string name, unit;
  Transform transform = Transform::kIdentity;
  double scale = 1.0;   // typical size, natural unit
  double width = 1.0;   // the prior's, or the typical size: what an interval is compared with
  double fitted = 0.0;  // value on the fitted scale
  double natural = 0.0;
  bool at_bound = false;
};

std::vector<FittedColumn> FittedColumns(const FitProblem& problem, const FitPoint& point);

// d fitted / d (natural / scale): what one step of a column is; 0 of a parameter on its bound.
Eigen::VectorXd Units(const std::vector<FittedColumn>& columns);

}  // namespace pushid
