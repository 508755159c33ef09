// ident: the covariances of a fit, naive and by clusters: N, V_R and V_P of study_plan.h. Its plans
// are apart, so that a report, which shows plans alone, need not read the solver's headers.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "ident/problem/jacobian_blocks.h"

namespace pushid {

// What the errors of a fit are made of; covariances on the fitted scale, in the order of
// FitPoint::Flat, whatever the fit's own clusters are.
struct ErrorParts {
  JacobianBlocks score;  // by recording
  double sigma = 0.0;
  Eigen::MatrixXd naive;
  Eigen::MatrixXd by_recording;  // empty with a single recording
  Eigen::MatrixXd by_person;     // by who is pushed; empty with a single person
  std::vector<int> person;       // of each recording, from 0

  int num_recordings() const { return static_cast<int>(person.size()); }
};
ErrorParts ErrorPartsAt(const FitProblem& problem, const FitPoint& estimate);

}  // namespace pushid
