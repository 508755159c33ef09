// ident: the fit repeated under other circumstances - other pushes, fewer frames - side by side
// with the fit itself.
#pragma once

#include <string>
#include <vector>

#include "ident/problem/fit_point.h"
#include "ident/problem/parallel.h"

namespace pushid {

class FitProblem;
struct SolveStart;
struct Uncertainty;

struct RefitRow {
  std::string source;  // what varies: rows of one source are told apart by `name`
  std::string name;
  std::vector<double> value;           // by parameter, natural units; empty where it failed
  std::vector<double> standard_error;  // empty where it was not computed
  std::string failure;
  int frames = 0;  // that were fitted; 0: all
};

// Of every free shared parameter.
struct RefitTable {
  std::vector<std::string> parameters, units;
  std::vector<double> value, standard_error;  // of the fit
  std::vector<RefitRow> rows;
};

// The table without rows.
RefitTable RefitTableOf(const FitProblem& problem, const FitPoint& estimate,
                        const Uncertainty& uncertainty);

// What a refit found, or why it says nothing.
void Take(const FitProblem& problem, const SolveStart& refit, RefitRow* row);

// Shared parameters at a point, natural units.
std::vector<double> SharedValues(const FitProblem& problem, const FitPoint& point);

}  // namespace pushid
