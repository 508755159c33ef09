// ident: synthetic people: the model that their recordings are made from, so that a fit can find
// every parameter again.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "datasets/synthetic/synthetic_recordings.h"
#include "ident/model/identified_model.h"

namespace pushid {

// The tail preset, or that of groups where people stand in rows, with the feet and the process
// noise of study.model: what it fits has values near those identified from the published
// recordings, what it holds keeps its value. set: values that replace these ("mu=20,a_x=-5").
Result<IdentifiedModel> SyntheticTruth(const SyntheticOptions& study, const std::string& set);

}  // namespace pushid
