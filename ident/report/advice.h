// ident: what to try next, in plain words: a pure function of a result.
#pragma once

#include <vector>

#include "ident/results/fit_result.h"

namespace pushid {

// Most pressing first. Commands repeat the settings of the fit (fit_command.h).
std::vector<Advice> Advise(const FitResult& result);

}  // namespace pushid
