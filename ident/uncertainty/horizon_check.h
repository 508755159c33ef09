// ident: how the estimates depend on the horizon, with its table and its words.
//
// A parameter that means something keeps its value however long the rollouts are; one that drifts
// stands for what the model leaves out. The fit is repeated on the motion up to 8, 16, 32 and 64
// frames after the first push of every recording began (FitOptions::horizons), each on its own and
// with everything that the whole fit has. Two fits of one study share their people, so their
// difference is known better than either value; that it is larger than twice the larger of the two
// errors is called a drift. It sees faults that the verdict does not: on the people of
// tests/studies/world.py it drifts in 15 of 49 studies with a fault that passes the verdict, in 1
// of 30 without. Rejected: the stages of the solver, which stop early and know no settling; other
// priors and other pushes, which found nothing that shares, verdict and horizons do not.
#pragma once

#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/problem/fit_point.h"
#include "ident/problem/parallel.h"

namespace pushid {

class FitProblem;
struct Uncertainty;

struct HorizonFit {
  int frames = 0;                             // from the push on
  std::vector<double> value, standard_error;  // by parameter, natural units; empty where it failed
  std::string failure;
};

struct HorizonCheck {  // one entry a free shared parameter
  std::vector<std::string> parameters, units;
  std::vector<double> value, standard_error;  // of the whole fit
  std::vector<HorizonFit> refits;             // horizons that are shorter than some recording
};

HorizonCheck CheckHorizons(const FitProblem& problem, const FitPoint& estimate,
                           const Uncertainty& uncertainty, int num_threads,
                           const JobProgress& progress = nullptr);

struct Drift {
  size_t parameter = 0, refit = 0;  // the refit where it is farthest, in errors
  double in_errors = 0.0;           // of the larger of both
};
std::vector<Drift> Drifts(const HorizonCheck& check);

// Parameter by horizon, value +- standard error; and a sentence for each drift and each failure.
TextTable HorizonTable(const HorizonCheck& check);
std::string DriftText(const HorizonCheck& check);

}  // namespace pushid
