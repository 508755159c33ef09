// apps: fitted models as files that say what made them.
#pragma once

#include <string>

#include "datasets/files/error.h"
#include "ident/model/model_json.h"

namespace pushid {

// Version, flags and manifest of this program's run.
Provenance ProvenanceOfRun();

// With date, host, threads and the seconds since `begin` (of Now()).
MaybeError WriteModelFile(const std::string& path, const FittedModel& model, int num_threads,
                          double begin);

}  // namespace pushid
