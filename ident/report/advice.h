// ident: what to try next, in plain words: a pure function of a fitted model.
#pragma once

#include <vector>

#include "ident/model/fitted_model.h"

namespace pushid {

// Most pressing first. Commands repeat the settings of the fit (fit_command.h).
std::vector<Advice> Advise(const FittedModel& model);

}  // namespace pushid
