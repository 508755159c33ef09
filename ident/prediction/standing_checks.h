// ident: an identified model beside people who stand: on ground that oscillates or under pushes
// that go on, frequency by frequency, and undisturbed.
#pragma once

#include <cstdint>
#include <vector>

#include "ident/diagnostics/frequency_response.h"
#include "ident/diagnostics/sway.h"
#include "ident/model/identified_model.h"

namespace pushid {

inline constexpr int kSwayRepeats = 20;

// With each person's own parameters; none where nothing in the recordings is continuous.
std::vector<FrequencyResponse> FrequencyResponses(const IdentifiedModel& model,
                                                  const std::vector<PendulumRecording>& recordings);

// Simulated where the model has process noise; nobody without quiet recordings.
std::vector<PersonSway> SwayOfPeople(const IdentifiedModel& model,
                                     const std::vector<PendulumRecording>& recordings,
                                     int repeats = kSwayRepeats, uint64_t seed = 1);

}  // namespace pushid
