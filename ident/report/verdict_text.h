// ident: the verdict on a model in words (uncertainty/model_verdict.h).
#pragma once

#include <string>

#include "ident/figures/text_table.h"
#include "ident/model/fitted_model.h"

namespace pushid {

// "The model check found no contradiction: ...", or "The model does not fit these recordings: ..."
// with what to check or to try, or why nothing was checked. more: than was said before it.
std::string ModelVerdictText(const ModelVerdict& verdict, bool more = false);

// Its name among a manifest's stated_errors; empty of what the laboratory does not measure.
std::string StatedErrorKey(const AssumptionTest& test);

// What was taken as known, what is stated about it, what the recordings want, and the test.
TextTable AssumptionTable(const FitResult& result);

}  // namespace pushid
