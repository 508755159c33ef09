// datasets: a manifest's entry of a person on force plates whom nothing else measured.
//
//   "motion": "none", "force_plates": {"use": "measure", "file": "quiet.csv"},
//   "subjects": [{"id": "anna", "mass_kg": 62, "rod_m": 0.91}]
#pragma once

#include "datasets/files/json_fields.h"
#include "datasets/manifest/manifest.h"

namespace pushid {

// Whether nothing but platforms measured; then every other key that asks for motion is a mistake.
bool ReadPlatesAlone(JsonFields* fields);

// What such a person needs, and may have.
void CheckPlatesAlone(const ManifestRecording& recording, JsonFields* fields);

}  // namespace pushid
