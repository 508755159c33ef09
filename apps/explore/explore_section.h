// apps: the explorable person of a report page: the model that was fitted, at work in the page.
#pragma once

#include "ident/model/fitted_model.h"
#include "ident/report/page/document.h"

namespace pushid {

// Empty where the programs were built without emscripten, and of a model with a learned force or a
// law of the user's own, which the page could not compute.
ReportSection ExploreSection(const FittedModel& model);

}  // namespace pushid
