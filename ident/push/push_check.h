// ident: the fit repeated with other pushes, from its estimate: how far the estimates depend on
// pushes that are not known exactly (push_errors.h says what becomes of it).
#pragma once

#include "ident/push/push_variants.h"
#include "ident/results/fitted_model.h"

namespace pushid {

// Sets model->push_check; model->fit must come from Fit of these very recordings. Errors: those of
// PushVariants.
MaybeError AddPushCheck(const std::vector<PendulumRecording>& recordings,
                        const PushVariantOptions& options, int num_threads,
                        const JobProgress& progress, FittedModel* model);

}  // namespace pushid
