// ident: the numbers of a solved fit as rows: parameters, combinations, units, recordings; and what
// a reader must know before them.
#pragma once

#include <vector>

#include "ident/model/fitted_model.h"
#include "ident/problem/fit_problem.h"

namespace pushid {

// Every free parameter, and every fixed one that acts.
std::vector<Estimate> TableOfEstimates(const FitProblem& problem,
                                       const ParameterSet<double>& values,
                                       const Uncertainty& uncertainty);

// DerivedCombinations of the model, with errors.
std::vector<Combination> TableOfCombinations(const FitProblem& problem, const FitPoint& point,
                                             const Uncertainty& uncertainty);

// Masses of the people, and the pooled parameters of every unit: shared value and deviation
// together; with errors where their uncertainty is known (else null).
void AddUnits(const FitProblem& problem, const FitPoint& point, const Uncertainty* uncertainty,
              FitResult* result);

// Cost of every recording at the optimum, and where its rollout failed.
std::vector<FittedRecording> FittedRecordings(const FitProblem& problem, const SolveStart& best,
                                              const Diagnostics& diagnostics);

// Failed rollouts, a solver that stopped early, a verdict other than that people
// settle, few clusters, what the demand to settle did, parameters at bounds, a tail that cannot
// act.
Warnings FitWarnings(const FitProblem& problem, const FitResult& result);

}  // namespace pushid
