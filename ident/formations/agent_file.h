// ident: identified people as agents of another crowd simulation: bodies, gains that are already
// those of the person's size, contact and pushes, with units in the names
// (apps/schemas/pushid-agents-1.schema.json). pushid.agents of Python steps them.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "datasets/files/error.h"
#include "ident/formations/formation_run.h"

namespace pushid {

// Of feet that slide, linear forces and elastic contact. Errors: a model with a term that agents do
// not have (delay, networks, feet that hold, dry friction, ...).
Result<nlohmann::ordered_json> AgentsJson(const FormationRun& run, const IdentifiedModel& model);

}  // namespace pushid
