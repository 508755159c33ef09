// ident: how sure the wave of a formation is.
//
// The formation is rolled out with parameters drawn anew, from the bootstrap's replicas where the
// model has them and else from its covariance (prediction/predictive_bands.h); the band of a
// person is the central 90 % of the onsets. It holds what the parameters leave open, not how people
// with the same parameters differ.
#pragma once

#include <vector>

#include "ident/formations/formation_run.h"
#include "ident/results/fitted_model.h"

namespace pushid {

struct OnsetBand {
  double from = 0.0, to = 0.0;  // s
  double moved = 0.0;           // share of the draws in which this person moves; 0: no band
};

// One for each person of the run; empty where the model has neither covariance nor bootstrap.
// set: what --set replaces in every draw.
std::vector<OnsetBand> OnsetBands(const FittedModel& model, const std::string& set,
                                  const FormationRun& run);

}  // namespace pushid
