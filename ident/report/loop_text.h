// ident: the identified loop in the numbers that a control engineer quotes.
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// A row for each plane, one for both where they are alike: stiffness over m g l, damping ratio and
// frequency of the slowest oscillation, phase margin, delay margin, factors between which the gains
// may change (problem/linear_loop.h), of the person that gains are quoted for. Only a header where
// feet slide, or a model has no closed form.
TextTable LoopTable(const FitResult& result);

// The same in sentences; empty where the table is.
std::string LoopText(const FitResult& result);

// What the residuals say of a delay that the model leaves out, which is taken for less damping;
// empty: nothing.
std::string LagText(const FitResult& result);

}  // namespace pushid
