// ident: what a laboratory's model frees: reaction delays, bodies of their own.
#pragma once

#include "ident/parameters/fit_options.h"

namespace pushid {

// A start, and the sigma of a weak prior about it.
struct WeakStart {
  Parameter id;
  double value, sigma;
};
void FreeFrom(const WeakStart& start, ParameterTable* table);

// Masses by the table: the point at the hip to start from, nothing free.
void SetBody(BodyModel body, FitOptions* options);

// With a delay its parameters are free, with weak priors.
void SetDelay(Delay delay, FitOptions* options);

// One passive share, unless that of the damping is named: apart, it and the damping hardly are.
void TiePassive(FitOptions* options);

}  // namespace pushid
