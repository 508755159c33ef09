// ident: residuals of one recording before any weight, and their derivatives by what a fit
// estimates and by what it takes as known (assumptions.h).
//
// By estimates with the sensitivities of the rollout; by assumptions, and of people alone by all,
// by forward differences of rollouts without derivatives. Those of people alone go side by side, a
// column a lane, in less time than their sensitivities take.
#pragma once

#include <Eigen/Core>
#include <map>
#include <utility>
#include <vector>

#include "ident/problem/fit_problem.h"
#include "ident/problem/jacobian_blocks.h"
#include "ident/uncertainty/assumptions.h"

namespace pushid {

struct RecordingRows {
  Eigen::VectorXd residuals;  // as RawResiduals has them; empty: the rollout fails
  // Those that move the recording: estimates in the order of FitPoint::Flat, then assumptions.
  std::vector<Eigen::Index> columns;
  Eigen::MatrixXd by_column;
};

class RowsOfRecordings {
 public:
  // What it is made of must outlive it.
  RowsOfRecordings(const FitProblem& problem, const FitPoint& point,
                   const std::vector<Assumption>& assumptions);

  Eigen::Index num_estimates() const { return unit_.size(); }
  // From any thread.
  RecordingRows Of(int index);

 private:
  // What a fit sees of a recording besides itself.
  struct Seen {
    ModelOptions model;
    ParameterMap map;
    FitPoint point;
  };
  RolloutAt Rollout(Seen* seen, const PendulumRecording& recording, int index) const;
  Seen Under(const Assumption& assumption) const;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> OwnColumns(const RolloutAt& here) const;
  RecordingRows BySensitivities(const RolloutAt& here) const;
  RecordingRows ByDifferences(const RolloutAt& here, int index, RecordingRows rows);

  const FitProblem& problem_;
  const std::vector<Assumption>& assumptions_;
  ResidualSigmas plain_;
  Seen here_;
  std::map<const double*, Eigen::Index> first_;  // column of each block of here_
  Eigen::VectorXd unit_;                         // of the estimates; 0: on a bound
  std::vector<Seen> moved_, under_;              // by estimate, by assumption
};

}  // namespace pushid
