// ident: a fit with everything that was found out about it: what a model's file holds
// (result_json.h), and what reports are a function of.
#pragma once

#include <optional>
#include <vector>

#include "ident/diagnostics/diagnostics.h"
#include "ident/results/fit_result.h"
#include "ident/results/provenance.h"
#include "ident/uncertainty/bootstrap.h"
#include "ident/uncertainty/profile.h"
#include "ident/uncertainty/refit_table.h"

namespace pushid {

struct FittedModel {
  FitResult fit;
  std::vector<Profile> profiles;       // empty unless asked for (confidence.h)
  std::optional<Bootstrap> bootstrap;  // absent unless asked for
  std::vector<Advice> advice;          // report/advice.h
  Provenance provenance;
  // Absent unless asked for: refits with other pushes (push_check.h), and of fewer frames
  // (horizon_check.h).
  std::optional<RefitTable> push_check{}, horizon_check{}, prior_check{};
};

}  // namespace pushid
