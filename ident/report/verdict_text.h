// ident: the verdict on a model in words (uncertainty/model_verdict.h).
#pragma once

#include <string>
#include <vector>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// "The model fits: ..." or "The model does not fit: ..." with what does not and what to try; or
// why nothing was checked.
std::string ModelVerdictText(const ModelVerdict& verdict);

// What was taken as known, with what is stated of it, what the recordings want, and the test.
TextTable AssumptionTable(const FitResult& result);

}  // namespace pushid
