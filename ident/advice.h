// ident: what to try next, in plain words: a pure function of a result.
#pragma once

#include <vector>

#include "ident/fit_result.h"

namespace pushid {

// Most pressing first. Commands repeat the settings of the fit; M/manifest.json stands for the
// recordings.
std::vector<Advice> Advise(const FitResult& result);

}  // namespace pushid
