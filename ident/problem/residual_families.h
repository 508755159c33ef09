// ident: what a fit minimizes, family by family: each row says when a family is part of the cost
// and adds its residual blocks (residuals/cost_functions/) to the Ceres problem.
//
// A new family is a row of the table in residual_families.cc with the two functions that it names,
// its cost function in a file of its own, and an option for its weight
// (ident/parameters/option_table.cc). Solver, covariance, profiles and bootstrap take it from here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ident/problem/fit_problem.h"

namespace pushid {

// Where a family adds blocks.
struct FamilyPlace {
  const FitProblem& problem;
  const FitStage& stage;
  FitPoint* point;
  FitProblem::Built* built;
  int recording = -1;     // of a family of recordings
  std::string unit = {};  // of a family of units; empty: the shared parameters
  // The rollout of the recording, as long as it stays within the domain; null: not even one frame.
  std::shared_ptr<const RolloutProblem> rollout = {};
};

struct ResidualFamily {
  enum Per {
    kRecording,  // added for each recording that counts
    kPoint,      // once
    kUnit        // for each unit whose settling is simulated (FitProblem::SettlingUnits)
  };
  const char* name;
  Per per;
  int cluster;  // of its rows, one of FitProblem's; of recordings: their index
  bool (*on)(const FitOptions& options, const FitStage& stage);
  void (*add)(const ResidualFamily& family, const FamilyPlace& place);
};

// All of them, in the order of their blocks.
const std::vector<ResidualFamily>& ResidualFamilies();

}  // namespace pushid
